//! Initial fields, loads and prescribed motions.

use pericles::time::State;

use super::{PLATE, build, rejection};

#[test]
fn conditions_of_a_deck_are_built() {
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
    // A layer has the area of its face for any direction of the load; midway on the ramp.
    close(resultant(1, 0.5e-6), [100.0, -240.0]);
    // Not a layer: the projection of the set along the load, 3 mm × 2 mm.
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
[[constraint]]
set = "left"
velocity = { expression = "x*cos(3*t)" }
until = 0.5
[[constraint]]
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
fn expressions_depend_on_position_and_time() {
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

    // The motion is exact at the end of every step, and the left end is free after its release.
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

/// The displacement is the integral of a velocity that begins and ends with jumps, at a time that depends on the position.
#[test]
fn velocities_may_jump() {
    let burst = "0.1*step(t - 0.2)*step(0.4 + x - t)";
    let deck = EXPRESSIONS
        .replace("x*cos(3*t)", burst)
        .replace("until = 0.5", "");
    let model = build(&deck);
    let (start, mut simulation) = (model.state.u[0], model.simulation());
    simulation
        .run(|simulation| {
            let state = simulation.state();
            let expected = start + 0.1 * (state.t.min(0.45) - 0.2).max(0.0);
            assert!((state.u[0] - expected).abs() < 1e-15, "{}", state.t);
            pericles::Control::Continue
        })
        .unwrap();
}

#[test]
fn invalid_expressions_of_motions_are_rejected() {
    let cases = [
        ("1e-2*x*t^2", "x*floor(t)", "has no derivative in time"),
        (
            "x*cos(3*t)",
            "round(1e9*t)",
            "more than 10000 jumps or kinks within the run",
        ),
        ("1e-3*exp(-(x/0.2)^2)", "sqrt(0.5-x)", "is NaN or infinite"),
        ("x*sin(t)", "1/(t*x)", "is NaN or infinite"),
    ];
    for (right, wrong, says) in cases {
        let error = rejection(&EXPRESSIONS.replace(right, wrong)).to_string();
        assert!(error.contains(says) && error.contains(wrong), "{error}");
    }
    let both = EXPRESSIONS.replace(
        "until = 0.5",
        "function = { kind = \"ramp\", duration = 1 }",
    );
    assert!(
        rejection(&both)
            .to_string()
            .contains("takes no time function")
    );
}

/// A plate whose right face is 40 mm × 2 mm.
const FACES: &str = r#"
[body]
shape = "plate"
size = ["80 mm", "40 mm"]
spacing = "1 mm"
plane = "stress"
thickness = "2 mm"
[material]
density = 2440
youngs_modulus = "72 GPa"
horizon_ratio = 3
[sets]
face = { layer = { side = "+x", cells = 3 } }
box = { box = { min = ["77 mm", 0] } }
both = { where = "x < 0.003 || x > 0.077" }
[[load]]
set = "face"
traction = [0, "1 MPa"]
function = { kind = "ramp", duration = "2 us" }
[time]
end = "4 us"
dt = "0.1 us"
"#;

#[test]
fn areas_and_resultants_of_loads_are_reported_with_warnings() {
    let loaded = |set: &str, traction: &str| {
        let text = FACES
            .replace("set = \"face\"", &format!("set = \"{set}\""))
            .replace("[0, \"1 MPa\"]", traction);
        let model = build(&text);
        let warnings: Vec<String> = model.warnings.iter().map(|w| w.line()).collect();
        (model.loads[0].clone(), warnings)
    };
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    let (face, warnings) = loaded("face", "[0, \"1 MPa\"]");
    close(face.area.unwrap(), 80e-6);
    close(face.force[1], 80.0);
    assert_eq!((face.force[0], face.points), (0.0, 120));
    close(face.at, 2e-6);
    assert!(warnings.is_empty(), "{warnings:?}");
    // The same cells as a box: a shear load acts on the projection along the load.
    let (side, warnings) = loaded("box", "[0, \"1 MPa\"]");
    close(side.force[1], 6.0);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    for part in [
        "deck.toml:18:",
        "6 mm²",
        "80 mm²",
        "normal to x",
        "set `area`",
    ] {
        assert!(warnings[0].contains(part), "{warnings:?}");
    }
    // The area for tension is correct.
    let (_, warnings) = loaded("box", "[\"1 MPa\", 0]");
    assert!(warnings.is_empty(), "{warnings:?}");
    let (union, warnings) = loaded("both", "[\"1 MPa\", 0]");
    close(union.force[0], 80.0);
    assert!(
        warnings.len() == 1 && warnings[0].contains("not a single layer on one face"),
        "{warnings:?}"
    );
    // A given area leads to no warning.
    let text = FACES.replace("set = \"face\"", "set = \"both\"\narea = \"160 mm2\"");
    let model = build(&text);
    close(model.loads[0].force[1], 160.0);
    assert!(model.warnings.is_empty());
}

#[test]
fn a_load_that_becomes_infinite_is_reported_with_its_time() {
    for (replace, by, what) in [
        (
            "kind = \"ramp\", duration = \"2 us\"",
            "kind = \"expression\", expression = \"sqrt(2e-6-t)\"",
            "the load on `face`",
        ),
        (
            "[0, \"1 MPa\"]\nfunction = { kind = \"ramp\", duration = \"2 us\" }",
            "[0, { expression = \"1e6*sqrt(2e-6-t)\" }]",
            "the load on `face`",
        ),
        (
            "[time]",
            "[[constraint]]\nset = \"both\"\nvelocity = [{ expression = \"ln(2e-6-t)\" }, \"free\"]\n[time]",
            "the prescribed motion on `both`",
        ),
    ] {
        let message = rejection(&FACES.replace(replace, by)).to_string();
        assert!(message.contains(what), "{message}");
        assert!(
            message.contains("no finite value at t = 2.00 µs"),
            "{message}"
        );
    }
    // Not at times when it no longer acts.
    let over = FACES.replace(
        "kind = \"ramp\", duration = \"2 us\" }",
        "kind = \"expression\", expression = \"sqrt(2e-6-t)\" }\nuntil = \"2 us\"",
    );
    build(&over);
}

#[test]
fn a_zero_load_on_constrained_points_leads_to_no_warning() {
    let text = FACES.replace(
        "[time]",
        "[[constraint]]\nset = \"face\"\ndisplacement = [0, 0]\n[time]",
    );
    let held = |traction: &str| {
        let model = build(&text.replace("[0, \"1 MPa\"]", traction));
        let lines = model.warnings.iter().map(|warning| warning.line());
        lines
            .filter(|line| line.contains("constrained along it"))
            .count()
    };
    assert_eq!(held("[0, \"1 MPa\"]"), 1);
    assert_eq!(held("[0, 0]"), 0);
}
