//! Combinations of every scheme with every force kernel, boundary, influence function and with breaking bonds; the
//! table is `book/src/composition.md`.
//!
//! A compatible combination is run, compared with another method (a fine run of an adaptive scheme with a neighbour
//! list, or a static state), repeated with two, three and seven threads, and stopped and resumed, with bitwise
//! identical results. An incompatible one is rejected with a reason.

use pericles::observe::Energies;
use pericles::{Archive, Checkpointed, Control, Simulation};
use pericles_deck::{Deck, DeckError};

use super::{stored, with_threads};

/// A small free plate under a load with an initial velocity at one place; its momentum is the impulse of the load.
const PLATE: &str = r#"body = { shape = "plate", size = [40, 30], spacing = 1, plane = "stress", periodic = PERIODIC }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3, bonds = "OPERATOR" }
initial = [{ velocity = [{ expression = "0.01*exp(-((x-17)^2+(y-14)^2)/40)" }, 0.001] }]
load = [{ set = "all", body_force = [0, 1e-3] }]
time = { end = 4, SCHEME }
"#;

/// The same load on a closed surface.
const SURFACE: &str = r#"body = { shape = "icosphere", level = 3, radius = 10 }
material = { density = 1, alpha = 0.25, p = 2, horizon = 3.2 }
initial = [{ velocity = [{ expression = "0.01*exp(-((x-8)^2+(y-4)^2)/40)" }, 0.001, 0] }]
load = [{ set = "all", traction = [0, 1e-3, 0] }]
time = { end = 4, SCHEME }
"#;

/// The plate with a state-based material.
const STATE_BASED: &str = r#"body = { shape = "plate", size = [40, 30], spacing = 1, plane = "stress" }
material = { model = "state-based", strains = "small", density = 1, youngs_modulus = 1, poisson_ratio = 0.2, horizon_ratio = 3 }
initial = [{ velocity = [{ expression = "0.01*exp(-((x-17)^2+(y-14)^2)/40)" }, 0.001] }]
load = [{ set = "all", body_force = [0, 1e-3] }]
time = { end = 4, SCHEME }
"#;

/// A notched plate in tension that fractures.
const TORN: &str = r#"body = { shape = "plate", size = [30, 20], spacing = 1, plane = "stress" }
material = { model = "LAW", density = 1, youngs_modulus = 1, horizon_ratio = 3, critical_stretch = 0.004, bonds = "OPERATOR" }
crack = [{ segment = [[0, 10], [12, 10]] }]
sets.top = { layer = { side = "+y", cells = 1 } }
sets.bottom = { layer = { side = "-y", cells = 1 } }
constraint = [{ set = "top", velocity = ["free", 0.004] }, { set = "bottom", velocity = ["free", -0.004] }]
initial = [{ velocity = [0, { expression = "8e-3*(y/20-0.5)" }] }]
time = { end = 10, SCHEME }
"#;

/// A force kernel: its word in decks, and the body of its tests.
#[derive(Clone, Copy, PartialEq)]
pub enum Operator {
    List,
    Grid,
    FloatGrid,
    Surface,
    StateBased,
    Convolution,
    Spectral,
}

use super::common::Build;
use Operator::{Convolution, FloatGrid, Grid, List, Spectral, StateBased, Surface};

impl Operator {
    pub const ALL: [Self; 7] = [
        List,
        Grid,
        FloatGrid,
        Surface,
        StateBased,
        Convolution,
        Spectral,
    ];

    pub fn word(self) -> &'static str {
        match self {
            List => "list",
            Grid => "grid",
            FloatGrid => "grid-f32",
            Convolution => "convolution",
            Spectral => "spectral",
            Surface => "surface",
            StateBased => "state-based",
        }
    }

    pub fn deck(self, scheme: &str) -> String {
        let text = match self {
            Surface => SURFACE,
            StateBased => STATE_BASED,
            _ => PLATE,
        };
        let periodic = if self == Spectral { "true" } else { "false" };
        text.replace("PERIODIC", periodic)
            .replace("OPERATOR", self.word())
            .replace("SCHEME", scheme)
    }

    /// The scheme and force kernel of the reference.
    fn reference(self) -> String {
        let scheme = "scheme = \"dormand-prince\", tolerance = 1e-10, dt = 0.5";
        match self {
            Surface | StateBased | Spectral => self.deck(scheme),
            _ => List.deck(scheme),
        }
    }
}

