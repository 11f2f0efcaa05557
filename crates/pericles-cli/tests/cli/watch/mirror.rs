//! Mirror symmetries of a run.

use std::path::Path;

use super::{warned_of, warnings, without_warnings};
use crate::common::report;

/// Returns the mirror symmetries of a run: axis, whether antisymmetric, and the error at the end.
fn images(place: &Path, deck: &str, more: &str) -> Vec<(String, bool, f64)> {
    warnings(place, deck, more);
    let report = report(&place.join("out"));
    let list = report["audit"]["mirror_errors"].as_array();
    list.into_iter()
        .flatten()
        .map(|mirror| {
            let axis = mirror["axis"].as_str().unwrap().to_owned();
            let opposite = mirror["opposite"].as_bool().unwrap();
            (axis, opposite, mirror["error"].as_f64().unwrap())
        })
        .collect()
}

/// A plate pulled at both ends, which bends if its centre line moves.
const PULLED: &str = r#"
body = { shape = "plate", size = [24, 8], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3, critical_stretch = 0.1 }
sets.left = { layer = { side = "-x", cells = 3 } }
sets.right = { layer = { side = "+x", cells = 3 } }
load = [{ set = "left", traction = [-1e-3, 0] }, { set = "right", traction = [1e-3, 0] }]
time = { end = 40 }
output = { fields = "never" }
"#;

#[test]
fn mirror_symmetries_are_detected_and_preserved() {
    let place = tempfile::tempdir().unwrap();
    let axes = |deck: &str| -> Vec<String> {
        let found = images(place.path(), deck, "");
        assert!(
            found.iter().all(|image| !image.1 && image.2 < 1e-11),
            "{found:?}"
        );
        found.into_iter().map(|image| image.0).collect()
    };
    assert_eq!(axes(PULLED), ["x", "y"]);
    // Differences between the sides: a delayed load, a constraint, a velocity, a crack, the failure criterion, the
    // material.
    let others = [
        (
            "load = [",
            "load = [{ set = \"right\", body_force = [1e-6, 0], function = { kind = \"ramp\", duration = 30 } }, ",
            &["y"][..],
        ),
        (
            "time =",
            "constraint = [{ set = \"left\", displacement = [0, 0] }]\ntime =",
            &["y"],
        ),
        (
            "time =",
            "initial = [{ velocity = [0, { expression = \"1e-5*x\" }] }]\ntime =",
            &[],
        ),
        (
            "time =",
            "initial = [{ velocity = [0, { expression = \"1e-5*(x-12)*y\" }] }]\ntime =",
            &[],
        ),
        (
            "time =",
            "initial = [{ velocity = [0, { expression = \"1e-5*(x-12)^2*(y-4)\" }] }]\ntime =",
            &["x", "y"],
        ),
        (
            "time =",
            "crack = [{ segment = [[6, -1], [6, 9]] }]\ntime =",
            &["y"],
        ),
        (
            "critical_stretch = 0.1",
            "critical_stretch = 0.1, no_fail = [\"left\"]",
            &["y"],
        ),
    ];
    for (place, with, expected) in others {
        let deck = PULLED.replacen(place, with, 1);
        assert_eq!(axes(&deck), expected, "{deck}");
    }
}

#[test]
fn a_symmetric_pulse_in_a_bar_is_antisymmetric_in_displacement() {
    let deck = r#"
body = { shape = "bar", length = 40, spacing = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }
initial = [{ displacement = [{ expression = "exp(-((x-20)/4)^2)" }] }]
time = { end = 50 }
output = { fields = "never" }
"#;
    let place = tempfile::tempdir().unwrap();
    let found = images(place.path(), deck, "");
    assert!(
        matches!(&found[..], [(axis, true, error)] if axis == "x" && *error < 1e-12),
        "{found:?}"
    );
}

#[test]
fn loss_of_mirror_symmetry_is_reported() {
    // Compressed ends: rounding determines the direction in which the plate buckles.
    let deck = r#"
body = { shape = "plate", size = [48, 4], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3 }
sets.left = { layer = { side = "-x", cells = 3 } }
sets.right = { layer = { side = "+x", cells = 3 } }
load = [{ set = "left", traction = [0.04, 0] }, { set = "right", traction = [-0.04, 0] }]
time = { end = 1000, dt = 0.5 }
output = { fields = "never" }
"#;
    let says = ["the data are mirror-symmetric about x and y", "buckling"];
    warned_of(deck, &says, "--set time.end=20");
}

#[test]
fn a_body_that_is_heated_on_one_side_has_no_mirror_symmetry_to_lose() {
    let body = r#"
body = { shape = "plate", size = [12, 6], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3 }
output = { fields = "never" }
"#;
    // Computed temperatures, and prescribed ones that are symmetric at the start only.
    for (more, across) in [
        (
            r#"
sets.face = { layer = { side = "-y", cells = 1 } }
time = { scheme = "static", end = 2, load_steps = 2, rigid_modes = "fix" }
[thermal]
conductivity = 1
specific_heat = 1
expansion = 1e-5
reference = 500
temperature = 500
scheme = "backward-euler"
condition = [{ set = "face", convection = { coefficient = 1, ambient = 300 } }]
"#,
            "y",
        ),
        (
            r#"
thermal = { expansion = 1e-5, reference = 0, temperature = { expression = "x*t" } }
time = { end = 5 }
"#,
            "x",
        ),
    ] {
        let (audit, _) = without_warnings(&format!("{body}{more}"));
        let mirrors = audit["mirror_errors"].as_array().unwrap();
        assert_eq!(mirrors.len(), 1, "{audit}");
        assert_ne!(mirrors[0]["axis"], across);
    }
}
