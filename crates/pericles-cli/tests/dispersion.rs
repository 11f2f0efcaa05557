//! The command `dispersion`.

mod common;

use std::fs;

use common::{PLATE, fail, succeed};
use serde_json::Value;

#[test]
fn curves_classes_and_a_summary() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("plate.toml"), PLATE).unwrap();
    succeed(place.path(), "dispersion plate.toml");
    let folder = place.path().join("plate-dispersion");
    for name in ["curves.png", "polar.csv", "polar.png", "classes.csv"] {
        assert!(folder.join(name).is_file(), "{name}");
    }
    let text = fs::read_to_string(folder.join("dispersion.json")).unwrap();
    let summary: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(summary["stable"], true);
    let number = |key: &str| summary[key].as_f64().unwrap();
    assert!((number("dt_max") * number("omega_max") - 2.0).abs() < 1e-12);
    assert!(number("dt") < number("dt_max"));

    // Every number of the curves obeys (2/dt) asin(ω dt/2).
    let csv = pericles_io::read_csv(folder.join("curves.csv")).unwrap();
    let column = |name: &str| csv.column(name).unwrap().to_vec();
    for branch in ["p", "s"] {
        let (omega, discrete) = (
            column(&format!("omega_{branch}")),
            column(&format!("omega_verlet_{branch}")),
        );
        assert_eq!(omega.len(), 603);
        for (omega, discrete) in omega.iter().zip(&discrete) {
            let dt = number("dt");
            assert!((2.0 / dt * (0.5 * dt * omega).asin() - discrete).abs() <= 1e-9 * discrete);
        }
    }
}

#[test]
fn directions_and_refusals() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("plate.toml"), PLATE).unwrap();
    succeed(
        place.path(),
        "dispersion plate.toml --direction 2,1 --out ray --quiet",
    );
    let csv = pericles_io::read_csv(place.path().join("ray/curves.csv")).unwrap();
    let (x, y) = (csv.column("k_x").unwrap(), csv.column("k_y").unwrap());
    assert!(
        x.iter()
            .zip(y)
            .all(|(x, y)| (x - 2.0 * y).abs() < 1e-9 * (1.0 + x.abs()))
    );
    assert_eq!(fail(place.path(), "dispersion plate.toml --out ray").0, 6);
    assert_eq!(fail(place.path(), "dispersion missing.toml").0, 3);
    assert_eq!(
        fail(place.path(), "dispersion plate.toml --direction 0,0").0,
        2
    );
}

#[test]
fn cells_longer_along_one_axis() {
    let place = tempfile::tempdir().unwrap();
    let text = PLATE
        .replace("spacing = \"1 mm\"", "spacing = [\"1 mm\", \"0.75 mm\"]")
        .replace("cells = 1", "depth = \"1 mm\"");
    fs::write(place.path().join("plate.toml"), text).unwrap();
    succeed(place.path(), "dispersion plate.toml --quiet --out slender");
    let folder = place.path().join("slender");
    let read = |name: &str| pericles_io::read_csv(folder.join(name)).unwrap();
    let curves = read("curves.csv");
    let largest = |name: &str| -> f64 {
        let column = curves.column(name).unwrap();
        column.iter().copied().fold(0.0, f64::max)
    };
    // The zone ends at π over each spacing.
    assert!((largest("k_x") / (std::f64::consts::PI / 1e-3) - 1.0).abs() < 1e-12);
    assert!((largest("k_y") / (std::f64::consts::PI / 0.75e-3) - 1.0).abs() < 1e-12);
    assert!(largest("omega_x") > 0.0 && largest("omega_y") > 0.0);
    // Bonds up to three of the larger spacings and half a cell, one of each pair.
    let bonds = read("classes.csv");
    let length = bonds.column("length").unwrap();
    let reach = 3e-3 + 0.5 * 0.75f64.sqrt() * 1e-3;
    assert!(length.iter().all(|r| *r <= reach) && length.len() > 14);
    // The slender cells run, too.
    succeed(place.path(), "run plate.toml --quiet --out run");
}
