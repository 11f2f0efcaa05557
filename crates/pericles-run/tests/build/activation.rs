//! Points that become part of the body during the run.

use pericles::observe::Field;
use pericles::round_trip::check_resume;
use pericles::{Control, Simulation};
use pericles_run::HeatBalance;

use super::{build, rejection, stored, with_threads};

/// Runs a deck to its end.
fn end(deck: &str) -> Simulation {
    let mut run = build(deck).simulation();
    run.run(|_| Control::Continue)
        .unwrap_or_else(|error| panic!("{error}\n{deck}"));
    run
}

/// Materials whose bonds can come into being.
const MODELS: [&str; 3] = [
    "model = \"linear\"",
    "model = \"bond-stretch\"",
    "model = \"bond-stretch\", critical_stretch = 0.2, softening = { law = \"linear\", onset_stretch = 0.05 }",
];

/// A plate of 24 × 8 points whose right half is active from t = 0.5; MODEL and LOADS are placeholders.
const STATIC: &str = r#"
body = { shape = "plate", size = [24, 8], spacing = 1, plane = "strain" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, bonds = "list", MODEL }
sets = { left = { layer = { side = "-x", cells = 3 } }, middle = { where = "x > 9 && x < 12" }, right = { layer = { side = "+x", cells = 3 } }, late = { where = "x > 12" } }
constraint = [{ set = "left", displacement = [0, 0] }]
load = [LOADS]
time = { scheme = "static", end = 1, load_steps = 4, tolerance = 1e-12 }
"#;
const FIRST: &str = r#"{ set = "middle", body_force = [{ expression = "2e-3*(t - (t - 0.5)*step(t - 0.5))" }, { expression = "1e-3*(t - (t - 0.5)*step(t - 0.5))" }] }"#;
const SECOND: &str =
    r#"{ set = "right", body_force = [{ expression = "3e-3*(t - 0.5)*step(t - 0.5)" }, 0] }"#;
const LATE: &str = "activation = [{ set = \"late\", active_from = 0.5 }]\n";

/// The displacement of the whole body after both loads is that of the left half under the first load plus that of the
/// whole body under the second one: the right half is free of stress when it becomes active.
#[test]
fn parts_that_become_active_are_free_of_stress() {
    let deck = |loads: &str| {
        let text = STATIC.replace("MODEL", MODELS[0]);
        text.replace("LOADS", loads)
    };
    let both = end(&format!("{LATE}{}", deck(&[FIRST, SECOND].join(", "))));
    let half = end(&deck(FIRST).replace("[24, 8]", "[12, 8]").replace(
        "late = { where = \"x > 12\" }",
        "late = { where = \"x > 11\" }",
    ));
    let whole = end(&deck(SECOND));
    let [n, held] = [24 * 8, 12 * 8];
    let largest = both
        .state()
        .u
        .iter()
        .fold(0.0f64, |most, u| most.max(u.abs()));
    assert!(largest > 1e-4);
    for c in 0..2 {
        for row in 0..8 {
            for k in 0..12 {
                let [i, j] = [row * 24 + k, row * 12 + k];
                let sum = half.state().u[c * held + j] + whole.state().u[c * n + i];
                let error = both.state().u[c * n + i] - sum;
                assert!(
                    error.abs() < 1e-9 * largest,
                    "{i}: {error:e} of {largest:e}"
                );
            }
        }
    }
    let active = both.snapshot().field(Field::Active).to_vec();
    assert!(active.iter().all(|mark| *mark == 1.0));
}

/// A plate that vibrates and grows from its left edge; MODEL is a placeholder.
const GROWING: &str = r#"
activation = [{ active_from = { expression = "0.4*(x - 6)" } }, { set = "corner", active_from = 2.5 }]
body = { shape = "plate", size = [28, 10], spacing = 1, plane = "strain" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, MODEL }
sets = { corner = { where = "x > 24 && y > 7" }, edge = { layer = { side = "-x", cells = 3 } } }
initial = [{ velocity = [{ expression = "0.01*(x - 3)" }, { expression = "0.02*x" }] }]
time = { end = 12, dt = 0.05 }
output = { fields = { names = ["Active"] } }
"#;

