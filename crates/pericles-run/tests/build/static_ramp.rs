//! Static runs apply loads and displacements without a time function in equal parts over the load steps.

use pericles::{Control, Simulation};

use super::build;

/// A bar of ten points; ACTION and TIME are placeholders.
const BAR: &str = r#"
body = { shape = "bar", length = 20, spacing = 1, area = 1 }
material = { model = "linear", density = 1, youngs_modulus = 10, horizon_ratio = 3 }
sets = { left = { layer = { side = "-x", cells = 3 } }, right = { layer = { side = "+x", cells = 3 } } }
constraint = [{ set = "left", displacement = [0] }, CONSTRAINT]
load = [LOAD]
time = { end = 2, scheme = "SCHEME", load_steps = 4, tolerance = 1e-10 }
"#;

const PULLED: &str = "{ set = \"right\", displacement = [0.1] FUNCTION }";
const LOADED: &str = "{ set = \"right\", body_force = [0.1] FUNCTION }";

fn deck(scheme: &str, is_load: bool, function: &str) -> String {
    let [constraint, load] = match is_load {
        true => ["", LOADED],
        false => [PULLED, ""],
    };
    BAR.replace("SCHEME", scheme)
        .replace("CONSTRAINT", constraint)
        .replace("LOAD", load)
        .replace("FUNCTION", function)
}

/// Displacement of the last point after each load step, relative to that at the end.
fn parts(mut run: Simulation) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    run.run(|run| {
        found.extend(run.state().u.last());
        Control::Continue
    })
    .unwrap();
    // The last step is not followed by a decision.
    found.extend(run.state().u.last());
    let last: f64 = *found.last().unwrap();
    found.iter().map(|u| u / last).collect()
}

fn assert_parts(deck: &str, expected: [f64; 4]) {
    let found = parts(build(deck).simulation());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-6, "{found:?}\n{deck}");
    }
    assert_eq!(found.len(), 4);
}

const RAMP: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
const CONSTANT: [f64; 4] = [1.0; 4];

#[test]
fn loads_and_displacements_grow_linearly_over_the_load_steps() {
    for scheme in ["static", "adaptive-dynamic-relaxation", "fire"] {
        for is_load in [true, false] {
            assert_parts(&deck(scheme, is_load, ""), RAMP);
        }
    }
}

#[test]
fn a_time_dependence_that_is_given_applies() {
    for is_load in [true, false] {
        let given = |function: &str| deck("static", is_load, function);
        assert_parts(&given(", function = { kind = \"constant\" }"), CONSTANT);
        let early = given(", function = { kind = \"ramp\", duration = 1 }");
        assert_parts(&early, [0.5, 1.0, 1.0, 1.0]);
    }
    let growing = deck("static", false, "").replace("[0.1]", "[{ expression = \"0.1*t^2\" }]");
    assert_parts(&growing, [0.0625, 0.25, 0.5625, 1.0]);
    assert_parts(&deck("static", true, ", from = -1"), CONSTANT);
    // A velocity is a displacement that grows already.
    let moved = deck("static", false, "").replace("displacement = [0.1]", "velocity = [0.1]");
    assert_parts(&moved, RAMP);
    // A body that is displaced at the start is loaded already.
    let displaced = deck("static", false, "").replace(
        "load = []",
        "initial = [{ displacement = [{ expression = \"0.005*x\" }] }]",
    );
    assert_parts(&displaced, CONSTANT);
}

#[test]
fn prescribed_displacements_of_impactors_grow_too() {
    let punch = |function: &str| {
        format!(
            r#"
body = {{ shape = "plate", size = [20, 10], spacing = 1, plane = "strain" }}
material = {{ density = 1, youngs_modulus = 10, horizon_ratio = 3 }}
sets = {{ bottom = {{ layer = {{ side = "-y", cells = 3 }} }} }}
constraint = [{{ set = "bottom", displacement = [0, 0] }}]
impactor = [{{ name = "punch", shape = "half-space", normal = [0, -1], centre = [10, 10], motion = "prescribed", displacement = [0, -0.4] {function} }}]
time = {{ scheme = "static", load_steps = 4 }}
"#
        )
    };
    let energies = |deck: &str| -> Vec<f64> {
        let mut run = build(deck).simulation();
        let mut found = Vec::new();
        run.run(|run| {
            found.push(run.snapshot().energies().elastic);
            Control::Continue
        })
        .unwrap();
        found.push(run.snapshot().energies().elastic);
        found
    };
    let ramp = energies(&punch(", function = { kind = \"ramp\", duration = 1 }"));
    assert_eq!(energies(&punch("")), ramp);
    assert!(ramp[0] < 0.1 * ramp[3]);
    let constant = energies(&punch(", function = { kind = \"constant\" }"));
    assert!((constant[0] / ramp[3] - 1.0).abs() < 1e-3);
}
