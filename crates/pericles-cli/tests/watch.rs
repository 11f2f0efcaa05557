//! The physics watch: each of its warnings on a run that deserves it, and the same run done better without.

mod common;

use std::fs;
use std::path::Path;

use common::{report, run, succeed, text};

/// Runs a deck; the warnings of the audit.
fn warnings(place: &Path, deck: &str, more: &str) -> Vec<String> {
    fs::write(place.join("deck.toml"), deck).unwrap();
    let output = succeed(place, &format!("run deck.toml --out out --force {more}"));
    let report = report(&place.join("out"));
    let list = report["audit"]["warnings"].as_array().unwrap();
    let list: Vec<String> = list
        .iter()
        .map(|warning| warning.as_str().unwrap().to_owned())
        .collect();
    // What is in the report is on the screen.
    let shown = text(&output.stderr) + &text(&output.stdout);
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    for warning in &list {
        assert!(
            words(&shown).contains(&words(warning)),
            "{warning}\n{shown}"
        );
    }
    list
}

/// Wants exactly one warning, which says this, of a run, and none with the changes.
fn warned_of(deck: &str, says: &[&str], cure: &str) {
    let place = tempfile::tempdir().unwrap();
    let found = warnings(place.path(), deck, "");
    assert_eq!(found.len(), 1, "{found:?}");
    for part in says {
        assert!(found[0].contains(part), "{found:?}");
    }
    let found = warnings(place.path(), deck, cure);
    assert!(found.is_empty(), "{cure}: {found:?}");
}

#[test]
fn energy_that_a_scheme_loses() {
    // A fourth-order scheme damps short waves: by (ω dt)⁶/72 a step.
    let deck = r#"
body = { shape = "bar", length = 40, spacing = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }
initial = [{ velocity = [{ expression = "sin(2.5*x)" }] }]
time = { scheme = "rk4", end = 50, dt = 1 }
output = { fields = "never", history = "never" }
"#;
    let says = [
        "the energy account is off by up to",
        "%",
        "smaller time step",
    ];
    warned_of(deck, &says, "--set time.dt=0.1");
}

#[test]
fn momentum_of_a_support_that_moves() {
    // The impulse of a support is booked by its reactions at the ends of steps, what the body feels is that of the stages between.
    let deck = r#"
body = { shape = "bar", length = 10, spacing = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }
sets.left = { layer = { side = "-x", cells = 3 } }
prescribe = [{ set = "left", displacement = [{ expression = "0.01*sin(t)^2" }] }]
time = { scheme = "rk4", end = 50, dt = 0.4 }
output = { fields = "never" }
"#;
    let says = [
        "the momentum account is off by",
        "what the energy could have made",
        "smaller time step",
    ];
    warned_of(deck, &says, "--set time.dt=0.05");
}

/// A bar that is held at one end and pulled by a load that acts at once.
const DEAD: &str = r#"
body = { shape = "bar", length = 40, spacing = 1 }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3 }
sets.left = { layer = { side = "-x", cells = 3 } }
sets.right = { layer = { side = "+x", cells = 3 } }
prescribe = [{ set = "left", displacement = [0] }]
load = [{ set = "right", traction = [1e-3] }]
time = { scheme = "relaxation", tolerance = 1e-9 }
output = { fields = "never" }
"#;

#[test]
fn a_dead_load_in_one_load_step_does_the_work_that_is_stored() {
    let place = tempfile::tempdir().unwrap();
    assert_eq!(warnings(place.path(), DEAD, ""), [""; 0]);
    let audit = report(&place.path().join("out"))["audit"].clone();
    let number = |name: &str| audit[name].as_f64().unwrap();
    let (work, elastic) = (number("external_work"), number("elastic_energy"));
    assert!(
        elastic > 0.0 && (work / elastic - 1.0).abs() < 1e-5,
        "{work} {elastic}"
    );
    assert!(number("energy_drift").abs() < 1e-5);
    // Static states have no momentum.
    assert!(audit["momentum_error"].is_null());
    let shown = text(&succeed(place.path(), "run deck.toml --out out --force").stdout);
    assert!(
        shown.contains("audit: energy off by") && !shown.contains("momentum"),
        "{shown}"
    );
    // Supports that are displaced at once, and an initial displacement that relaxes.
    for more in [
        "--set load=[] --set prescribe=[{set='left',displacement=[0]},{set='right',displacement=[0.04]}]",
        "--set initial=[{displacement=[{expression='1e-3*sin(x)'}]}]",
        "--set time.load_steps=5",
    ] {
        assert_eq!(warnings(place.path(), DEAD, more), [""; 0], "{more}");
        let audit = report(&place.path().join("out"))["audit"].clone();
        assert!(
            audit["energy_drift"].as_f64().unwrap().abs() < 1e-5,
            "{more}: {audit}"
        );
    }
}

#[test]
fn work_between_static_states_that_are_far_apart() {
    // The force is far from linear between rest and a strain of a quarter.
    let says = [
        "the energy balance of the static states is off by up to",
        "grow over more load steps",
        "time.load_steps",
    ];
    let stiff = DEAD
        .replace("material = {", "material = { model = \"green-strain\",")
        .replace("traction = [1e-3]", "traction = [0.3]");
    warned_of(
        &stiff,
        &says,
        "--set time.load_steps=40 --set load.0.function={kind='ramp',duration=1}",
    );
}

