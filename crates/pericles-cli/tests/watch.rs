//! Warnings about finished runs: each one for a run with the problem, and none for the corrected run.

mod common;

use std::fs;
use std::path::Path;

use common::{report, run, succeed, text};

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

/// A bar, fixed at one end, under a suddenly applied load.
const DEAD: &str = r#"
body = { shape = "bar", length = 40, spacing = 1 }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3 }
sets.left = { layer = { side = "-x", cells = 3 } }
sets.right = { layer = { side = "+x", cells = 3 } }
constraint = [{ set = "left", displacement = [0] }]
load = [{ set = "right", traction = [1e-3] }]
time = { scheme = "adaptive-dynamic-relaxation", tolerance = 1e-9 }
output = { fields = "never" }
"#;

#[test]
fn the_work_of_a_dead_load_in_one_load_step_equals_the_stored_energy() {
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
        shown.contains("energy balance: error") && !shown.contains("momentum"),
        "{shown}"
    );
    // Suddenly prescribed displacements, and an initial displacement that relaxes.
    for more in [
        "--set load=[] --set constraint=[{set='left',displacement=[0]},{set='right',displacement=[0.04]}]",
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
fn large_load_steps_of_a_nonlinear_body_are_reported() {
    // The force is strongly nonlinear up to a strain of 0.25.
    let says = [
        "the error of the energy balance of the static states reaches",
        "over more load steps",
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
fn a_residual_above_the_tolerance_is_reported() {
    let deck = r#"
body = { shape = "bar", length = 40, spacing = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }
sets.left = { layer = { side = "-x", cells = 3 } }
sets.right = { layer = { side = "+x", cells = 3 } }
constraint = [{ set = "left", displacement = [0] }]
load = [{ set = "right", traction = [1e-3] }]
time = { scheme = "adaptive-dynamic-relaxation", tolerance = 0.1 }
output = { fields = "never" }
"#;
    let says = [
        "loads, reactions and contact forces are not in equilibrium",
        "smaller tolerance",
    ];
    warned_of(deck, &says, "--set time.tolerance=1e-8");
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

/// Runs a deck that must give no warnings after the run; returns the audit and the printed text.
fn without_warnings(deck: &str) -> (serde_json::Value, String) {
    let place = tempfile::tempdir().unwrap();
    assert_eq!(warnings(place.path(), deck, ""), [""; 0], "{deck}");
    let audit = report(&place.path().join("out"))["audit"].clone();
    let shown = text(&succeed(place.path(), "run deck.toml --out out --force").stdout);
    (audit, shown)
}

#[test]
fn a_closed_cycle_is_compared_with_the_largest_work() {
    // The work at the end of the cycle is of the order of rounding.
    for scheme in [
        "scheme = 'velocity-verlet'",
        "scheme = 'static', load_steps = 20",
    ] {
        let deck = format!(
            r#"
body = {{ shape = "bar", length = 40, spacing = 1 }}
material = {{ model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }}
sets.left = {{ layer = {{ side = "-x", cells = 3 }} }}
sets.right = {{ layer = {{ side = "+x", cells = 3 }} }}
constraint = [
    {{ set = "left", displacement = [0] }},
    {{ set = "right", displacement = [{{ expression = "0.01*sin(pi*t/4000)^4" }}] }},
]
time = {{ {scheme}, end = 4000 }}
output = {{ fields = "never" }}
"#
        );
        let (audit, _) = without_warnings(&deck);
        let number = |name: &str| audit[name].as_f64().unwrap();
        assert!(number("external_work").abs() < 1e-6 * number("largest_work"));
        assert!(number("energy_drift").abs() < 1e-6, "{audit}");
    }
}

#[test]
fn a_body_that_expands_freely_is_in_equilibrium_without_reactions() {
    let (audit, _) = without_warnings(
        r#"
body = { shape = "plate", size = [20, 10], spacing = 1, plane = "stress" }
material = { model = "state-based", density = 1, youngs_modulus = 1, poisson_ratio = 0.22, horizon_ratio = 3 }
thermal = { expansion = 1e-5, reference = 300, temperature = 400 }
sets.left = { layer = { side = "-x", cells = 1 } }
sets.low = { layer = { side = "-y", cells = 1 } }
constraint = [{ set = "left", displacement = [0, "free"] }, { set = "low", displacement = ["free", 0] }]
time = { scheme = "static" }
output = { fields = "never" }
"#,
    );
    let balance = &audit["static_balance"];
    assert!(
        balance["force_relative"].as_f64().unwrap() < 1e-5,
        "{balance}"
    );
}

#[test]
fn contact_forces_are_part_of_static_equilibrium_and_of_the_printed_energies() {
    let (audit, shown) = without_warnings(
        r#"
body = { shape = "plate", size = [14, 9], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 5, horizon_ratio = 3 }
sets.fixed = { where = "y > 6" }
constraint = [{ set = "fixed", displacement = [0, 0] }]
impactor = [{ name = "wall", shape = "half-space", normal = [0.1, 1], centre = [7, -1.5], displacement = [0, 1.9], function = { kind = "ramp", duration = 1 } }]
time = { scheme = "static", load_steps = 10 }
output = { fields = "never" }
"#,
    );
    let number = |name: &str| audit[name].as_f64().unwrap();
    let parts = number("elastic_energy") + number("contact_energy");
    assert!(number("contact_energy") > 0.01 * parts);
    assert!(
        (parts / number("external_work") - 1.0).abs() < 1e-3,
        "{audit}"
    );
    assert!(shown.contains(", contact "), "{shown}");
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

/// Returns the last row of `reactions.csv` without step and time.
fn reactions(place: &Path) -> Vec<f64> {
    let table = fs::read_to_string(place.join("out/reactions.csv")).unwrap();
    let last = table.lines().last().unwrap().split(',').skip(2);
    last.map(|number| number.parse().unwrap()).collect()
}

#[test]
fn bonds_do_not_cross_a_layer_on_request() {
    // A soft layer of two cells in a stiff bar: springs in series.
    let (length, soft) = (0.1, 1e-6);
    let deck = format!(
        r#"
body = {{ shape = "bar", length = {length}, spacing = 1e-3, area = 1e-4 }}
material = {{ name = "glass", density = 1, youngs_modulus = 1e9, horizon_ratio = 3, modulus = "lattice" }}
materials.glue = {{ density = 1, youngs_modulus = {} }}
assign = [{{ set = "layer", material = "glue" }}]
crack = [{{ layer = "layer" }}]
sets.layer = {{ where = "0.049 < x && x < 0.051" }}
sets.left = {{ layer = {{ side = "-x", cells = 3 }} }}
sets.right = {{ layer = {{ side = "+x", cells = 3 }} }}
constraint = [{{ set = "left", displacement = [0] }}, {{ set = "right", displacement = [1e-4] }}]
time = {{ scheme = "static" }}
output = {{ fields = "never" }}
"#,
        1e9 * soft
    );
    let place = tempfile::tempdir().unwrap();
    let series = 1e9 * soft * 1e-4 * 1e-4 / 2e-3;
    assert_eq!(warnings(place.path(), &deck, ""), [""; 0]);
    let force = reactions(place.path())[1];
    // The nonlocal layer is as compliant as its bonds to the neighbours make it: within a cell of its thickness.
    assert!(
        force > series / 1.5 && force < series / 0.7,
        "{force} {series}"
    );
    warnings(place.path(), &deck, "--set crack=[]");
    let bridged = reactions(place.path())[1];
    assert!(bridged > 1e3 * series, "{bridged}");
}

#[test]
fn the_predicted_surface_effect_of_thin_solids_is_the_measured_one() {
    for (size, plane, influence) in [
        ("[30, 4, 4]", "", "{ function = \"constant\" }"),
        ("[30, 4, 4]", "", "{ function = \"conical\" }"),
        (
            "[40, 3]",
            "plane = \"strain\"",
            "{ function = \"constant\" }",
        ),
    ] {
        let shape = if plane.is_empty() { "block" } else { "plate, " }.trim_end_matches(", ");
        let pull = |c: &str| match plane.is_empty() {
            true => format!("[{c}, \"free\", \"free\"]"),
            false => format!("[{c}, \"free\"]"),
        };
        let length = size.trim_matches(['[', ']']).split(',').next().unwrap();
        let deck = format!(
            r#"
body = {{ shape = "{shape}", size = {size}, spacing = 1{}{plane} }}
material = {{ model = "state-based", density = 1, youngs_modulus = 1, poisson_ratio = 0.25, horizon_ratio = 3, strains = "small", influence = {influence} }}
sets.left = {{ layer = {{ side = "-x", cells = 1 }} }}
sets.right = {{ layer = {{ side = "+x", cells = 1 }} }}
probe = [{{ name = "a", at = {} }}, {{ name = "b", at = {} }}]
constraint = [{{ set = "left", displacement = {} }}, {{ set = "right", displacement = {} }}]
time = {{ scheme = "static", tolerance = 1e-8, rigid_modes = "fix" }}
output = {{ fields = "never" }}
"#,
            if plane.is_empty() { "" } else { ", " },
            if plane.is_empty() {
                "[10.5, 1.5, 1.5]"
            } else {
                "[10.5, 1.5]"
            },
            if plane.is_empty() {
                "[19.5, 1.5, 1.5]"
            } else {
                "[29.5, 1.5]"
            },
            pull("0"),
            pull("1e-4"),
        );
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join("deck.toml"), &deck).unwrap();
        succeed(place.path(), "run deck.toml --quiet --out out --force");
        let report = report(&place.path().join("out"));
        let list = report["model"]["warnings"].as_array().unwrap();
        let line = list.iter().filter_map(|line| line.as_str());
        let line: Vec<&str> = line
            .filter(|line| line.contains("surface effect"))
            .collect();
        assert_eq!(line.len(), 1, "{list:?}");
        let before = line[0].split(" % too").next().unwrap();
        let predicted: f64 = before.rsplit(' ').next().unwrap().parse().unwrap();
        let sign = if line[0].contains("too stiff") {
            1.0
        } else {
            -1.0
        };
        // Stress over strain between two probes far from the ends.
        let table = fs::read_to_string(place.path().join("out/probes.csv")).unwrap();
        let (names, last) = (table.lines().next().unwrap(), table.lines().last().unwrap());
        let column = |name: &str| -> f64 {
            let k = names
                .split(',')
                .position(|one| one.starts_with(name))
                .unwrap();
            last.split(',').nth(k).unwrap().parse().unwrap()
        };
        let gauge = if plane.is_empty() { 9.0 } else { 19.0 };
        let strain = (column("b_u_x") - column("a_u_x")) / gauge;
        let (area, young) = match plane.is_empty() {
            true => (16.0, 1.0),
            false => (3.0, 1.0 / (1.0 - 0.0625)),
        };
        let force = reactions(place.path());
        let x_of_right = force[force.len() / 2];
        let measured = x_of_right.abs() / (area * young * strain) - 1.0;
        // The prediction is the energy of a uniform strain, an upper bound of the stiffness; it was at most 4 % above it.
        let excess = sign * 0.01 * predicted - measured;
        assert!(
            excess > -0.005 && excess < 0.05,
            "{size} {length}: predicted {predicted} %, measured {measured}"
        );
    }
}

#[test]
fn implicit_schemes_accept_residuals_of_rounding_errors() {
    let place = tempfile::tempdir().unwrap();
    // A support moves slowly and comes to rest: in the end the force equals the force of the static state.
    for scheme in ["discrete-gradient", "implicit-midpoint", "trapezoidal"] {
        for dt in ["1e-6", "1e-5"] {
            let deck = format!(
                r#"
body = {{ shape = "bar", length = 0.1, spacing = 1e-3, area = 1e-4 }}
material = {{ model = "linear", density = 7850, youngs_modulus = 2e11, horizon_ratio = 3, modulus = "lattice" }}
sets.l = {{ layer = {{ side = "-x", cells = 3 }} }}
sets.r = {{ layer = {{ side = "+x", cells = 3 }} }}
constraint = [{{ set = "l", displacement = [0] }}, {{ set = "r", displacement = [{{ expression = "1e-5*sin(pi/2*t/2e-3)^2" }}] }}]
time = {{ scheme = "{scheme}", end = 2e-3, dt = {dt} }}
output = {{ fields = "never" }}
"#
            );
            assert_eq!(warnings(place.path(), &deck, ""), [""; 0], "{scheme} {dt}");
            let [left, right] = reactions(place.path())[..] else {
                panic!()
            };
            // Free length between the layers: 94 mm, and a part of the layers.
            assert!(
                (right / 2090.0 - 1.0).abs() < 2e-3,
                "{scheme} {dt}: {right}"
            );
            assert!((left / right + 1.0).abs() < 2e-3, "{scheme} {dt}: {left}");
        }
    }
    // Finite strains have rounding errors at rest.
    for law in [
        "law = \"neo-hooke\"",
        "law = \"hencky\", yield_stress = 1e9",
    ] {
        let deck = format!(
            r#"
body = {{ shape = "plate", size = [0.012, 0.006], spacing = 1e-3, plane = "strain" }}
material = {{ model = "correspondence", {law}, density = 7850, youngs_modulus = 2e11, poisson_ratio = 0.3, horizon_ratio = 3 }}
sets.l = {{ layer = {{ side = "-x", cells = 3 }} }}
sets.r = {{ layer = {{ side = "+x", cells = 3 }} }}
constraint = [{{ set = "l", displacement = [0, 0] }}, {{ set = "r", displacement = [{{ expression = "1e-6*sin(pi/2*t/2e-5)^2" }}, 0] }}]
time = {{ scheme = "implicit-midpoint", end = 2e-6, dt = 2e-7 }}
output = {{ fields = "never" }}
"#
        );
        fs::write(place.path().join("deck.toml"), &deck).unwrap();
        for scheme in ["implicit-midpoint", "trapezoidal"] {
            let more =
                format!("run deck.toml --quiet --out out --force --set time.scheme={scheme}");
            succeed(place.path(), &more);
        }
    }
    // A jump of a prescribed displacement, in steps of many periods.
    let deck = r#"
body = { shape = "plate", size = [12, 6], spacing = 1, plane = "stress" }
material = { model = "correspondence", density = 1000, youngs_modulus = 3e9, poisson_ratio = 0.33, horizon_ratio = 3 }
sets.l = { layer = { side = "-x", cells = 1 } }
sets.r = { layer = { side = "+x", cells = 1 } }
constraint = [{ set = "l", displacement = [0, 0] }, { set = "r", displacement = [0.01, 0] }]
time = { scheme = "newmark", solver = "newton-krylov", end = 100, dt = 10 }
output = { fields = "never" }
"#;
    fs::write(place.path().join("deck.toml"), deck).unwrap();
    succeed(place.path(), "run deck.toml --quiet --out out --force");
}

/// Work and dissipated energy of plastic flow within one load step are both computed with the mean forces, so that the energy
/// balance closes although the work is wrong.
#[test]
fn few_load_steps_with_inelastic_deformation_are_reported() {
    let deck = r#"
body = { shape = "plate", size = [16, 8], spacing = 1, plane = "stress" }
material = { model = "state-based", density = 1, youngs_modulus = 10, poisson_ratio = 0.3, strains = "small", horizon_ratio = 3, yield_stress = 0.02 }
sets = { left = { layer = { side = "-x", cells = 3 } }, right = { layer = { side = "+x", cells = 3 } } }
constraint = [{ set = "left", displacement = [0, 0] }, { set = "right", displacement = [0.1, 0] }]
time = { scheme = "adaptive-dynamic-relaxation" }
output = { fields = "never" }
"#;
    let says = [
        "inelastic deformation",
        "2 static states",
        "time.load_steps",
    ];
    warned_of(deck, &says, "--set time.load_steps=10");
    let elastic = deck.replace("yield_stress = 0.02", "yield_stress = 20");
    let place = tempfile::tempdir().unwrap();
    assert!(warnings(place.path(), &elastic, "").is_empty());
}
