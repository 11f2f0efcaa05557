//! The command `dispersion`.

use std::fs;

use crate::common::{PLATE, fail, succeed};
use serde_json::Value;

#[test]
fn curves_bond_classes_and_a_summary_are_written() {
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

    // All values of the curves satisfy ω_d = (2/dt) asin(ω dt/2).
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
fn directions_are_checked_and_existing_folders_are_kept() {
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
    let (status, message) = fail(place.path(), "dispersion plate.toml --out ray");
    assert_eq!(status, 6);
    assert!(
        message.contains("move the folder") && !message.contains("--force"),
        "{message}"
    );
    let (status, message) = fail(place.path(), "dispersion plate.toml --direction 1,2,3");
    assert_eq!(status, 2);
    assert!(
        message.contains("--direction has 3 components; the body has 2"),
        "{message}"
    );
    assert_eq!(fail(place.path(), "dispersion missing.toml").0, 3);
    assert_eq!(
        fail(place.path(), "dispersion plate.toml --direction 0,0").0,
        2
    );
}

#[test]
fn anisotropic_spacing_is_analysed() {
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
    // The boundary of the Brillouin zone is at π over each spacing.
    assert!((largest("k_x") / (std::f64::consts::PI / 1e-3) - 1.0).abs() < 1e-12);
    assert!((largest("k_y") / (std::f64::consts::PI / 0.75e-3) - 1.0).abs() < 1e-12);
    assert!(largest("omega_x") > 0.0 && largest("omega_y") > 0.0);
    // Bonds up to three and a half of the larger spacing, one of each pair.
    let bonds = read("classes.csv");
    let length = bonds.column("length").unwrap();
    let reach = 3e-3 + 0.5 * 0.75f64.sqrt() * 1e-3;
    assert!(length.iter().all(|r| *r <= reach) && length.len() > 14);
    // The deck with anisotropic spacing also runs.
    succeed(place.path(), "run plate.toml --quiet --out run");
}

#[test]
fn long_horizons_are_analysed() {
    let place = tempfile::tempdir().unwrap();
    let text = r#"
body = { shape = "bar", length = 400, spacing = 1 }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 120 }
time = { end = 1 }
"#;
    fs::write(place.path().join("bar.toml"), text).unwrap();
    succeed(place.path(), "dispersion bar.toml --quiet --out long");
    let classes = pericles_io::read_csv(place.path().join("long/classes.csv")).unwrap();
    assert_eq!(classes.column("i").unwrap().len(), 120);
}

#[test]
fn listed_points_have_no_lattice() {
    let place = tempfile::tempdir().unwrap();
    let points: String = (0..40)
        .map(|i| format!("{} {} 1 1\n", i % 8, i / 8))
        .collect();
    fs::write(place.path().join("points.txt"), points).unwrap();
    let text = r#"
[body]
shape = "points"
file = "points.txt"
spacing = 1
dimension = 2
plane = "strain"
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
[time]
end = 1
"#;
    fs::write(place.path().join("points.toml"), text).unwrap();
    let (status, message) = fail(place.path(), "dispersion points.toml --out none");
    assert_eq!(status, 3);
    assert!(
        message.contains("points.toml:2:1: plane waves are available for regular grids only"),
        "{message}"
    );
    assert!(!place.path().join("none").exists());
}

