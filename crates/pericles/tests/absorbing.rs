//! Absorbing ends: the truncated body moves as the infinite one.

use std::f64::consts::PI;
use std::sync::Arc;

use pericles::boundary::absorbing::history::{BlockedHistory, DirectHistory, History};
use pericles::boundary::absorbing::{
    AbsorbingEnd, AbsorbingError, ExponentialKernels, GhostKernels, LatticeStencil, OuterLayer,
    Side, contour_kernels, factor_kernels, green_functions, green_functions_closed,
    semi_discrete_kernels,
};
use pericles::boundary::{Load, TimeFunction};
use pericles::family::{BondList, VolumeCorrection};
use pericles::material::LinearBond;
use pericles::operator::{BondForce, Breaking, DamageMeasure};
use pericles::space::{Grid, Shape};
use pericles::time::{State, VelocityVerlet};
use pericles::{
    Archive, Control, PericlesError, PointScalar, Saved, Simulation, SimulationError, System,
};

const DX: f64 = 0.1;

/// The Gaussian micromodulus of the paper, E = ρ = 1, δ = 0.25, cut after 7 nodes.
fn gaussian(xi: f64) -> f64 {
    const DELTA: f64 = 0.25;
    4.0 / (DELTA.powi(3) * PI.sqrt()) * (-(xi / DELTA).powi(2)).exp()
}

const REACH: usize = 7;

fn weights() -> Vec<f64> {
    (1..=REACH).map(|k| gaussian(k as f64 * DX) * DX).collect()
}

/// A bar of nodes −half … half, x = 0 in the middle, whose inner part |x| < 4 is softer by β.
fn bar(half: usize, beta: f64) -> System {
    let nodes = 2 * half + 1;
    let cloud = Grid {
        shape: Shape::Box {
            origin: [-(half as f64 + 0.5) * DX, 0.0, 0.0],
            size: vec![nodes as f64 * DX],
        },
        spacing: DX,
        section: 1.0,
        holes: vec![],
    };
    let cloud = Arc::new(cloud.points().unwrap());
    let bonds = BondList::new(&cloud, (REACH as f64 + 0.5) * DX, VolumeCorrection::None).unwrap();
    let x = cloud.axis(0).to_vec();
    let hard = |i: usize| x[i].abs() > 4.0 - 1e-9;
    let breaking = Breaking {
        critical_stretch: f64::INFINITY,
        no_fail: &[],
    };
    let force = BondForce::<LinearBond, 1>::with_pair_stiffness(
        cloud.clone(),
        bonds,
        |i, j, xi| {
            let share = if hard(i) && hard(j) { 1.0 } else { beta };
            share * gaussian(xi[0].abs()) * xi[0].abs()
        },
        breaking,
        DamageMeasure::default(),
    );
    System::new(cloud, Box::new(force), PointScalar::Uniform(1.0)).unwrap()
}

fn pulse(system: &System, centre: f64) -> State {
    let mut state = State::at_rest(system.points());
    for (u, x) in state.u.iter_mut().zip(system.cloud().axis(0)) {
        *u = (-(x - centre).powi(2)).exp();
    }
    state
}

fn blocked(kernels: GhostKernels) -> Box<dyn History> {
    Box::new(BlockedHistory::new(kernels))
}

fn add_ends(
    system: &mut System,
    state: &State,
    sides: &[Side],
    dt: f64,
    steps: u64,
    history: fn(GhostKernels) -> Box<dyn History>,
) {
    for &side in sides {
        let layer = OuterLayer::of(system, side, state, &[]).unwrap();
        let h = factor_kernels(&layer.stencil, dt, steps as usize);
        let end = AbsorbingEnd::new(layer, history(GhostKernels::shift(h)), dt).unwrap();
        system.add_boundary(Box::new(end));
    }
}

const BOTH: [Side; 2] = [Side::Left, Side::Right];

fn run(system: System, state: State, dt: f64, steps: u64) -> Simulation {
    let mut simulation = Simulation::new(system, Box::new(VelocityVerlet), state, dt, steps);
    simulation.run(|_| Control::Continue).unwrap();
    simulation
}