#[test]
fn energy_and_momentum_are_balanced_while_points_become_active() {
    for model in [MODELS[0], MODELS[1]] {
        let mut run = build(&GROWING.replace("MODEL", model)).simulation();
        let counted = |run: &Simulation| {
            let active = run.snapshot().field(Field::Active).to_vec();
            active.iter().sum::<f64>()
        };
        let momentum = |run: &Simulation| -> [f64; 2] {
            let n = run.system().points();
            let v = &run.state().v;
            [0, 1].map(|c| v[c * n..(c + 1) * n].iter().sum())
        };
        let (first, start) = (counted(&run), momentum(&run));
        assert_eq!(first, 60.0);
        let mut scale: f64 = 0.0;
        let mut check = |now: &Simulation| {
            let energies = now.snapshot().energies();
            scale = scale.max(energies.kinetic);
            // The linear force conserves the energy of the scheme to rounding.
            let bound = if model == MODELS[0] { 1e-12 } else { 1e-4 };
            let error = energies.balance() / scale;
            assert!(error.abs() < bound, "{}: {error:e}", now.state().step);
            let impulse = now.system().ledger().impulse;
            for (c, now) in momentum(now).into_iter().enumerate() {
                let error = now - start[c] - impulse[c];
                assert!(error.abs() < 1e-11, "{error:e}");
            }
        };
        run.run(|now| {
            check(now);
            Control::Continue
        })
        .unwrap();
        assert_eq!(counted(&run), 280.0);
        assert!(run.snapshot().energies().work > 0.1 * scale);
        assert!(
            run.snapshot()
                .field(Field::Damage)
                .iter()
                .all(|damage| *damage == 0.0)
        );
    }
}

/// A heavy wall that grows on a fixed floor; MODEL and TIME are placeholders.
const HEAVY: &str = r#"
activation = [{ set = "late", active_from = { expression = "y" } }]
body = { shape = "plate", size = [12, 8], spacing = 1, plane = "strain" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, MODEL }
sets = { late = { where = "y > 2" }, floor = { layer = { side = "-y", cells = 2 } } }
constraint = [{ set = "floor", displacement = [0, 0] }]
load = [{ set = "all", body_force = [0, -1e-3], function = { kind = "constant" } }]
time = { end = 10, TIME }
"#;

/// Loads act on active points only, in the balances of energy and momentum too, and the floor bears the whole wall at the
/// end.
#[test]
fn weight_of_new_points_is_balanced() {
    let deck = |model: &str, time: &str| HEAVY.replace("MODEL", model).replace("TIME", time);
    for model in [MODELS[0], MODELS[1]] {
        let mut run = build(&deck(model, "dt = 0.05")).simulation();
        let (n, mut scale) = (run.system().points(), 0.0f64);
        run.run(|now| {
            let energies = now.snapshot().energies();
            scale = scale.max(energies.elastic);
            let bound = if model == MODELS[0] { 1e-12 } else { 1e-4 };
            let error = energies.balance() / scale.max(1e-9);
            assert!(error.abs() < bound, "{}: {error:e}", now.state().step);
            let momentum: f64 = now.state().v[n..].iter().sum();
            let error = momentum - now.system().ledger().impulse[1];
            assert!(error.abs() < 1e-12, "{error:e}");
            Control::Continue
        })
        .unwrap();
        let run = end(&deck(
            model,
            "scheme = \"static\", load_steps = 20, tolerance = 1e-9",
        ));
        let energies = run.snapshot().energies();
        let bound = if model == MODELS[0] { 1e-6 } else { 1e-2 };
        let error = energies.balance() / energies.elastic;
        assert!(error.abs() < bound, "{error:e} {energies:?}");
        let reaction: f64 = run.snapshot().field(Field::Reaction)[n..].iter().sum();
        assert!((reaction - 96e-3).abs() < 1e-8, "{reaction}");
    }
}

/// A moving body grows without deformation: a new point takes the motion of the body.
#[test]
fn new_points_move_with_the_body() {
    let deck = GROWING.replace("MODEL", MODELS[1]).replace(
        "[{ expression = \"0.01*(x - 3)\" }, { expression = \"0.02*x\" }]",
        "[0.3, -0.1]",
    );
    // Points that become active apart from the body would stay at rest.
    let run = end(&deck.replace("active_from = 2.5", "active_from = 10"));
    let (n, energies) = (run.system().points(), run.snapshot().energies());
    for i in 0..n {
        let v = [run.state().v[i], run.state().v[n + i]];
        assert!(
            (v[0] - 0.3).abs() < 1e-12 && (v[1] + 0.1).abs() < 1e-12,
            "{i}: {v:?}"
        );
    }
    assert!(energies.elastic < 1e-20 * energies.kinetic, "{energies:?}");
}

