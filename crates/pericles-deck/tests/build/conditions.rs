//! Initial fields, loads and motions.

use pericles::time::State;

use super::{PLATE, build, refusal};

#[test]
fn conditions() {
    let model = build(PLATE);
    let loads = model.system.loads();
    let resultant = |k: usize, t: f64| {
        let force = loads[k].resultant(t, &model.cloud);
        [force[0], force[1]]
    };
    let close = |found: [f64; 2], wanted: [f64; 2]| {
        for c in 0..2 {
            assert!(
                (found[c] - wanted[c]).abs() < 1e-9 * 500.0,
                "{found:?} {wanted:?}"
            );
        }
    };
    // The top face: 20 mm × 2 mm.
    close(resultant(0, 0.0), [0.0, 480.0]);
    // A layer takes its face whatever the direction of the load; half way up the ramp.
    close(resultant(1, 0.5e-6), [100.0, -240.0]);
    // No layer: the side of the set normal to the load, 3 mm × 2 mm.
    close(resultant(2, 0.0), [6.0, 0.0]);
    close(resultant(3, 0.0), [7e3 * 12.0 * 2e-9, 0.0]);

    let motions = model.system.motions();
    assert_eq!(motions[0].name, "left");
    assert_eq!(motions[1].name, "left_2");
    let amplitudes = |k: usize| [0, 1, 2].map(|c| motions[k].amplitude(c));
    assert_eq!(amplitudes(0), [Some(3.0), None, None]);
    assert_eq!(amplitudes(1), [None, Some(0.0), None]);

    // Later initial values replace earlier ones, component-major.
    let State { u, v, .. } = &model.state;
    let n = model.cloud.len();
    for i in 0..n {
        let left = model.cloud.point(i)[0] < 2e-3;
        let expected = if left {
            (0.0, 2.0, 1e-7)
        } else {
            (1.0, 0.0, 0.0)
        };
        assert_eq!((v[i], v[n + i], u[n + i]), expected);
    }

    let middle = model.cloud.point(model.probes[0].points[0] as usize);
    assert!((middle[0] - 12.5e-3).abs() < 1e-9 && (middle[1] - 3.5e-3).abs() < 1e-9);
    assert_eq!(model.probes[1].points.len(), 20);
}

/// A bar of ten cells whose ends are driven and loaded by expressions.
const EXPRESSIONS: &str = r#"
[body]
shape = "bar"
length = 1.0
spacing = 0.1
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
[sets]
left = { layer = { side = "-x", cells = 1 } }
right = { layer = { side = "+x", cells = 3 } }
[[initial]]
displacement = { expression = "1e-3*exp(-(x/0.2)^2)" }
velocity = { expression = "-x^2" }
[[prescribe]]
set = "left"
velocity = { expression = "x*cos(3*t)" }
until = 0.5
[[prescribe]]
set = "right"
displacement = { expression = "1e-2*x*t^2" }
[[load]]
set = "right"
body_force = { expression = "x*sin(t)" }
function = { kind = "table", rows = [[0, 2], [1, 4]] }
from = 0.25
[time]
end = 1.0
dt = 1e-3
"#;

#[test]
fn expressions_become_fields_of_place_and_time() {
    let model = build(EXPRESSIONS);
    for i in 0..10 {
        let x = 0.05 + 0.1 * i as f64;
        assert!((model.state.u[i] - 1e-3 * (-(x / 0.2).powi(2)).exp()).abs() < 1e-15);
        assert!((model.state.v[i] + x * x).abs() < 1e-15);
    }
    let start = model.state.u[0];
    let resultant = |t: f64| model.system.loads()[0].resultant(t, &model.cloud)[0];
    let exact = |t: f64| (0.75 + 0.85 + 0.95) * 0.1 * t.sin() * (2.0 + 2.0 * t);
    assert!((resultant(0.8) - exact(0.8)).abs() < 1e-12);
    assert_eq!(resultant(0.2), 0.0);

    // The motion is exact at the end of every step, and the left end is free once it is released.
    let (dt, mut held, mut simulation) = (model.dt, 0, model.simulation());
    simulation
        .run(|simulation| {
            let state = simulation.state();
            assert!((state.u[9] - 1e-2 * 0.95 * state.t.powi(2)).abs() < 1e-13);
            let expected = start + 0.05 * (3.0 * state.t).sin() / 3.0;
            let follows = (state.u[0] - expected).abs() < 1e-12;
            assert_eq!(follows, state.t <= 0.5 + 1e-9, "{}", state.t);
            held += u64::from(follows);
            pericles::Control::Continue
        })
        .unwrap();
    assert_eq!(held, (0.5 / dt + 1e-9) as u64);
    let energies = simulation.snapshot().energies();
    assert!(
        energies.balance().abs() < 1e-3 * energies.kinetic,
        "{energies:?}"
    );
}

#[test]
fn expressions_that_cannot_move_a_body_are_refused() {
    let cases = [
        ("x*cos(3*t)", "x*floor(t)", "has no derivative in time"),
        ("1e-3*exp(-(x/0.2)^2)", "sqrt(0.5-x)", "has no finite value"),
        ("x*sin(t)", "1/(t*x)", "has no finite value"),
    ];
    for (right, wrong, says) in cases {
        let error = refusal(&EXPRESSIONS.replace(right, wrong)).to_string();
        assert!(error.contains(says) && error.contains(wrong), "{error}");
    }
    let both = EXPRESSIONS.replace(
        "until = 0.5",
        "function = { kind = \"ramp\", duration = 1 }",
    );
    assert!(
        refusal(&both)
            .to_string()
            .contains("takes no function of time")
    );
}
