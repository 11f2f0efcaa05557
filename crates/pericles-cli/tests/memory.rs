//! Memory: refused before it is taken, and estimated well enough to trust the refusal.

mod common;

use std::fs;

use common::{fail, report, succeed, with_plate};

#[test]
fn a_run_that_does_not_fit_is_status_8_and_leaves_nothing() {
    let place = with_plate();
    for command in ["run", "check"] {
        let line = format!("{command} plate.toml --max-memory 50kB");
        let (status, message) = fail(place.path(), &line);
        assert_eq!(status, 8, "{message}");
        // Line 6 is the spacing.
        assert!(message.contains("plate.toml:6:"), "{message}");
        assert!(message.contains("50.0 kB may be taken"), "{message}");
    }
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    // Without a limit it is what the machine has.
    let huge = "run plate.toml --set body.spacing=5e-7";
    let (status, message) = fail(place.path(), huge);
    assert_eq!(status, 8, "{message}");
    let many = "run plate.toml --set body.spacing=1e-12";
    let (status, message) = fail(place.path(), many);
    assert!([3, 8].contains(&status), "{message}");
    succeed(
        place.path(),
        "run plate.toml --quiet --out a --max-memory 1MB --set checkpoint.every=100",
    );
    // A run that is gone on with is measured again.
    let text = fs::read_to_string(place.path().join("a/run.json")).unwrap();
    fs::write(
        place.path().join("a/run.json"),
        text.replace("\"finished\"", "\"stopped\""),
    )
    .unwrap();
    assert_eq!(fail(place.path(), "resume a --max-memory 50kB").0, 8);
    succeed(place.path(), "resume a --quiet");
}

/// A block of 64 000 points with the rest of its deck.
fn block(material: &str, time: &str) -> String {
    format!(
        "body = {{ shape = \"block\", size = [40, 40, 40], spacing = 1 }}\n\
         material = {{ density = 1, youngs_modulus = 1, horizon_ratio = 3, {material} }}\n\
         time = {{ end = 0.1, {time} }}\n\
         output = {{ fields = {{ count = 1 }} }}\n"
    )
}

#[test]
fn the_estimate_is_within_a_factor_of_what_is_taken() {
    let place = tempfile::tempdir().unwrap();
    let verlet = "dt = 0.1";
    let cases = [
        block("bonds = \"grid\"", verlet),
        block("bonds = \"list\"", verlet),
        block("surface_correction = \"volume\"", verlet),
        block("model = \"linear\", bonds = \"convolution\"", verlet),
        block("bonds = \"grid\"", "dt = 0.1, scheme = \"rk4\""),
    ];
    // What the program takes without a body.
    fs::write(
        place.path().join("none.toml"),
        block("bonds = \"grid\"", verlet).replace("[40, 40, 40]", "[4, 4, 4]"),
    )
    .unwrap();
    let peak = |deck: &str| {
        succeed(
            place.path(),
            &format!("run {deck}.toml --quiet --threads 1 --out {deck}"),
        );
        report(&place.path().join(deck))["progress"]["peak_memory"]
            .as_f64()
            .unwrap()
    };
    let base = peak("none");
    for (k, text) in cases.iter().enumerate() {
        let deck = format!("case-{k}");
        fs::write(place.path().join(format!("{deck}.toml")), text).unwrap();
        let (_, message) = fail(place.path(), &format!("check {deck}.toml --max-memory 1kB"));
        let words: Vec<&str> = message.split("some ").nth(1).unwrap().split(' ').collect();
        assert_eq!(words[1], "MB", "{message}");
        let estimate = 1e6 * words[0].parse::<f64>().unwrap();
        let taken = peak(&deck) - base;
        println!(
            "{text}estimated {:.1} MB, taken {:.1} MB",
            1e-6 * estimate,
            1e-6 * taken
        );
        assert!(
            (0.5..2.0).contains(&(estimate / taken)),
            "{text}{estimate:e} {taken:e}"
        );
    }
}