/// A scheme: its keys, the tolerance relative to the largest displacement, and the tolerance of the momentum.
pub struct Scheme {
    pub time: &'static str,
    error: f64,
    momentum: f64,
}

const fn scheme(time: &'static str, error: f64) -> Scheme {
    Scheme {
        time,
        error,
        momentum: 1e-9,
    }
}

/// Both sides of a multirate interface evaluate the force at their own stages: momentum is conserved to the order of
/// the scheme.
const fn two_steps(time: &'static str, error: f64) -> Scheme {
    Scheme {
        time,
        error,
        momentum: error,
    }
}

/// Steps of 0.05 are a twentieth of the stable one; errors of second order are about 1e-4.
pub const ONE_STEP: [Scheme; 11] = [
    scheme("scheme = \"velocity-verlet\", dt = 0.05", 1e-3),
    scheme("scheme = \"rk3\", dt = 0.1", 1e-4),
    scheme("scheme = \"rk4\", dt = 0.1", 1e-5),
    scheme(
        "scheme = \"dormand-prince\", tolerance = 1e-8, dt = 0.4",
        1e-5,
    ),
    scheme("scheme = \"newmark\", tolerance = 1e-12, dt = 0.05", 1e-3),
    scheme(
        "scheme = \"newmark\", tolerance = 1e-12, solver = \"anderson\", dt = 0.05",
        1e-3,
    ),
    scheme(
        "scheme = \"newmark\", tolerance = 1e-12, solver = \"newton-krylov\", dt = 0.05",
        1e-3,
    ),
    scheme("scheme = \"discrete-gradient\", dt = 0.05", 1e-3),
    scheme("scheme = \"implicit-midpoint\", dt = 0.05", 1e-3),
    scheme("scheme = \"trapezoidal\", dt = 0.05", 1e-3),
    scheme("scheme = \"trigonometric\", dt = 0.5", 1e-6),
];

pub const TWO_STEPS: [Scheme; 3] = [
    two_steps(
        "scheme = \"multirate-rk3\", ratio = 2, fine = [\"part\"], dt = 0.1",
        1e-4,
    ),
    two_steps(
        "scheme = \"multirate-rk4\", ratio = 2, fine = [\"part\"], dt = 0.1",
        1e-5,
    ),
    scheme(
        "scheme = \"respa\", ratio = 2, fine = [\"part\"], dt = 0.05",
        1e-3,
    ),
];

/// The fine part of multirate schemes.
pub const PART: &str = "sets.part = { where = \"x < 7\" }\n";

fn built(text: &str) -> Result<Simulation, DeckError> {
    Ok(Deck::parse(text, "a.toml", &[])?.build()?.simulation())
}

fn simulation(text: &str) -> Simulation {
    built(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Runs a number of steps, or all remaining ones.
fn advance(run: &mut Simulation, steps: Option<u64>) {
    let last = steps.map(|steps| run.state().step + steps);
    run.run(|run| match last {
        Some(last) if run.state().step >= last => Control::Stop,
        _ => Control::Continue,
    })
    .unwrap();
}

/// Results of a finished run.
pub struct Ended {
    pub archive: Archive,
    pub energies: Energies,
    u: Vec<f64>,
    momentum: [f64; 3],
    impulse: [f64; 3],
    pub broken: u64,
    /// Error of the energy balance, relative to the work done.
    pub off: f64,
    /// Largest force on an unconstrained point.
    force: f64,
    steps: u64,
}

impl Ended {
    fn of(run: &Simulation) -> Self {
        let (system, state) = (run.system(), run.state());
        let energies = run.snapshot().energies();
        let mut force = vec![0.0; state.u.len()];
        system.force_density_into(state.t, &state.u, &mut force);
        system.hold(&mut force);
        Self {
            archive: stored(run),
            energies,
            u: state.u.clone(),
            momentum: system.momentum(&state.v),
            impulse: system.ledger().impulse,
            broken: system.operator().broken_bonds(),
            off: energies.balance() / energies.work,
            force: largest(force),
            steps: run.steps(),
        }
    }
}

/// Runs a deck, and checks that other numbers of threads and a stop give bitwise identical results.
pub fn run_every_way(text: &str) -> Ended {
    let whole = || {
        let mut run = simulation(text);
        advance(&mut run, None);
        Ended::of(&run)
    };
    let first = with_threads(1, whole);
    let half = (first.steps / 2).max(1);
    let resumed = || {
        let mut begun = simulation(text);
        advance(&mut begun, Some(half));
        let archive = stored(&begun);
        let mut run = simulation(text);
        run.restore(&archive).unwrap();
        advance(&mut run, None);
        Ended::of(&run)
    };
    let ways: [(usize, &(dyn Fn() -> Ended + Sync)); 4] =
        [(2, &whole), (3, &whole), (7, &whole), (2, &resumed)];
    for (threads, way) in ways {
        let same = with_threads(threads, way).archive == first.archive;
        assert!(same, "{threads} threads\n{text}");
    }
    first
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values
        .into_iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()))
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    largest(a.iter().zip(b).map(|(a, b)| a - b))
}

