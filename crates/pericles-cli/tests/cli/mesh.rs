//! The commands `mesh` and `export`.

use std::fs;
use std::path::Path;

use crate::common::{fail, succeed, text};
use serde_json::Value;

fn example(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/geometry");
    folder
        .canonicalize()
        .unwrap()
        .join(name)
        .display()
        .to_string()
}

fn json(folder: &Path, arguments: &str) -> Value {
    let output = succeed(folder, arguments);
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn mesh_reports_json_in_si_units() {
    let place = tempfile::tempdir().unwrap();
    let file = example("dogbone.msh");
    let arguments = format!("mesh {file} --unit mm --thickness 2mm --json -");
    let mesh = json(place.path(), &arguments);
    let number = |pointer: &str| mesh.pointer(pointer).and_then(Value::as_f64).unwrap();
    let close = |a: f64, b: f64, relative: f64| assert!((a / b - 1.0).abs() < relative, "{a} {b}");
    assert_eq!(mesh["points"], 2296);
    // Area of the drawing: clamping areas, fillets with radius 20 mm by their circular segments, gauge section. The
    // chords of the mesh make it slightly smaller.
    let run = (20.0f64.powi(2) - 15.0f64.powi(2)).sqrt();
    let angle = (run / 20.0).asin();
    let under_fillet = 23.0 * run - 0.5 * (run * 15.0 + 400.0 * angle);
    let area = 20.0 * 6.0 + 4.0 * under_fillet + 2.0 * (30.0 - 10.0 - run) * 16.0;
    close(number("/volume"), 2e-3 * area * 1e-6, 1e-3);
    close(number("/box/0/0"), -0.03, 1e-12);
    close(number("/box/1/1"), 0.008, 1e-12);
    assert!(number("/cell_size/0") < number("/cell_size/1"));
    let sets = mesh["sets"].as_array().unwrap();
    let left = sets.iter().find(|set| set["name"] == "left").unwrap();
    close(left["area"].as_f64().unwrap(), 16e-3 * 2e-3, 1e-12);
    assert_eq!(mesh["problems"].as_array().unwrap().len(), 0);
    // Text output.
    let output = succeed(place.path(), &format!("mesh {file} --unit mm"));
    let words = text(&output.stdout);
    assert!(
        words.contains(" triangles") && words.contains("left (faces): 20 points"),
        "{words}"
    );
}

#[test]
fn mesh_reports_the_enclosed_volume_of_a_surface() {
    let place = tempfile::tempdir().unwrap();
    let file = example("bracket.stl");
    let surface = json(place.path(), &format!("mesh {file} --unit mm --json -"));
    assert_eq!(
        (&surface["points"], &surface["cell_size"]),
        (&Value::from(0), &Value::Null)
    );
    // Two arms of 40 × 8 × 20 mm with a fillet, less a bolt hole, which the triangles make smaller.
    let exact =
        11_520.0 + (16.0 - 4.0 * std::f64::consts::PI) * 20.0 - std::f64::consts::PI * 16.0 * 8.0;
    let volume = surface["volume"].as_f64().unwrap() * 1e9;
    assert!((volume / exact - 1.0).abs() < 0.01, "{volume} {exact}");
    assert_eq!(surface["problems"].as_array().unwrap().len(), 0);
}

#[test]
fn invalid_mesh_files_are_rejected() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("a.inp"), "*NODE\n1, 0, 0, 0\n").unwrap();
    for (arguments, status, part) in [
        ("mesh a.inp", 3, "the file contains no elements"),
        ("mesh none.msh", 3, "none.msh"),
        ("mesh a.txt", 3, "unknown mesh format"),
        ("mesh a.inp --unit parsec", 2, "expected a length unit"),
        ("export . --to npz", 3, "run.json"),
    ] {
        let (found, words) = fail(place.path(), arguments);
        assert_eq!(found, status, "{arguments}: {words}");
        assert!(words.contains(part), "{arguments}: {words}");
    }
}

#[test]
fn fields_are_exported_to_every_format_without_overwriting() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    fs::write(folder.join("plate.toml"), crate::common::PLATE).unwrap();
    succeed(folder, "run plate.toml --quiet --out plate");
    for (format, file) in [
        ("exodus", "fields.exo"),
        ("vtkhdf", "fields.vtkhdf"),
        ("csv", "fields-csv"),
        ("npz", "fields.npz"),
    ] {
        let arguments = format!("export plate --to {format}");
        succeed(folder, &arguments);
        assert!(folder.join("plate").join(file).exists());
        let (status, words) = fail(folder, &arguments);
        assert_eq!(status, 6);
        assert!(words.contains("already exists"), "{words}");
    }
    let archive = fs::read(folder.join("plate/fields.npz")).unwrap();
    assert_eq!(&archive[..4], b"PK\x03\x04");
}
