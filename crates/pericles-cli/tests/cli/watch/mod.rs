//! Warnings about finished runs: each one for a run with the problem, and none for the corrected run.

mod implicit;
mod layers;
mod mirror;
mod multirate;
mod statics;
mod thin;

use std::fs;
use std::path::Path;

use crate::common::{report, run, succeed, text};

/// Runs a deck and returns the warnings in `run.json`.
fn warnings(place: &Path, deck: &str, more: &str) -> Vec<String> {
    fs::write(place.join("deck.toml"), deck).unwrap();
    let output = succeed(place, &format!("run deck.toml --out out --force {more}"));
    let report = report(&place.join("out"));
    let list = report["audit"]["warnings"].as_array().unwrap();
    let list: Vec<String> = list
        .iter()
        .map(|warning| warning.as_str().unwrap().to_owned())
        .collect();
    // The warnings of the report are also printed.
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

/// Asserts that a run has exactly one warning with the given text, and none with the overrides.
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

/// Runs a deck that must give no warnings after the run; returns the audit and the printed text.
fn without_warnings(deck: &str) -> (serde_json::Value, String) {
    let place = tempfile::tempdir().unwrap();
    assert_eq!(warnings(place.path(), deck, ""), [""; 0], "{deck}");
    let audit = report(&place.path().join("out"))["audit"].clone();
    let shown = text(&succeed(place.path(), "run deck.toml --out out --force").stdout);
    (audit, shown)
}

/// Returns the last row of `reactions.csv` without step and time.
fn reactions(place: &Path) -> Vec<f64> {
    let table = fs::read_to_string(place.join("out/reactions.csv")).unwrap();
    let last = table.lines().last().unwrap().split(',').skip(2);
    last.map(|number| number.parse().unwrap()).collect()
}

#[test]
fn energy_loss_of_the_scheme_is_reported() {
    // A fourth-order scheme damps short waves: by (ω dt)⁶/72 a step.
    let deck = r#"
body = { shape = "bar", length = 40, spacing = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }
initial = [{ velocity = [{ expression = "sin(2.5*x)" }] }]
time = { scheme = "rk4", end = 50, dt = 1 }
output = { fields = "never", history = "never" }
"#;
    let says = [
        "the error of the energy balance reaches",
        "%",
        "reduce the time step",
    ];
    warned_of(deck, &says, "--set time.dt=0.1");
}

#[test]
fn momentum_error_at_a_moving_constraint_is_reported() {
    // The impulse of a constraint is computed from its reactions at the ends of the steps; the body receives the impulse of
    // the intermediate stages.
    let deck = r#"
body = { shape = "bar", length = 10, spacing = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }
sets.left = { layer = { side = "-x", cells = 3 } }
constraint = [{ set = "left", displacement = [{ expression = "0.01*sin(t)^2" }] }]
time = { scheme = "rk4", end = 50, dt = 0.4 }
output = { fields = "never" }
"#;
    let says = [
        "the momentum error is",
        "√(2 · energy · mass)",
        "smaller time step",
    ];
    warned_of(deck, &says, "--set time.dt=0.05");
}

#[test]
fn bonds_close_to_failure_are_reported() {
    // A uniform strain of 0.95 times the critical stretch.
    let deck = r#"
body = { shape = "plate", size = [20, 10], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3, critical_stretch = 0.01 }
initial = [{ displacement = [{ expression = "0.0095*x" }, 0] }]
time = { end = 0.1, dt = 0.1 }
output = { fields = "never" }
"#;
    let says = ["of the points have bonds above 90", "no bond broke"];
    warned_of(deck, &says, "--set material.critical_stretch=0.02");
}

#[test]
fn waves_not_resolved_by_the_grid_are_reported() {
    // Two and twenty cells per wavelength.
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
fn breaking_of_most_bonds_is_reported() {
    // A bar that fragments because of its initial velocities.
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
        let in_masses = |text: &str| text.matches("disintegrates").count();
        let kept = warnings.iter().filter_map(|warning| warning.as_str());
        (
            in_masses(&text(&output.stderr)),
            kept.map(in_masses).sum::<usize>(),
        )
    };
    // One warning, on standard error and in the report.
    assert_eq!(shown(""), (1, 1));
    assert_eq!(shown("--quiet"), (0, 1));
    assert_eq!(shown("--set material.critical_stretch=30"), (0, 0));
}
