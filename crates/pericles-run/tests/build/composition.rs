//! What works together: every scheme with every operator, boundary, kernel and with breaking. `book/src/composition.md` is the table.
//!
//! A cell that works is run, compared with another route (a fine run of an adaptive scheme on the list of bonds, or a static state), repeated on two, three and seven
//! threads, and stopped and resumed, to the same bits. A cell that does not is refused with its reason.

use pericles::observe::Energies;
use pericles::{Archive, Control, Saved, Simulation};
use pericles_deck::{Deck, DeckError};

/// A plate of a few blocks of points under a load, thrown at one place; free, so that its momentum is that of the load.
const PLATE: &str = r#"body = { shape = "plate", size = [40, 30], spacing = 1, plane = "stress", periodic = PERIODIC }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3, bonds = "OPERATOR" }
initial = [{ velocity = [{ expression = "0.01*exp(-((x-17)^2+(y-14)^2)/40)" }, 0.001] }]
load = [{ set = "all", body_force = [0, 1e-3] }]
time = { end = 4, SCHEME }
"#;

/// The same as a closed surface.
const SURFACE: &str = r#"body = { shape = "icosphere", level = 3, radius = 10 }
material = { density = 1, alpha = 0.25, p = 2, horizon = 3.2 }
initial = [{ velocity = [{ expression = "0.01*exp(-((x-8)^2+(y-4)^2)/40)" }, 0.001, 0] }]
load = [{ set = "all", traction = [0, 1e-3, 0] }]
time = { end = 4, SCHEME }
"#;

/// The plate of a state-based material.
const STATE_BASED: &str = r#"body = { shape = "plate", size = [40, 30], spacing = 1, plane = "stress" }
material = { model = "state-based", strains = "small", density = 1, youngs_modulus = 1, poisson_ratio = 0.2, horizon_ratio = 3 }
initial = [{ velocity = [{ expression = "0.01*exp(-((x-17)^2+(y-14)^2)/40)" }, 0.001] }]
load = [{ set = "all", body_force = [0, 1e-3] }]
time = { end = 4, SCHEME }
"#;

/// A notched plate that is pulled until it tears.
const TORN: &str = r#"body = { shape = "plate", size = [30, 20], spacing = 1, plane = "stress" }
material = { model = "LAW", density = 1, youngs_modulus = 1, horizon_ratio = 3, critical_stretch = 0.004, bonds = "OPERATOR" }
crack = [{ segment = [[0, 10], [12, 10]] }]
sets.top = { layer = { side = "+y", cells = 1 } }
sets.bottom = { layer = { side = "-y", cells = 1 } }
prescribe = [{ set = "top", velocity = ["free", 0.004] }, { set = "bottom", velocity = ["free", -0.004] }]
initial = [{ velocity = [0, { expression = "8e-3*(y/20-0.5)" }] }]
time = { end = 10, SCHEME }
"#;

/// An operator: its word in decks, and the body it is tried on.
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

    /// The scheme and operator that a result is compared with.
    fn reference(self) -> String {
        let scheme = "scheme = \"dormand-prince\", tolerance = 1e-10, dt = 0.5";
        match self {
            Surface | StateBased | Spectral => self.deck(scheme),
            _ => List.deck(scheme),
        }
    }
}

/// A scheme: what a deck says of it, how far it may be from the reference relative to the largest displacement, and its momentum from the impulse.
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

/// Both sides of an interface take the force between them at stages of their own: momentum is kept to the order of the scheme.
const fn two_steps(time: &'static str, error: f64) -> Scheme {
    Scheme {
        time,
        error,
        momentum: error,
    }
}

/// Steps of 0.05 are a twentieth of the stable one; second order leaves some 1e-4 of it.
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
        "scheme = \"rk3-mts\", ratio = 2, fine = [\"part\"], dt = 0.1",
        1e-4,
    ),
    two_steps(
        "scheme = \"rk4-mts\", ratio = 2, fine = [\"part\"], dt = 0.1",
        1e-5,
    ),
    scheme(
        "scheme = \"respa\", ratio = 2, fine = [\"part\"], dt = 0.05",
        1e-3,
    ),
];

/// The part that takes the smaller of two steps.
pub const PART: &str = "sets.part = { where = \"x < 7\" }\n";

fn built(text: &str) -> Result<Simulation, DeckError> {
    Ok(Deck::parse(text, "a.toml", &[])?.build()?.simulation())
}