/// A body that is turned by more than a right angle while it grows: bonds come into being at all angles.
#[test]
fn rotations_do_not_stretch_bonds_that_came_into_being_at_an_angle() {
    let turned = "[{ expression = \"(cos(0.2*t) - 1)*x - sin(0.2*t)*y\" }, { expression = \"sin(0.2*t)*x + (cos(0.2*t) - 1)*y\" }]";
    for model in [MODELS[1], MODELS[2]] {
        let deck = GROWING.replace("MODEL", model);
        let (before, _) = deck.split_once("initial").unwrap();
        let (_, after) = deck.split_once("time").unwrap();
        let deck = format!(
            "{before}constraint = [{{ set = \"all\", displacement = {turned} }}]\ntime{after}"
        );
        let run = end(&deck);
        let energies = run.snapshot().energies();
        assert!(energies.kinetic > 1.0);
        assert!(energies.elastic < 1e-24 * energies.kinetic, "{energies:?}");
    }
}

#[test]
fn resumed_runs_of_growing_bodies_are_bitwise_identical() {
    for model in MODELS {
        let deck = GROWING.replace("MODEL", model);
        check_resume(|| build(&deck).simulation(), [31, 118])
            .unwrap_or_else(|error| panic!("{error}\n{deck}"));
    }
}

/// All schemes converge to the same motion, at least with the second order; points become active at ends of all steps.
#[test]
fn every_scheme_integrates_growing_bodies() {
    for model in [MODELS[0], MODELS[1]] {
        let deck = |scheme: &str, dt: f64| {
            let deck = GROWING.replace("MODEL", model);
            deck.replace("dt = 0.05", &format!("dt = {dt}, scheme = \"{scheme}\""))
        };
        let reference = end(&deck("velocity-verlet", 0.005));
        let size = |u: &[f64]| u.iter().fold(0.0f64, |most, u| most.max(u.abs()));
        let largest = size(&reference.state().u);
        for scheme in [
            "velocity-verlet",
            "rk4",
            "dormand-prince",
            "newmark",
            "discrete-gradient",
            "implicit-midpoint",
            "trapezoidal",
            "trigonometric",
        ] {
            let [coarse, fine] = [0.02, 0.01].map(|dt| {
                let run = end(&deck(scheme, dt));
                let pairs = run.state().u.iter().zip(&reference.state().u);
                size(&pairs.map(|(a, b)| a - b).collect::<Vec<f64>>()) / largest
            });
            // The second bound is that of the reference.
            let converges = fine < coarse / 3.5 && fine < 1e-2 || fine < 1e-4;
            assert!(converges, "{scheme}: {coarse:e}, {fine:e}");
            check_resume(|| build(&deck(scheme, 0.02)).simulation(), [31, 118])
                .unwrap_or_else(|error| panic!("{scheme}: {error}"));
        }
    }
}

#[test]
fn growth_does_not_depend_on_threads() {
    for model in MODELS {
        let deck = GROWING
            .replace("MODEL", model)
            .replace("[28, 10]", "[60, 30]");
        let end = |threads: usize| with_threads(threads, || stored(&end(&deck)));
        assert_eq!(end(1).differences(&end(3)), [""; 0], "{model}");
    }
}

/// A body at rest to which hot layers are added: bonds are free of stress at the temperature at which they come into being,
/// and the layers shrink when they cool.
#[test]
fn hot_layers_are_free_of_stress_when_they_become_active() {
    let text = r#"
activation = [{ set = "late", active_from = 1, temperature = 900 }]
body = { shape = "plate", size = [20, 12], spacing = 1, plane = "strain" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, model = "bond-stretch" }
sets = { late = { where = "y > 6" } }
thermal = { conductivity = 0.5, specific_heat = 0.2, temperature = 300, expansion = 1e-4, reference = 300 }
time = { end = 3, dt = 0.05 }
output = { fields = { names = ["Temperature"] } }
"#;
    let mut run = build(text).simulation();
    let mut most: f64 = 0.0;
    run.run(|now| {
        let energies = now.snapshot().energies();
        if now.state().step <= 20 {
            assert!(energies.elastic < 1e-25, "{energies:?}");
        }
        most = most.max(energies.elastic);
        let balance = HeatBalance::of(now).unwrap();
        let error = balance.balance_relative.unwrap();
        assert!(error.abs() < 1e-12, "{error:e}");
        assert!(
            (energies.balance()).abs() < 1e-4 * most.max(1e-12),
            "{energies:?}"
        );
        Control::Continue
    })
    .unwrap();
    let balance = HeatBalance::of(&run).unwrap();
    // 120 points of volume 1 with ρ c = 0.2, heated by 600 K.
    assert!((balance.from_activation.unwrap() - 120.0 * 0.2 * 600.0).abs() < 1e-9);
    assert!(balance.highest < 900.0 && balance.lowest > 299.0);
    assert!(most > 0.0);
}