/// The largest difference of displacement and velocity between the middle of a large body and a truncated one.
fn difference(large: &State, small: &State) -> f64 {
    let margin = (large.u.len() - small.u.len()) / 2;
    let fields = [(&large.u, &small.u), (&large.v, &small.v)];
    fields
        .iter()
        .flat_map(|(a, b)| a[margin..].iter().zip(*b))
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

#[test]
fn the_truncated_bar_equals_the_large_one() {
    for (dt, steps, beta) in [
        (0.01, 4000, 1.0),
        (0.1, 700, 0.5),
        (0.2, 400, 0.1),
        (0.249, 300, 1.0),
    ] {
        let half = 100;
        // Nothing is faster than ten nodes per unit of time; beyond the front fields decay within some tens of nodes.
        let margin = (5.0 * dt * steps as f64) as usize + 120;
        let large = bar(half + margin, beta);
        let state = pulse(&large, 2.0);
        let large = run(large, state, dt, steps);
        let mut small = bar(half, beta);
        // The pulse at x = 2 is 1e-28 at the ends.
        let state = pulse(&small, 2.0);
        add_ends(&mut small, &state, &BOTH, dt, steps, blocked);
        let small = run(small, state, dt, steps);
        let error = difference(large.state(), small.state());
        assert!(error < 1e-12, "dt = {dt}, beta = {beta}: {error:e}");
        // The account closes: what left is the work of the ends.
        let energies = small.snapshot().energies();
        let balance = energies.balance().abs() / energies.initial;
        assert!(balance < 1e-12, "{balance:e}");
        assert!(energies.work < 0.0);
    }
}

#[test]
fn one_free_end_doubles_and_reflects() {
    let (dt, steps, half) = (0.1, 300, 100);
    let right = |margin: usize| {
        // The right end is free in both; the left one is absorbing, or far away.
        let nodes = 2 * half + 1 + margin;
        let cloud = Grid {
            shape: Shape::Box {
                origin: [-((half + margin) as f64 + 0.5) * DX, 0.0, 0.0],
                size: vec![nodes as f64 * DX],
            },
            spacing: DX,
            section: 1.0,
            holes: vec![],
        };
        let cloud = Arc::new(cloud.points().unwrap());
        let bonds = BondList::new(&cloud, 0.75, VolumeCorrection::None).unwrap();
        let breaking = Breaking {
            critical_stretch: f64::INFINITY,
            no_fail: &[],
        };
        let force = BondForce::<LinearBond, 1>::with_stiffness(
            cloud.clone(),
            bonds,
            |xi| gaussian(xi[0].abs()) * xi[0].abs(),
            breaking,
            DamageMeasure::default(),
        );
        let mut system = System::new(cloud, Box::new(force), PointScalar::Uniform(1.0)).unwrap();
        // A push in the middle instead of an initial field.
        system.add_load(Load::new(
            vec![(half + margin) as u32],
            [3.0, 0.0, 0.0],
            TimeFunction::Pulse {
                start: 0.0,
                duration: 5.0,
            },
        ));
        system
    };
    let large = right(1700);
    let state = State::at_rest(large.points());
    let large = run(large, state, dt, steps);
    let mut small = right(0);
    let state = State::at_rest(small.points());
    add_ends(&mut small, &state, &[Side::Left], dt, steps, blocked);
    let small = run(small, state, dt, steps);
    let error = large.state().u[1700..]
        .iter()
        .zip(&small.state().u)
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max);
    assert!(error < 1e-12, "{error:e}");
    let energies = small.snapshot().energies();
    assert!(energies.balance().abs() < 1e-12 * small.system().ledger().exchanged);
}

#[test]
fn stop_and_resume_gives_the_same_bits() {
    let (dt, steps) = (0.1, 333);
    let make = || {
        let mut system = bar(60, 0.5);
        let state = pulse(&system, 0.0);
        add_ends(&mut system, &state, &BOTH, dt, steps, blocked);
        Simulation::new(system, Box::new(VelocityVerlet), state, dt, steps)
    };
    let mut whole = make();
    whole.run(|_| Control::Continue).unwrap();
    let mut first = make();
    first
        .run(|s| match s.state().step {
            150 => Control::Stop,
            _ => Control::Continue,
        })
        .unwrap();
    let mut archive = Archive::default();
    first.save(&mut archive);
    let mut second = make();
    second.restore(&archive).unwrap();
    second.run(|_| Control::Continue).unwrap();
    assert_eq!(whole.state(), second.state());
    let (mut all, mut part) = (Archive::default(), Archive::default());
    whole.save(&mut all);
    second.save(&mut part);
    assert_eq!(all, part);
}