fn simulation(text: &str) -> Simulation {
    built(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Runs so many steps, or all that are left.
fn advance(run: &mut Simulation, steps: Option<u64>) {
    let last = steps.map(|steps| run.state().step + steps);
    run.run(|run| match last {
        Some(last) if run.state().step >= last => Control::Stop,
        _ => Control::Continue,
    })
    .unwrap();
}

fn stored(run: &Simulation) -> Archive {
    let mut archive = Archive::default();
    run.save(&mut archive);
    archive
}

/// What a finished run leaves.
pub struct Ended {
    pub archive: Archive,
    pub energies: Energies,
    u: Vec<f64>,
    momentum: [f64; 3],
    impulse: [f64; 3],
    pub broken: u64,
    /// What the energy account is off by, over the work done.
    pub off: f64,
    /// The largest force on a point that is not held.
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

/// The finished run of a deck, having seen that other numbers of threads and a stop in its middle lead to the same bits.
pub fn run_every_way(text: &str) -> Ended {
    let on = |threads: usize, work: &(dyn Fn() -> Ended + Sync)| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(work)
    };
    let whole = || {
        let mut run = simulation(text);
        advance(&mut run, None);
        Ended::of(&run)
    };
    let first = on(1, &whole);
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
        let same = on(threads, way).archive == first.archive;
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

/// Runs the schemes on an operator and compares them with the reference.
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
        // The momentum of a free body is the impulse of its load.
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
fn every_scheme_steps_a_list() {
    compare(List, &ONE_STEP);
    compare(List, &TWO_STEPS);
}

#[test]
fn every_scheme_steps_a_grid() {
    compare(Grid, &ONE_STEP);
    compare(Grid, &TWO_STEPS);
}

#[test]
fn schemes_that_bear_rounding_step_a_grid_in_single_precision() {
    let explicit = [
        "scheme = \"velocity-verlet\", dt = 0.05",
        "scheme = \"rk3\", dt = 0.1",
        "scheme = \"rk4\", dt = 0.1",
        "scheme = \"dormand-prince\", tolerance = 1e-5, dt = 0.4",
        "scheme = \"trigonometric\", dt = 0.5",
    ];
    // Forces have six digits; their errors do not cancel as those of doubles do.
    let rounded = explicit.map(|time| Scheme {
        time,
        error: 1e-3,
        momentum: 1e-4,
    });
    compare(FloatGrid, &rounded);
    refusal(
        &FloatGrid.deck("scheme = \"dormand-prince\", tolerance = 1e-6, dt = 0.4"),
        "at least 1e-5",
    );
    refused(FloatGrid, &TWO_STEPS, "parts of the body");
    refused(
        FloatGrid,
        &ONE_STEP[4..10],
        "needs forces in double precision",
    );
    refusal(
        &FloatGrid.deck("scheme = \"relaxation\""),
        "needs forces in double precision",
    );
}

#[test]
fn every_scheme_steps_a_surface() {
    compare(Surface, &ONE_STEP);
    compare(Surface, &TWO_STEPS);
}

#[test]
fn every_scheme_but_respa_steps_a_state_based_body() {
    compare(StateBased, &ONE_STEP);
    compare(StateBased, &TWO_STEPS[..2]);
    refused(
        StateBased,
        &TWO_STEPS[2..],
        "takes the force apart by bonds",
    );
}

#[test]
fn every_scheme_of_one_step_steps_a_convolution() {
    compare(Convolution, &ONE_STEP);
    refused(Convolution, &TWO_STEPS, "parts of the body");
}

#[test]
fn every_scheme_of_one_step_steps_plane_waves() {
    compare(Spectral, &ONE_STEP);
    refused(Spectral, &TWO_STEPS, "parts of the body");
}

fn refused(operator: Operator, schemes: &[Scheme], reason: &str) {
    for scheme in schemes {
        refusal(&(operator.deck(scheme.time) + PART), reason);
    }
}

fn refusal(text: &str, reason: &str) {
    match built(text) {
        Err(error) => assert!(error.to_string().contains(reason), "{error}"),
        Ok(_) => panic!("it is not refused: {reason}\n{text}"),
    }
}

/// Static states of a plate that is pulled, whatever keeps its bonds.
#[test]
fn every_operator_comes_to_rest() {
    let at_rest = |operator: Operator| {
        let text = operator.deck("scheme = \"relaxation\", tolerance = 1e-8");
        let held = "sets.left = { layer = { side = \"-x\", cells = 3 } }\nprescribe = [{ set = \"left\", displacement = [0, 0] }]\n";
        run_every_way(&(text + held)).u
    };
    let list = at_rest(List);
    let size = largest(list.iter().copied());
    for operator in [Grid, Convolution] {
        let error = distance(&at_rest(operator), &list) / size;
        assert!(error < 1e-6, "{}: {error:e}", operator.word());
    }
}

#[test]
fn plane_waves_and_surfaces_come_to_rest() {
    // Held at some points; the forces that are left are small beside the load.
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
    for (operator, set, zero) in bodies {
        let text = operator.deck("scheme = \"relaxation\", tolerance = 1e-8");
        let run = run_every_way(
            &(text + set + &format!("prescribe = [{{ set = \"held\", displacement = {zero} }}]\n")),
        );
        assert!(run.force < 1e-6 * 1e-3, "{:e}", run.force);
    }
}

/// Schemes that follow breaking.
const BREAKING: [&str; 13] = [
    "scheme = \"velocity-verlet\", dt = 0.2",
    "scheme = \"rk3\", dt = 0.2",
    "scheme = \"rk4\", dt = 0.2",
    "scheme = \"dormand-prince\", tolerance = 1e-6, dt = 0.4",
    "scheme = \"rk4-mts\", ratio = 2, adaptive = { every = 4 }, dt = 0.2",
    "scheme = \"rk3-mts\", ratio = 2, adaptive = { every = 4 }, dt = 0.2",
    "scheme = \"respa\", ratio = 2, adaptive = { every = 4 }, dt = 0.2",
    "scheme = \"newmark\", tolerance = 1e-10, dt = 0.2",
    "scheme = \"newmark\", tolerance = 1e-10, solver = \"newton-krylov\", dt = 0.2",
    "scheme = \"discrete-gradient\", dt = 0.2",
    "scheme = \"implicit-midpoint\", dt = 0.2",
    "scheme = \"trapezoidal\", dt = 0.2",
    "scheme = \"trigonometric\", dt = 0.2",
];

#[test]
fn bonds_break_under_every_scheme_that_follows_breaking() {
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
fn what_cannot_break_is_refused_with_its_reason() {
    let torn = |operator: Operator, time: &str| {
        let text = TORN.replace("LAW", "linear").replace("SCHEME", time);
        text.replace("OPERATOR", operator.word())
    };
    let verlet = "scheme = \"velocity-verlet\", dt = 0.2";
    refusal(&torn(Convolution, verlet), "the same bonds at every point");
    let notch = "crack = [{ segment = [[0, 10], [12, 10]] }]\n";
    let whole = |operator| torn(operator, verlet).replace(notch, "");
    refusal(&whole(Convolution), "the same bonds at every point");
    let periodic = |text: String| text.replace("\"stress\"", "\"stress\", periodic = true");
    refusal(&periodic(whole(Spectral)), "the same bonds at every point");
}

/// Influence functions, as decks name them.
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
fn every_kernel_is_the_same_on_every_operator() {
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
fn kernels_with_negative_values_do_not_break() {
    let text = TORN.replace("LAW", "linear").replace("OPERATOR", "list");
    let text = text.replace("SCHEME", "scheme = \"velocity-verlet\", dt = 0.2");
    let signed = "horizon_ratio = 3, influence = { function = \"classes\", table = [[[1, 0], 1], [[1, 1], 1], [[2, 0], -0.1], [[2, 1], 1], [[2, 2], 1], [[3, 0], 1]] }, volume_correction = \"none\"";
    refusal(&text.replace("horizon_ratio = 3", signed), "negative");
}

/// A bar that goes on for ever at both ends.
const ENDLESS: &str = r#"body = { shape = "bar", length = 40, spacing = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3, bonds = "OPERATOR" }
initial = [{ displacement = [{ expression = "0.01*exp(-((x-17)/2)^2)" }] }]
boundary = [{ kind = "absorbing", side = "-x" }, { kind = "absorbing", side = "+x" }]
time = { end = 60, dt = 0.5, SCHEME }
"#;

#[test]
fn exact_ends_are_those_of_a_long_bar_on_every_operator() {
    let verlet = |text: &str| text.replace("SCHEME", "scheme = \"velocity-verlet\"");
    // Nothing comes back from 60 m away in time.
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
fn exact_ends_of_other_schemes_are_refused() {
    for time in [
        "scheme = \"rk4\"",
        "scheme = \"respa\", ratio = 2, fine = [\"all\"]",
        "scheme = \"trigonometric\"",
    ] {
        let text = ENDLESS.replace("OPERATOR", "list").replace("SCHEME", time);
        refusal(&text, "velocity-verlet");
    }
}