/// A strip whose upper half is added at 900 K and cools to 300 K bends like one whose upper half, bonded from the start, is
/// cooled by 600 K.
#[test]
fn a_strip_bends_by_the_shrinkage_of_a_layer_that_was_added_hot() {
    let deck = |temperature: &str| {
        format!(
            r#"
body = {{ shape = "plate", size = [40, 8], spacing = 1, plane = "stress" }}
material = {{ density = 1, youngs_modulus = 10, horizon_ratio = 3, model = "linear", bonds = "list" }}
sets = {{ late = {{ where = "y > 4" }}, middle = {{ where = "abs(x - 20) < 1.1" }} }}
constraint = [{{ set = "middle", displacement = [0, 0] }}]
thermal = {{ expansion = 1e-6, reference = 300, temperature = {{ expression = "{temperature}" }} }}
time = {{ scheme = "static", end = 1, load_steps = 4, tolerance = 1e-10 }}
"#
        )
    };
    let added = deck("300 + 600*step(y - 4)*(1 - 2*(t - 0.5)*step(t - 0.5))");
    let added = end(&format!("{LATE}{added}"));
    let cooled = end(&deck("300 - 600*step(y - 4)*t"));
    let n = added.system().points();
    let [deflection, error] = (0..2 * n).fold([0.0f64; 2], |[most, error], k| {
        let [one, other] = [&added, &cooled].map(|run| run.state().u[k]);
        [most.max(other.abs()), error.max((one - other).abs())]
    });
    // The curvature 1.5 α ΔT/h of two halves of equal stiffness deflects the ends by half its product with the square of
    // half the length.
    let beam = 0.5 * 1.5 * 6e-4 / 8.0 * 400.0;
    assert!((deflection / beam - 1.0).abs() < 0.1, "{deflection} {beam}");
    assert!(error < 2e-3 * deflection, "{error:e} of {deflection:e}");
}

#[test]
fn bodies_that_cannot_grow_are_rejected() {
    let deck = GROWING.replace("MODEL", MODELS[0]);
    for (from, to, says) in [
        (
            "model = \"linear\"",
            "model = \"state-based\", poisson_ratio = 0.3",
            "free of force",
        ),
        (
            "model = \"linear\"",
            "model = \"correspondence\", poisson_ratio = 0.3",
            "free of force",
        ),
        (
            "model = \"linear\"",
            "bonds = \"grid\"",
            "stored with a neighbour list only",
        ),
        (
            "dt = 0.05",
            "dt = 0.05, scheme = \"respa\", ratio = 2, fine = \"corner\"",
            "points become active later",
        ),
        (
            "active_from = 2.5",
            "active_from = 2.5, temperature = 3",
            "heat conduction",
        ),
        (
            "active_from = 2.5",
            "active_from = { expression = \"sqrt(-x)\" }",
            "NaN",
        ),
        (
            "active_from = 2.5",
            "active_from = 2.5, radius = 1",
            "radius",
        ),
        (
            "time =",
            "contact = { distance = 1, stiffness = 1 }\ntime =",
            "contact",
        ),
    ] {
        assert!(deck.contains(from), "{from}");
        let text = deck.replace(from, to);
        let message = match std::panic::catch_unwind(|| rejection(&text).to_string()) {
            Ok(message) => message,
            Err(_) => pericles_deck::Deck::parse(&text, "deck.toml", &[])
                .unwrap_err()
                .to_string(),
        };
        assert!(message.contains(says), "{to}: {message}");
    }
}
