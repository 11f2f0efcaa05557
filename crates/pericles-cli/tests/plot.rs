//! Pictures and histories drawn again, the schema, and numbers that converge.

mod common;

use std::fs;

use common::{fail, succeed, text, with_plate};

#[test]
fn what_the_run_drew_is_drawn_again_byte_for_byte() {
    let place = with_plate();
    // States are written when pictures are drawn.
    let line = "run plate.toml --quiet --set output.fields.every=150 --set output.picture.0.every=150 --out a";
    succeed(place.path(), line);
    succeed(place.path(), "plot a --field Damage,Velocity_y --time all");
    for field in ["Damage", "Velocity_y"] {
        for number in 0..4 {
            let name = format!("{field}-{number:06}.png");
            let [own, again] = ["pictures", "plots"]
                .map(|folder| fs::read(place.path().join("a").join(folder).join(&name)).unwrap());
            // A common range is taken for several pictures where the deck gives none: damage has one.
            assert!(own == again || field != "Damage", "{name}");
        }
    }
    succeed(place.path(), "plot a --field Velocity_y --time last");
    let last = |folder| {
        fs::read(
            place
                .path()
                .join("a")
                .join(folder)
                .join("Velocity_y-000003.png"),
        )
    };
    assert!(last("pictures").unwrap() == last("plots").unwrap());
}

#[test]
fn pictures_of_other_kinds_are_drawn_and_histories_shown() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --out a");
    let said = succeed(place.path(), "plot a --format svg --out b");
    let names = text(&said.stdout);
    for name in ["b/Damage-000005.svg", "b/history-energy.svg"] {
        assert!(names.contains(name), "{names}");
        let svg = fs::read_to_string(place.path().join(name)).unwrap();
        assert!(
            svg.starts_with("<svg ") && svg.ends_with("</svg>\n"),
            "{name}"
        );
    }
    let line = "plot a --field Displacement --animation --width 400 --range 0:1e-4 --out c";
    let names = text(&succeed(place.path(), line).stdout);
    assert!(names.contains("Displacement.apng"), "{names}");
    let shown = succeed(
        place.path(),
        "plot a --history kinetic_energy,elastic_energy --terminal",
    );
    let shown = text(&shown.stdout);
    assert!(
        shown.starts_with("energy: * kinetic energy  + elastic energy"),
        "{shown}"
    );
    let (status, message) = fail(place.path(), "plot a --field Velocity_z");
    assert_eq!(status, 2);
    assert!(message.contains("did you mean Velocity"), "{message}");
    let (status, message) = fail(place.path(), "plot a --history energie");
    assert_eq!(status, 2);
    assert!(message.contains("kinetic_energy"), "{message}");
}

#[test]
fn the_schema_is_printed_for_editors_and_people() {
    let place = with_plate();
    let schema = succeed(place.path(), "schema").stdout;
    let schema: serde_json::Value = serde_json::from_slice(&schema).unwrap();
    assert_eq!(schema["properties"]["body"]["additionalProperties"], false);
    let page = text(&succeed(place.path(), "schema --markdown").stdout);
    assert!(page.starts_with("# Deck reference") && page.contains("### [[body.refine]]"));
}

#[test]
fn a_run_draws_its_histories_when_it_ends() {
    let place = with_plate();
    let said = text(&succeed(place.path(), "run plate.toml --chart --out a").stdout);
    let [before, after] =
        ["Results in a", "energy: * kinetic energy"].map(|words| said.find(words));
    assert!(before.is_some() && before < after, "{said}");
    let said = text(&succeed(place.path(), "run plate.toml --out b").stdout);
    assert!(!said.contains("* kinetic energy"), "{said}");
}

#[test]
fn a_field_that_was_left_out_is_told_from_an_unknown_one() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --out a");
    let (status, message) = fail(place.path(), "plot a --field Strain_xx");
    assert_eq!(status, 2);
    assert!(message.contains("output.fields"), "{message}");
}

/// A bar in tension whose end moves by σ L/E, less what the surface effect adds.
const BAR: &str = r#"
[body]
shape = "bar"
length = 1
spacing = 0.05
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 2
[sets.left]
layer = { side = "-x", cells = 2 }
[sets.right]
layer = { side = "+x", cells = 1 }
[[prescribe]]
set = "left"
displacement = 0
[[load]]
set = "right"
traction = 1e-3
[[probe]]
name = "tip"
set = "right"
[time]
scheme = "relaxation"
tolerance = 1e-9
"#;

#[test]
fn a_bar_in_tension_converges_with_its_horizon() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("bar.toml"), BAR).unwrap();
    let line =
        "converge bar.toml --m 2,3 --dx 0.1,0.05,0.025 --scalar tip_u_x --reference 1e-3 --quiet";
    let said = text(&succeed(place.path(), line).stdout);
    assert!(
        said.contains("m = 2\n") && said.contains("m = 3\n"),
        "{said}"
    );
    let table = fs::read_to_string(place.path().join("bar-converge/convergence.csv")).unwrap();
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| {
            line.split(',')
                .map(|cell| cell.parse().unwrap_or(f64::NAN))
                .collect()
        })
        .collect();
    assert_eq!(rows.len(), 6, "{table}");
    for family in rows.chunks(3) {
        let distances: Vec<f64> = family.iter().map(|row| row[4].abs()).collect();
        assert!(
            distances[2] < distances[1] && distances[1] < distances[0],
            "{table}"
        );
        // Ends and supports are off by a part of the horizon: first order.
        let order = family[2][5];
        assert!((0.8..1.3).contains(&order), "{order} {table}");
    }
    assert!(place.path().join("bar-converge/convergence.png").is_file());
    let line =
        "converge bar.toml --m 2,4 --horizon 0.2 --scalar audit.elastic_energy --quiet --out fixed";
    let said = text(&succeed(place.path(), line).stdout);
    assert!(said.contains("δ = 200 mm"), "{said}");
    let (status, message) = fail(
        place.path(),
        "converge bar.toml --m 2 --dx 0.1 --scalar tip_u --quiet",
    );
    assert_eq!(status, 2);
    assert!(message.contains("did you mean tip_u_x"), "{message}");
}
