//! The memory limit is checked before allocation, with a sufficiently accurate estimate.

use std::fs;

use crate::common::{fail, report, run, succeed, with_plate};

#[test]
fn a_run_above_the_memory_limit_is_status_8_and_leaves_no_files() {
    let place = with_plate();
    for command in ["run", "check"] {
        let line = format!("{command} plate.toml --max-memory 50kB");
        let (status, message) = fail(place.path(), &line);
        assert_eq!(status, 8, "{message}");
        // Line 6 is the spacing.
        assert!(message.contains("plate.toml:6:"), "{message}");
        assert!(message.contains("the limit is 50.0 kB"), "{message}");
    }
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
    // The default limit is the memory of the machine.
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
    // The limit also applies to resumed runs.
    let text = fs::read_to_string(place.path().join("a/run.json")).unwrap();
    fs::write(
        place.path().join("a/run.json"),
        text.replace("\"finished\"", "\"stopped\""),
    )
    .unwrap();
    assert_eq!(fail(place.path(), "resume a --max-memory 50kB").0, 8);
    succeed(place.path(), "resume a --quiet");
}

/// Returns a complete deck of a body.
fn body(body: &str, material: &str, time: &str) -> String {
    format!(
        "body = {{ {body} }}\n\
         material = {{ density = 1, youngs_modulus = 1, horizon_ratio = 3, {material} }}\n\
         time = {{ {time} }}\n\
         output = {{ fields = {{ count = 1 }} }}\n"
    )
}

/// Returns a bar with an absorbing boundary and `steps` steps.
fn end(history: &str, steps: u32) -> String {
    let boundary = format!(
        "boundary = [{{ kind = \"absorbing\", side = \"+x\", history = \"{history}\" }}]\n"
    );
    let bar = "shape = \"bar\", length = 100, spacing = 1";
    boundary
        + &body(
            bar,
            "model = \"linear\"",
            &format!("dt = 0.1, end = {}", 0.1 * f64::from(steps)),
        )
}

#[test]
fn the_memory_estimate_is_within_a_factor_of_the_peak() {
    let place = tempfile::tempdir().unwrap();
    let block = "shape = \"block\", size = [40, 40, 40], spacing = 1";
    let plate = "shape = \"plate\", size = [150, 150], spacing = 1, plane = \"stress\"";
    let bar = "shape = \"bar\", length = 50000, spacing = 1";
    let [verlet, rk4] = [
        "dt = 0.1, end = 0.1",
        "dt = 0.1, end = 0.1, scheme = \"rk4\"",
    ];
    let sphere = "body = { shape = \"icosphere\", level = 4, radius = 1 }\n\
                  material = { density = 1, alpha = 0.25, p = 2, horizon = 0.4 }\n\
                  time = { end = 0.001, dt = 0.001 }\n\
                  output = { fields = { count = 1 } }\n";
    // With a memory limit that the part estimated first satisfies.
    let cases = [
        (body(block, "bonds = \"grid\"", verlet), "1kB"),
        (body(block, "bonds = \"list\"", verlet), "1kB"),
        (
            body(block, "surface_correction = \"volume\"", verlet),
            "1kB",
        ),
        (
            body(block, "model = \"linear\", bonds = \"convolution\"", verlet),
            "1kB",
        ),
        (body(block, "bonds = \"grid\"", rk4), "1kB"),
        (
            body(plate, "bonds = \"list\", critical_stretch = 0.1", verlet),
            "1kB",
        ),
        (body(plate, "bonds = \"list\"", rk4), "1kB"),
        (body(bar, "bonds = \"list\"", verlet), "1kB"),
        (sphere.to_owned(), "5MB"),
        (end("blocked", 20_000), "100kB"),
        (end("blocked", 60_000), "100kB"),
        (end("direct", 20_000), "100kB"),
    ];
    // Memory of the program without a body.
    let none = body(block, "bonds = \"grid\"", verlet).replace("[40, 40, 40]", "[4, 4, 4]");
    fs::write(place.path().join("none.toml"), none).unwrap();
    let peak = |deck: &str| {
        // The time steps are not measured.
        let line =
            format!("run {deck}.toml --quiet --no-cache --threads 1 --out {deck} --wall-time 1s");
        let status = run(place.path(), &line).status.code();
        assert!(matches!(status, Some(0 | 7)), "{status:?}");
        report(&place.path().join(deck))["progress"]["peak_memory"]
            .as_f64()
            .unwrap()
    };
    let base = peak("none");
    for (k, (text, limit)) in cases.iter().enumerate() {
        let deck = format!("case-{k}");
        fs::write(place.path().join(format!("{deck}.toml")), text).unwrap();
        let line = format!("check {deck}.toml --max-memory {limit}");
        let (_, message) = fail(place.path(), &line);
        let words: Vec<&str> = message
            .split("needs about ")
            .nth(1)
            .unwrap()
            .split(' ')
            .collect();
        assert_eq!(words[1], "MB", "{message}");
        let estimate = 1e6 * words[0].parse::<f64>().unwrap();
        let taken = peak(&deck) - base;
        println!(
            "{text}estimated {:.1} MB, taken {:.1} MB",
            1e-6 * estimate,
            1e-6 * taken
        );
        assert!(
            (0.7..2.5).contains(&(estimate / taken)),
            "{text}{estimate:e} {taken:e}"
        );
    }
}