/// Mirror images that a run has: axis, whether with the opposite sign, and the error at its end.
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

/// A plate that is pulled at both ends, and bends in the middle if its middle line moves.
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
fn images_are_found_and_kept() {
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
    // What is different on one side: a load that comes later, a support, a velocity, a crack, what breaks, the material.
    let others = [
        (
            "load = [",
            "load = [{ set = \"right\", body_force = [1e-6, 0], function = { kind = \"ramp\", duration = 30 } }, ",
            &["y"][..],
        ),
        (
            "time =",
            "prescribe = [{ set = \"left\", displacement = [0, 0] }]\ntime =",
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
fn a_hump_in_a_bar_is_its_image_with_the_opposite_sign() {
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
fn images_that_are_lost() {
    // Ends that meet: the plate buckles to the side that rounding chooses.
    let deck = r#"
body = { shape = "plate", size = [48, 4], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3 }
sets.left = { layer = { side = "-x", cells = 3 } }
sets.right = { layer = { side = "+x", cells = 3 } }
load = [{ set = "left", traction = [0.04, 0] }, { set = "right", traction = [-0.04, 0] }]
time = { end = 1000, dt = 0.5 }
output = { fields = "never" }
"#;
    let says = [
        "its own mirror image in x and y and is none any more",
        "buckle",
    ];
    warned_of(deck, &says, "--set time.end=20");
}

#[test]
fn a_static_state_that_is_none() {
    let deck = r#"
body = { shape = "bar", length = 40, spacing = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }
sets.left = { layer = { side = "-x", cells = 3 } }
sets.right = { layer = { side = "+x", cells = 3 } }
prescribe = [{ set = "left", displacement = [0] }]
load = [{ set = "right", traction = [1e-3] }]
time = { scheme = "relaxation", tolerance = 0.1 }
output = { fields = "never" }
"#;
    let says = ["loads and reactions differ by", "smaller tolerance"];
    warned_of(deck, &says, "--set time.tolerance=1e-8");
}

#[test]
fn bonds_about_to_break() {
    // A uniform strain of 19/20 of what a bond stands.
    let deck = r#"
body = { shape = "plate", size = [20, 10], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3, critical_stretch = 0.01 }
initial = [{ displacement = [{ expression = "0.0095*x" }, 0] }]
time = { end = 0.1, dt = 0.1 }
output = { fields = "never" }
"#;
    let says = ["of the points have bonds beyond 90", "none broke"];
    warned_of(deck, &says, "--set material.critical_stretch=0.02");
}

#[test]
fn waves_that_the_grid_does_not_carry() {
    // Two cells a wave, and twenty.
    let deck = |waves: f64| {
        format!(
            r#"
body = {{ shape = "bar", length = 200, spacing = 1 }}
material = {{ model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }}
initial = [{{ velocity = [{{ expression = "exp(-((x-100)/30)^2)*cos({waves}*x)" }}] }}]
time = {{ end = 10, dt = 0.1 }}
output = {{ fields = "never" }}
"#
        )
    };
    let place = tempfile::tempdir().unwrap();
    for (waves, expected) in [(3.0, true), (0.05, false)] {
        fs::write(place.path().join("deck.toml"), deck(waves)).unwrap();
        let output = run(place.path(), "check deck.toml");
        let told = text(&output.stdout) + &text(&output.stderr);
        let told = told.contains("energy of this initial velocity is in waves shorter than");
        assert_eq!(told, expected, "{waves}");
        succeed(place.path(), "run deck.toml --quiet --out out --force");
        let report = report(&place.path().join("out"));
        let list = report["model"]["warnings"].to_string();
        assert_eq!(list.contains("waves shorter than"), expected, "{list}");
    }
}

#[test]
fn bonds_that_break_in_masses() {
    // A bar that is torn to pieces by a spread of speeds.
    let deck = r#"
body = { shape = "bar", length = 40, spacing = 1 }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3, critical_stretch = 0.01 }
initial = [{ velocity = [{ expression = "0.1*x" }] }]
time = { end = 20 }
output = { fields = "never", history = "never" }
"#;
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("deck.toml"), deck).unwrap();
    let shown = |more: &str| {
        let output = succeed(
            place.path(),
            &format!("run deck.toml --out out --force {more}"),
        );
        let report = report(&place.path().join("out"));
        let warnings = report["model"]["warnings"].as_array().unwrap();
        let in_masses = |text: &str| text.matches("falls apart in masses").count();
        let kept = warnings.iter().filter_map(|warning| warning.as_str());
        (
            in_masses(&text(&output.stderr)),
            kept.map(in_masses).sum::<usize>(),
        )
    };
    // One warning, on the screen and in the report.
    assert_eq!(shown(""), (1, 1));
    assert_eq!(shown("--quiet"), (0, 1));
    assert_eq!(shown("--set material.critical_stretch=30"), (0, 0));
}