/// Runs the schemes with a force kernel and compares them with the reference.
fn compare(operator: Operator, schemes: &[Scheme]) {
    let mut reference = simulation(&operator.reference());
    advance(&mut reference, None);
    let exact = &reference.state().u;
    let size = largest(exact.iter().copied());
    for scheme in schemes {
        let run = run_every_way(&(operator.deck(scheme.time) + PART));
        let error = distance(&run.u, exact) / size;
        assert!(
            error < scheme.error,
            "{} with {}: {error:e}",
            operator.word(),
            scheme.time
        );
        // The momentum of a free body equals the impulse of its load.
        let start = simulation(&(operator.deck(scheme.time) + PART));
        let before = start.system().momentum(&start.state().v);
        for c in 0..3 {
            let off = run.momentum[c] - before[c] - run.impulse[c];
            let small = scheme.momentum * run.momentum[1].abs();
            assert!(off.abs() < small, "{}: {off:e}", scheme.time);
        }
    }
}

#[test]
fn every_scheme_works_with_a_neighbour_list() {
    compare(List, &ONE_STEP);
    compare(List, &TWO_STEPS);
}

#[test]
fn every_scheme_works_with_a_stencil() {
    compare(Grid, &ONE_STEP);
    compare(Grid, &TWO_STEPS);
}

#[test]
fn schemes_that_tolerate_rounding_work_with_single_precision() {
    let explicit = [
        "scheme = \"velocity-verlet\", dt = 0.05",
        "scheme = \"rk3\", dt = 0.1",
        "scheme = \"rk4\", dt = 0.1",
        "scheme = \"dormand-prince\", tolerance = 1e-5, dt = 0.4",
        "scheme = \"trigonometric\", dt = 0.5",
    ];
    // Forces have six digits; their errors do not cancel.
    let rounded = explicit.map(|time| Scheme {
        time,
        error: 1e-3,
        momentum: 1e-4,
    });
    compare(FloatGrid, &rounded);
    rejection(
        &FloatGrid.deck("scheme = \"dormand-prince\", tolerance = 1e-6, dt = 0.4"),
        "at least 1e-5",
    );
    rejected(FloatGrid, &TWO_STEPS, "parts of the body");
    rejected(
        FloatGrid,
        &ONE_STEP[4..10],
        "needs forces in double precision",
    );
    rejection(
        &FloatGrid.deck("scheme = \"adaptive-dynamic-relaxation\""),
        "needs forces in double precision",
    );
}

#[test]
fn every_scheme_works_with_a_surface() {
    compare(Surface, &ONE_STEP);
    compare(Surface, &TWO_STEPS);
}

#[test]
fn every_scheme_except_respa_works_with_a_state_based_body() {
    compare(StateBased, &ONE_STEP);
    compare(StateBased, &TWO_STEPS[..2]);
    rejected(StateBased, &TWO_STEPS[2..], "splits the force by bonds");
}

#[test]
fn every_single_rate_scheme_works_with_a_convolution() {
    compare(Convolution, &ONE_STEP);
    rejected(Convolution, &TWO_STEPS, "parts of the body");
}

#[test]
fn every_single_rate_scheme_works_with_plane_waves() {
    compare(Spectral, &ONE_STEP);
    rejected(Spectral, &TWO_STEPS, "parts of the body");
}

fn rejected(operator: Operator, schemes: &[Scheme], reason: &str) {
    for scheme in schemes {
        rejection(&(operator.deck(scheme.time) + PART), reason);
    }
}

