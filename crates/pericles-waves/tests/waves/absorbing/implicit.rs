//! Absorbing boundaries of implicit schemes.

use pericles::cache::NoCache;
use pericles::round_trip::check_resume;
use pericles::time::{
    DiscreteGradient, Implicit, ImplicitRule, LinearSolver, State, VelocityVerlet,
};
use pericles::{Control, PericlesError, Simulation, SimulationError, System};
use pericles_waves::absorbing::history::{BlockedHistory, DirectHistory, History, HistoryForm};
use pericles_waves::absorbing::{
    AbsorbingBoundaryPlan, AbsorbingError, GhostKernels, KernelMethod, LatticeStencil, LatticeStep,
    MidpointEnd, OuterLayer, contour_kernels,
};

use crate::absorbing::bar::{BOTH, bar, breaking_bar, difference, pulse, weights};

fn add_ends(system: &mut System, state: &State, dt: f64, steps: u64, form: HistoryForm) {
    for side in BOTH {
        let no_fail: Vec<u32> = (0..system.points() as u32).collect();
        let layer = OuterLayer::of(system, side, state, &no_fail).unwrap();
        let plan = AbsorbingBoundaryPlan {
            form: Some(form),
            tolerance: Some(1e-10),
            ..AbsorbingBoundaryPlan::default()
        };
        let step = LatticeStep::midpoint(dt);
        let made = plan.history(&layer.stencil, step, steps as usize, &NoCache);
        let end = MidpointEnd::new(layer, made.unwrap().0, dt).unwrap();
        system.add_boundary(Box::new(end));
    }
}

fn implicit(
    system: System,
    state: State,
    [dt, steps]: [f64; 2],
    rule: ImplicitRule,
    solver: LinearSolver,
) -> Simulation {
    let scheme = Implicit::with_solver(rule, solver, &system).unwrap();
    let mut simulation =
        Simulation::new(system, Box::new(scheme), state, dt, steps as u64).unwrap();
    simulation.run(|_| Control::Continue).unwrap();
    simulation
}

/// Difference between a truncated body and one that is large enough, and the relative energy imbalance.
fn error(
    make: fn(usize) -> System,
    [dt, steps]: [f64; 2],
    rule: ImplicitRule,
    solver: LinearSolver,
) -> [f64; 2] {
    // An implicit step has unlimited range; it decays as exp(−2 n/(10 dt)), more slowly than waves travel.
    let margin = (5.0 * dt * steps + 150.0 * dt.max(1.0)) as usize + 200;
    let large = make(100 + margin);
    let state = pulse(&large, 2.0);
    let large = implicit(large, state, [dt, steps], rule, solver);
    let mut small = make(100);
    let state = pulse(&small, 2.0);
    add_ends(&mut small, &state, dt, steps as u64, HistoryForm::Blocked);
    let small = implicit(small, state, [dt, steps], rule, solver);
    let energies = small.snapshot().energies();
    assert!(energies.work < 0.0, "waves leave");
    [
        difference(large.state(), small.state()),
        energies.balance().abs() / energies.initial,
    ]
}

/// For linear forces the discrete gradient scheme equals the midpoint rule, for which its boundaries are made.
#[test]
fn discrete_gradient_scheme_uses_the_boundaries_of_the_midpoint_rule() {
    let (dt, steps) = (0.5, 120);
    let run = |system: System, state: State| {
        let scheme = DiscreteGradient::new(1e-13, &system).unwrap();
        let mut run = Simulation::new(system, Box::new(scheme), state, dt, steps).unwrap();
        run.run(|_| Control::Continue).unwrap();
        run
    };
    let large = bar(700, 0.5);
    let state = pulse(&large, 2.0);
    let large = run(large, state);
    let mut small = bar(100, 0.5);
    let state = pulse(&small, 2.0);
    add_ends(&mut small, &state, dt, steps, HistoryForm::Blocked);
    let small = run(small, state);
    let error = difference(large.state(), small.state());
    assert!(error < 1e-10, "{error:e}");
    let energies = small.snapshot().energies();
    assert!(energies.work < 0.0, "waves leave");
    let off = energies.balance().abs() / energies.initial;
    assert!(off < 1e-10, "{off:e}");
}