#[test]
fn kernels_have_their_closed_forms() {
    let steps = 3000;
    // The harmonic chain at dt = 2/ω: the pulse moves by one site per two steps; h is the arrival of 2 J₂-like waves. At the limit dt ω = 2 the chain is
    // exact d'Alembert motion: u_0^{j+1} = u_1^j.
    let chain = LatticeStencil::new(&[1.0]).unwrap();
    let h = factor_kernels(&chain, 1.0, steps);
    assert!((h[0][1] - 1.0).abs() < 1e-15);
    assert!(h[0][2..].iter().all(|x| x.abs() < 1e-15));
    // Σ_j h_m[j] is the factor at zero frequency: 1 − Σ h_m = 0, a rigid motion is passed on.
    let bar = LatticeStencil::new(&weights()).unwrap();
    let h = factor_kernels(&bar, 0.05, 1 << 14);
    let sum: f64 = h.iter().flatten().sum();
    assert!(
        (sum - 1.0).abs() < 1e-2 && (sum - 1.0).abs() > 1e-6,
        "{sum}"
    );
    // The first coefficients are the bonds themselves.
    for (k, a) in weights().iter().enumerate() {
        assert_eq!((h[k][0], h[k][1]), (0.0, 0.05 * 0.05 * a));
    }
}

#[test]
fn histories_agree() {
    let stencil = LatticeStencil::new(&[4.0, -1.0]).unwrap();
    let steps = 1500;
    let kernels = GhostKernels::shift(factor_kernels(&stencil, 0.3, steps));
    let mut histories: [Box<dyn History>; 3] = [
        Box::new(DirectHistory::new(kernels.expanded())),
        Box::new(DirectHistory::new(kernels.clone())),
        Box::new(BlockedHistory::new(kernels)),
    ];
    let mut ghosts = [[0.0; 2]; 3];
    for j in 0..steps {
        let own = [(0.7 * j as f64).sin(), (0.1 * (j * j) as f64).cos()];
        for (history, ghosts) in histories.iter_mut().zip(&mut ghosts) {
            history.ghosts_into(ghosts);
            history.push(&own, ghosts);
        }
        for other in &ghosts[1..] {
            for (a, b) in ghosts[0].iter().zip(other) {
                assert!((a - b).abs() < 1e-13, "{j}: {ghosts:?}");
            }
        }
    }
}

#[test]
fn what_cannot_be_continued_is_refused() {
    use AbsorbingError as E;
    assert_eq!(LatticeStencil::new(&[]), Err(E::EmptyStencil));
    assert_eq!(
        LatticeStencil::new(&[1.0, 0.0]),
        Err(E::OutermostWeightZero { reach: 2 })
    );
    assert!(matches!(
        LatticeStencil::new(&[1.0, -2.0]),
        Err(E::UnstableStencil { .. })
    ));
    let stencil = LatticeStencil::new(&weights()).unwrap();
    assert!(stencil.check_step(0.2499).is_ok());
    assert!(
        matches!(stencil.check_step(0.251), Err(E::UnstableStep { limit, .. }) if (limit - 0.25).abs() < 1e-5)
    );

    let layer = |system: &System, state: &State| OuterLayer::of(system, Side::Right, state, &[]);
    // The soft part reaches the layer: the first wrong bond is named.
    let soft = bar(43, 0.5);
    let rest = State::at_rest(soft.points());
    let error = layer(&soft, &rest).unwrap_err();
    assert!(
        matches!(error, E::LayerBond { side: "+x", found, expected, needed: 7, .. } if (found / expected - 0.5).abs() < 1e-9),
        "{error}"
    );
    let plain = bar(60, 1.0);
    let near = pulse(&plain, 2.0);
    assert!(matches!(
        layer(&plain, &near),
        Err(E::NotAtRest { point: 120, .. })
    ));
    let mut loaded = bar(60, 1.0);
    loaded.add_load(Load::new(
        vec![3, 118],
        [1.0, 0.0, 0.0],
        TimeFunction::Constant,
    ));
    let rest = State::at_rest(loaded.points());
    assert!(matches!(
        layer(&loaded, &rest),
        Err(E::LayerActedOn { point: 118, .. })
    ));
    // More steps than the kernels have.
    let mut short = bar(60, 1.0);
    add_ends(&mut short, &rest, &BOTH, 0.1, 50, blocked);
    let mut run = Simulation::new(short, Box::new(VelocityVerlet), rest, 0.1, 51);
    assert!(matches!(
        run.run(|_| Control::Continue),
        Err(SimulationError::Step(PericlesError::Absorbing(
            E::TooManySteps {
                steps: 51,
                made_for: 50
            }
        )))
    ));
}