fn rejection(text: &str, reason: &str) {
    match built(text) {
        Err(error) => assert!(error.to_string().contains(reason), "{error}"),
        Ok(_) => panic!("not rejected: {reason}\n{text}"),
    }
}

const STATICS: [&str; 3] = ["adaptive-dynamic-relaxation", "fire", "static"];

/// Static states of a plate in tension, with all force kernels.
#[test]
fn every_force_kernel_reaches_a_static_state() {
    for scheme in STATICS {
        let at_rest = |operator: Operator| {
            let text = operator.deck(&format!("scheme = \"{scheme}\", tolerance = 1e-8"));
            let held = "sets.left = { layer = { side = \"-x\", cells = 3 } }\nconstraint = [{ set = \"left\", displacement = [0, 0] }]\n";
            run_every_way(&(text + held)).u
        };
        let list = at_rest(List);
        let size = largest(list.iter().copied());
        for operator in [Grid, Convolution] {
            let error = distance(&at_rest(operator), &list) / size;
            assert!(error < 1e-6, "{scheme}, {}: {error:e}", operator.word());
        }
    }
}

#[test]
fn plane_waves_and_surfaces_reach_a_static_state() {
    // Constrained at some points; the residual is small relative to the load.
    let bodies = [
        (
            Spectral,
            "sets.held = { ball = { centre = [20, 15], radius = 3 } }\n",
            "[0, 0]",
        ),
        (
            Surface,
            "sets.held = { half_space = { point = [0, 0, -8], normal = [0, 0, 1] } }\n",
            "[0, 0, 0]",
        ),
    ];
    for scheme in STATICS {
        for (operator, set, zero) in bodies {
            let text = operator.deck(&format!("scheme = \"{scheme}\", tolerance = 1e-8"));
            let run = run_every_way(
                &(text
                    + set
                    + &format!("constraint = [{{ set = \"held\", displacement = {zero} }}]\n")),
            );
            assert!(run.force < 1e-6 * 1e-3, "{scheme}: {:e}", run.force);
        }
    }
}

/// Schemes compatible with breaking bonds.
const BREAKING: [&str; 13] = [
    "scheme = \"velocity-verlet\", dt = 0.2",
    "scheme = \"rk3\", dt = 0.2",
    "scheme = \"rk4\", dt = 0.2",
    "scheme = \"dormand-prince\", tolerance = 1e-6, dt = 0.4",
    "scheme = \"multirate-rk4\", ratio = 2, adaptive = { every = 4 }, dt = 0.2",
    "scheme = \"multirate-rk3\", ratio = 2, adaptive = { every = 4 }, dt = 0.2",
    "scheme = \"respa\", ratio = 2, adaptive = { every = 4 }, dt = 0.2",
    "scheme = \"newmark\", tolerance = 1e-10, dt = 0.2",
    "scheme = \"newmark\", tolerance = 1e-10, solver = \"newton-krylov\", dt = 0.2",
    "scheme = \"discrete-gradient\", dt = 0.2",
    "scheme = \"implicit-midpoint\", dt = 0.2",
    "scheme = \"trapezoidal\", dt = 0.2",
    "scheme = \"trigonometric\", dt = 0.2",
];

#[test]
fn bonds_break_with_every_compatible_scheme() {
    for time in BREAKING {
        let torn = |operator: Operator| {
            let text = TORN.replace("LAW", "bond-stretch");
            let text = text.replace("OPERATOR", operator.word());
            run_every_way(&text.replace("SCHEME", time))
        };
        let (list, grid) = (torn(List), torn(Grid));
        assert!(list.broken > 20, "{time}: {}", list.broken);
        assert_eq!(list.broken, grid.broken, "{time}");
        for run in [&list, &grid] {
            assert!(run.off.abs() < 0.05, "{time}: {:e}", run.off);
        }
    }
}

#[test]
fn breaking_with_incompatible_kernels_is_rejected_with_a_reason() {
    let torn = |operator: Operator, time: &str| {
        let text = TORN.replace("LAW", "linear").replace("SCHEME", time);
        text.replace("OPERATOR", operator.word())
    };
    let verlet = "scheme = \"velocity-verlet\", dt = 0.2";
    rejection(&torn(Convolution, verlet), "the same bonds at every point");
    let notch = "crack = [{ segment = [[0, 10], [12, 10]] }]\n";
    let whole = |operator| torn(operator, verlet).replace(notch, "");
    rejection(&whole(Convolution), "the same bonds at every point");
    let periodic = |text: String| text.replace("\"stress\"", "\"stress\", periodic = true");
    rejection(&periodic(whole(Spectral)), "the same bonds at every point");
}