#[test]
fn truncated_bar_equals_the_large_bar_at_any_time_step() {
    use LinearSolver::{ConjugateGradients, Direct};
    type Make = fn(usize) -> System;
    let soft: Make = |half| bar(half, 0.5);
    let hard: Make = |half| bar(half, 1.0);
    for (make, dt, steps, rule, solver) in [
        (hard, 0.05, 400.0, ImplicitRule::Midpoint, Direct),
        (soft, 0.5, 120.0, ImplicitRule::Midpoint, Direct),
        (soft, 2.0, 40.0, ImplicitRule::Midpoint, ConjugateGradients),
        (soft, 0.5, 120.0, ImplicitRule::Trapezoidal, Direct),
    ] {
        let [error, balance] = error(make, [dt, steps], rule, solver);
        assert!(error < 1e-12, "dt = {dt}, {rule:?}: {error:e}");
        assert!(balance < 1e-11, "dt = {dt}, {rule:?}: {balance:e}");
    }
}

#[test]
fn truncated_bar_with_interior_breaking_equals_the_large_bar() {
    for rule in [ImplicitRule::Midpoint, ImplicitRule::Trapezoidal] {
        let [error, _] = error(breaking_bar, [0.2, 150.0], rule, LinearSolver::Fastest);
        assert!(error < 1e-12, "{rule:?}: {error:e}");
    }
}

#[test]
fn resumed_run_is_bit_for_bit_equal() {
    let (dt, steps) = (0.4, 200);
    for form in [HistoryForm::Blocked, HistoryForm::Exponentials] {
        let make = || {
            let mut system = bar(60, 0.5);
            let state = pulse(&system, 0.0);
            add_ends(&mut system, &state, dt, steps, form);
            let scheme = Implicit::new(ImplicitRule::Midpoint, &system).unwrap();
            Simulation::new(system, Box::new(scheme), state, dt, steps).unwrap()
        };
        check_resume(make, [90]).unwrap();
    }
}

#[test]
fn midpoint_kernels_agree_in_all_forms() {
    let stencil = LatticeStencil::new(&weights()).unwrap();
    let (dt, steps) = (0.5, 600);
    let step = LatticeStep::midpoint(dt);
    let kernels = GhostKernels::shift(contour_kernels(&stencil, step, steps));
    // The sum Σ_j of all kernels (zero frequency) transmits a rigid motion.
    let sum: f64 = kernels.series().iter().flatten().sum();
    assert!((sum - 1.0).abs() < 0.05, "{sum}");
    // Instantaneous part: the dependence of the ghosts on the current step is not small.
    assert!(kernels.series().iter().any(|h| h[0].abs() > 0.1));
    let full = kernels.expanded();
    let mut histories: [Box<dyn History>; 3] = [
        Box::new(DirectHistory::new(full)),
        Box::new(DirectHistory::new(kernels.clone())),
        Box::new(BlockedHistory::new(kernels)),
    ];
    for j in 0..steps {
        let own: Vec<f64> = (0..7)
            .map(|m| ((0.3 + 0.1 * m as f64) * j as f64).sin())
            .collect();
        let mut ghosts = [[0.0; 7]; 3];
        for (history, ghosts) in histories.iter_mut().zip(&mut ghosts) {
            history.ghosts_into(ghosts);
            history.settle(&own, ghosts);
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
fn mismatched_schemes_and_boundaries_are_errors() {
    let stencil = LatticeStencil::new(&weights()).unwrap();
    let step = LatticeStep::midpoint(0.5);
    assert!(step.check(&stencil).is_ok());
    assert!(LatticeStep::midpoint(0.0).check(&stencil).is_err());
    let paper = AbsorbingBoundaryPlan {
        method: KernelMethod::SemiDiscrete,
        ..AbsorbingBoundaryPlan::default()
    };
    let rejected = paper.history(&stencil, step, 10, &NoCache).err();
    let what = "semi-discrete";
    assert_eq!(rejected, Some(AbsorbingError::VerletOnly { what }));
    // Boundaries of one scheme in a run of the other.
    let mut system = bar(60, 1.0);
    let rest = State::at_rest(system.points());
    add_ends(&mut system, &rest, 0.1, 10, HistoryForm::Direct);
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), rest.clone(), 0.1, 10).unwrap();
    assert!(matches!(
        run.run(|_| Control::Continue),
        Err(SimulationError::Misfit(
            PericlesError::BoundaryScheme { .. }
        ))
    ));
    let mut system = bar(60, 1.0);
    crate::absorbing::bar::add_ends(
        &mut system,
        &rest,
        &BOTH,
        0.1,
        10,
        crate::absorbing::bar::blocked,
    );
    assert!(matches!(
        Implicit::new(ImplicitRule::Midpoint, &system),
        Err(PericlesError::SchemeNotUsable { .. })
    ));
}
