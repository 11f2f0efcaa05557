//! Warnings about static states and their energy balance.

use super::{warned_of, warnings, without_warnings};
use std::fs;

use crate::common::{fail, report, succeed, text};

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

/// A disc compressed between its poles; it splits along the loaded diameter.
const DISC: &str = r#"
body = { shape = "disc", radius = 25, centre = [0, 0], spacing = 4, plane = "stress" }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3, critical_stretch = 5e-4, no_fail = ["top", "bottom"] }
sets.top = { where = "y > 20" }
sets.bottom = { where = "y < -20" }
constraint = [{ set = "top", displacement = ["free", -0.4] }, { set = "bottom", displacement = [0, 0] }]
time = { scheme = "static", load_steps = 30, stop_when = [{ set = "top", reaction_below = 0.3 }] }
output = { fields = "never", history = { every = 1 } }
"#;

#[test]
fn static_states_of_a_splitting_body_are_found_by_damped_dynamics() {
    let place = tempfile::tempdir().unwrap();
    let found = warnings(place.path(), DISC, "");
    let says = "no static path, because the body splits, softens or buckles";
    assert!(
        found.iter().any(|warning| warning.contains(says)),
        "{found:?}"
    );
    let report = report(&place.path().join("out"));
    let reason = report["stop_reason"].as_str().unwrap_or_default();
    assert!(reason.contains("has fallen to"), "{report}");
    // The disc releases elastic energy while it splits.
    let released = report["audit"]["scheme_correction"].as_f64();
    assert!(released.is_none_or(|energy| energy > 0.0), "{released:?}");
    // All states are in equilibrium, and the energy that is released on the way is in the balance.
    let table = std::fs::read_to_string(place.path().join("out/history.csv")).unwrap();
    let mut lines = table
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let names = lines.next().unwrap();
    let column = |name: &str| {
        names
            .iter()
            .position(|found| found.starts_with(name))
            .unwrap()
    };
    let [residual, work, balance] = ["residual", "external_work", "balance"].map(column);
    for row in lines {
        let number = |k: usize| row[k].parse::<f64>().unwrap();
        assert!(number(residual) <= 1e-6, "{row:?}");
        assert!(
            number(balance).abs() <= 1e-4 * number(work).abs(),
            "{row:?}"
        );
    }
}

/// A bar that tears in the second load step, under a load: the results end with its unbalanced state.
#[test]
fn fields_and_pictures_end_with_the_failed_state() {
    let deck = r#"
body = { shape = "bar", length = 40, spacing = 1 }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3, critical_stretch = 7e-4 }
sets.left = { layer = { side = "-x", cells = 3 } }
sets.right = { layer = { side = "+x", cells = 3 } }
constraint = [{ set = "left", displacement = [0] }]
load = [{ set = "right", traction = [1e-3], function = { kind = "ramp", duration = 0.25 } }]
time = { scheme = "adaptive-dynamic-relaxation", tolerance = 1e-6, load_steps = 10, iterations = 3000 }
output = { fields = { every = 1 } }
"#;
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("deck.toml"), deck).unwrap();
    let (status, message) = fail(place.path(), "run deck.toml --out out");
    assert_eq!(status, 4, "{message}");
    assert!(
        message.contains("it is the last state of the field files and pictures"),
        "{message}"
    );
    let folder = place.path().join("out");
    let rows = fs::read_to_string(folder.join("history.csv")).unwrap();
    let last = rows.lines().last().unwrap();
    assert!(last.starts_with("1,"), "the last static state: {last}");
    let series = fs::read_to_string(folder.join("fields.pvd")).unwrap();
    assert_eq!(series.matches("<DataSet").count(), 3, "{series}");
    succeed(place.path(), "plot out --field Damage");
    assert!(folder.join("plots/Damage-000002.png").is_file());
    succeed(place.path(), "report out");
    // The failed state is not part of a resumed run: it fails again, with the same files.
    let files = |name: &str| fs::read(folder.join("fields").join(name)).unwrap();
    let before = ["fields_000001.vtu", "fields_000002.vtu"].map(files);
    let (status, _) = fail(place.path(), "resume out");
    assert_eq!(status, 4);
    assert_eq!(
        before,
        ["fields_000001.vtu", "fields_000002.vtu"].map(files)
    );
    assert_eq!(
        rows,
        fs::read_to_string(folder.join("history.csv")).unwrap()
    );
}