/// Influence functions, by their words in decks.
const INFLUENCES: [&str; 9] = [
    "{ function = \"constant\" }",
    "{ function = \"conical\" }",
    "{ function = \"inverse\" }",
    "{ function = \"power\", exponent = 0.5 }",
    "{ function = \"gaussian\", length = 1.5 }",
    "{ function = \"gaussian\", length = 1.5, acts_on = \"displacement\" }",
    "{ function = \"tabulated\", table = [[1, 1], [2, 0.6], [3, 0.1]] }",
    "{ function = \"cosines\", coefficients = [1, 0.3], wavenumber = 0.7 }",
    "{ function = \"tuned\" }",
];

#[test]
fn every_influence_function_gives_the_same_result_with_every_force_kernel() {
    for influence in INFLUENCES {
        let force = |operator: Operator| {
            let text = operator.deck("scheme = \"velocity-verlet\", dt = 0.05");
            let kernel = format!("horizon_ratio = 3, influence = {influence}");
            let run = simulation(&text.replace("horizon_ratio = 3", &kernel));
            let n = run.system().points() * 2;
            let u: Vec<f64> = (0..n).map(|k| ((k * k) as f64).sin()).collect();
            let mut force = vec![0.0; n];
            run.system().force_density_into(0.0, &u, &mut force);
            force
        };
        let list = force(List);
        let size = largest(list.iter().copied());
        for operator in [Grid, Convolution] {
            let error = distance(&force(operator), &list) / size;
            assert!(
                error < 1e-12,
                "{influence} on {}: {error:e}",
                operator.word()
            );
        }
    }
}

#[test]
fn influence_functions_with_negative_values_do_not_allow_breaking() {
    let text = TORN.replace("LAW", "linear").replace("OPERATOR", "list");
    let text = text.replace("SCHEME", "scheme = \"velocity-verlet\", dt = 0.2");
    let signed = "horizon_ratio = 3, influence = { function = \"lattice-classes\", table = [[[1, 0], 1], [[1, 1], 1], [[2, 0], -0.1], [[2, 1], 1], [[2, 2], 1], [[3, 0], 1]] }, volume_correction = \"none\"";
    rejection(&text.replace("horizon_ratio = 3", signed), "negative");
}

/// An infinite bar.
const ENDLESS: &str = r#"body = { shape = "bar", length = 40, spacing = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3, bonds = "OPERATOR" }
initial = [{ displacement = [{ expression = "0.01*exp(-((x-17)/2)^2)" }] }]
boundary = [{ kind = "absorbing", side = "-x" }, { kind = "absorbing", side = "+x" }]
time = { end = 60, dt = 0.5, SCHEME }
"#;

#[test]
fn absorbing_boundaries_reproduce_a_long_bar_with_every_force_kernel() {
    let verlet = |text: &str| text.replace("SCHEME", "scheme = \"velocity-verlet\"");
    // Reflections from 60 m away do not return in time.
    let long = ENDLESS.replace("length = 40", "length = 160, origin = -60");
    let long: String = long
        .lines()
        .filter(|line| !line.starts_with("boundary"))
        .flat_map(|line| [line, "\n"])
        .collect();
    let mut long = simulation(&verlet(&long.replace("OPERATOR", "list")));
    advance(&mut long, None);
    let exact = &long.state().u[60..100];
    for operator in [List, Grid, Convolution] {
        let run = run_every_way(&verlet(&ENDLESS.replace("OPERATOR", operator.word())));
        let error = distance(&run.u, exact);
        assert!(error < 1e-13, "{}: {error:e}", operator.word());
    }
}

#[test]
fn absorbing_boundaries_with_incompatible_schemes_are_rejected() {
    for time in [
        "scheme = \"rk4\"",
        "scheme = \"respa\", ratio = 2, fine = [\"all\"]",
        "scheme = \"trigonometric\"",
    ] {
        let text = ENDLESS.replace("OPERATOR", "list").replace("SCHEME", time);
        rejection(&text, "velocity-verlet");
    }
}