#[test]
fn routes_to_the_kernels_agree() {
    for (weights, dt) in [(weights(), 0.05), (vec![4.0, -1.0], 0.03), (vec![1.0], 0.9)] {
        let stencil = LatticeStencil::new(&weights).unwrap();
        let steps = 300;
        let series = factor_kernels(&stencil, dt, steps);
        let contour = contour_kernels(&stencil, dt, steps);
        for (a, b) in series.iter().flatten().zip(contour.iter().flatten()) {
            assert!((a - b).abs() < 1e-14, "{a:e} {b:e}");
        }
        // The semi-discrete kernels are those of the scheme to second order: equal in the limit, per step.
        let fine = semi_discrete_kernels(&stencil, dt, steps);
        let exact = GhostKernels::shift(series).expanded();
        let sum = |series: &[Vec<f64>]| -> f64 { series.iter().flatten().sum() };
        let (a, b) = (sum(fine.series()), sum(exact.series()));
        assert!((a / b - 1.0).abs() < 0.05, "{a} {b}");
    }
}

#[test]
fn green_functions_obey_their_identity() {
    // Σ k a_k (g_{m+k} − g_{m−k}) = −(2m/t) g_m', the derivative by central differences.
    let stencil = LatticeStencil::new(&weights()).unwrap();
    let (dt, steps) = (1e-3, 4000);
    let g = green_functions(&stencil, dt, steps, 2 * REACH + 2);
    let at = |m: isize, j: usize| g[m.unsigned_abs()][j];
    let t = steps as f64 / 2.0 * dt;
    let j = steps / 2;
    for m in 1..REACH as isize {
        let left: f64 = (1..=REACH as isize)
            .map(|k| k as f64 * weights()[k as usize - 1] * (at(m + k, j) - at(m - k, j)))
            .sum();
        let slope =
            (8.0 * (at(m, j + 1) - at(m, j - 1)) - (at(m, j + 2) - at(m, j - 2))) / (12.0 * dt);
        let right = -2.0 * m as f64 / t * slope;
        assert!((left - right).abs() < 1e-8, "{m}: {left} {right}");
    }
    // The paper's closure is exact, and its errors grow: quiet at t = 4 still.
    let closed = green_functions_closed(&stencil, dt, steps);
    for (a, b) in g.iter().zip(&closed) {
        assert!((a[steps] - b[steps]).abs() < 1e-9);
    }
}

#[test]
fn sums_of_exponentials_hold_their_tolerance() {
    let stencil = LatticeStencil::new(&weights()).unwrap();
    let (dt, steps) = (0.05, 1000);
    let exact = GhostKernels::shift(factor_kernels(&stencil, dt, steps)).expanded();
    for tolerance in [1e-6, 1e-9] {
        let fit = ExponentialKernels::fit(&stencil, dt, steps, tolerance).unwrap();
        assert!(fit.residual <= tolerance);
        let largest = fit
            .series(steps)
            .iter()
            .flatten()
            .zip(exact.series().iter().flatten())
            .fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs()));
        assert!(largest < tolerance, "{largest:e}");
    }
    assert!(matches!(
        ExponentialKernels::fit(&stencil, dt, steps, 0.0),
        Err(AbsorbingError::Tolerance { .. })
    ));
}