#[test]
fn tuned_coefficients_wave_vectors_and_parts_not_included_are_reported() {
    let place = tempfile::tempdir().unwrap();
    let text = r#"
[body]
shape = "plate"
size = [20, 10]
spacing = 0.5
plane = "strain"
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
volume_correction = "none"
influence = { function = "tuned", method = "point-collocation", decay = "none" }
[time]
end = 1
"#;
    fs::write(place.path().join("plate.toml"), text).unwrap();
    let shown = succeed(
        place.path(),
        "dispersion plate.toml --wavevector 1.5,0 --wavevector 0.3,0.4 --out tuned",
    );
    let shown = crate::common::text(&shown.stdout);
    assert!(shown.contains("ω at k = (1.500, 0, 0) rad/m"), "{shown}");
    assert!(shown.contains("residual functionals"), "{shown}");
    let folder = place.path().join("tuned");
    let summary = fs::read_to_string(folder.join("dispersion.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    let tuning = &summary["tuning"];
    assert_eq!(tuning["method"], "point-collocation");
    assert_eq!(tuning["decay"], Value::Null);
    // Four functionals of two branches.
    assert_eq!(tuning["functionals"].as_array().unwrap().len(), 4);
    assert_eq!(tuning["functionals"][0].as_array().unwrap().len(), 2);
    assert!((tuning["error_ratio"].as_f64().unwrap() - 0.3951).abs() < 1e-3);
    // Long-wave speeds 1.2^(1/2) and 0.4^(1/2), with this table to 1 % at |k| D = 0.25.
    let long = &summary["wavevectors"][1]["modes"];
    for (mode, speed) in [(0, 1.2f64.sqrt()), (1, 0.4f64.sqrt())] {
        let found = long[mode]["phase_velocity"].as_f64().unwrap();
        assert!((found / speed - 1.0).abs() < 0.02, "{found} {speed}");
        let omega = long[mode]["omega"].as_f64().unwrap();
        assert!((omega - 0.5 * found).abs() < 1e-12);
    }
    // The curves contain the same values: k = 1.5 lies on the first segment.
    let table = pericles_io::read_csv(folder.join("wavevectors.csv")).unwrap();
    assert_eq!(table.column("omega").unwrap().len(), 4);
    let omega = summary["wavevectors"][0]["modes"][0]["omega"]
        .as_f64()
        .unwrap();
    let curves = pericles_io::read_csv(folder.join("curves.csv")).unwrap();
    let (k, p) = (
        curves.column("k_x").unwrap(),
        curves.column("omega_p").unwrap(),
    );
    let near = (0..201).find(|&i| k[i] >= 1.5).unwrap();
    assert!(p[near - 1] <= omega && omega <= p[near], "{omega}");

    // Parts of the deck that the analysis of the first material does not include.
    let two = text.replace(
        "[time]",
        "[[assign]]\nset = \"left\"\nstiffness = 2\n[sets]\nleft = { layer = { side = \"-x\", cells = 3 } }\n[time]",
    );
    let two = two.replace(
        "influence =",
        "surface_correction = \"volume\"\ninfluence =",
    );
    fs::write(place.path().join("two.toml"), two).unwrap();
    let output = succeed(place.path(), "dispersion two.toml --quiet --out two");
    let said = crate::common::text(&output.stderr);
    assert!(
        said.contains("1 assigned stiffness is not included"),
        "{said}"
    );
    assert!(
        said.contains("the surface correction is not included"),
        "{said}"
    );
}

#[test]
fn unstable_kernels_can_be_analysed() {
    let place = tempfile::tempdir().unwrap();
    let text = r#"
[body]
shape = "plate"
size = [20, 10]
spacing = 1
plane = "strain"
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
volume_correction = "none"
influence = { function = "tuned", method = "subdomain-collocation", decay = "none", lower_bound = "none" }
[time]
end = 1
"#;
    fs::write(place.path().join("plate.toml"), text).unwrap();
    let (status, message) = fail(place.path(), "dispersion plate.toml");
    assert_eq!(status, 3);
    assert!(message.contains("allow_unstable"), "{message}");
    let shown = succeed(
        place.path(),
        "dispersion plate.toml --set time.allow_unstable=true",
    );
    assert!(crate::common::text(&shown.stdout).contains("UNSTABLE"));
    let (status, message) = fail(
        place.path(),
        "dispersion plate.toml --measure --set time.allow_unstable=true --out none",
    );
    assert_eq!(status, 3);
    assert!(
        message.contains("the spectrum cannot be measured"),
        "{message}"
    );
    assert!(!place.path().join("none").exists());
}
