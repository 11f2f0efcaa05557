//! A force with two passes and a second force in one system, with every scheme.

use std::sync::Arc;

use crate::common::boxed;
use crate::state_based::{Dilatational, Wall};
use pericles::boundary::{Load, TimeFunction};
use pericles::operator::{Force, PointSubset, TwoPassForce};
use pericles::space::PointCloud;
use pericles::time::{
    AdaptiveRungeKutta, DiscreteGradient, Fine, Implicit, ImplicitRule, InnerSolver, Integrator,
    Interpolant, MultiTimeStep, MultiTimeStepOptions, Newmark, NewmarkOptions, Predictor,
    Relaxation, RelaxationOptions, Respa, RungeKutta, State, Tableau, VelocityVerlet,
    frequency_from_below,
};
use pericles::{Archive, Checkpointed, Control, PericlesError, PointScalar, Simulation, System};

const HORIZON: f64 = 2.1;
const END: f64 = 8.0;

/// A block above the wall.
fn block() -> Arc<PointCloud> {
    boxed([0.0, -0.2, 0.0], &[12.0, 6.0], 1.0, 1.0)
}

fn force(cloud: &Arc<PointCloud>) -> Box<dyn Force> {
    let force = Dilatational::whole(cloud, HORIZON);
    Box::new(TwoPassForce::new(cloud.clone(), force))
}

fn free(cloud: &Arc<PointCloud>) -> System {
    System::new(cloud.clone(), force(cloud), PointScalar::Uniform(1.0)).unwrap()
}

fn above_the_wall(cloud: &Arc<PointCloud>) -> System {
    let mut system = free(cloud);
    system.add_force(Box::new(Wall::below(cloud, 2.0))).unwrap();
    system
}

/// Moving downwards, and sheared.
fn thrown(cloud: &PointCloud) -> State {
    let n = cloud.len();
    let mut state = State::at_rest(2 * n);
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        state.v[i] = 0.03 * (0.5 * y).sin();
        state.v[n + i] = -0.2 + 0.02 * (0.4 * x).cos();
    }
    state
}

fn noise(entries: usize, size: f64) -> Vec<f64> {
    (0..entries)
        .map(|k| size * (k as f64 * 1.7 + 0.3).sin())
        .collect()
}

#[test]
fn forces_are_energy_gradients_and_tangents_are_force_derivatives() {
    let cloud = block();
    let system = above_the_wall(&cloud);
    let operator = system.operator();
    let n = cloud.len();
    let (mut u, direction) = (noise(2 * n, 0.05), noise(2 * n, 1.0));
    u[n..].iter_mut().for_each(|u| *u -= 0.6);
    let moved = |h: f64| -> Vec<f64> { u.iter().zip(&direction).map(|(u, d)| u + h * d).collect() };
    let force_at = |u: &[f64]| {
        let mut force = vec![0.0; 2 * n];
        operator.add_force(0.0, u, PointSubset::All, &mut force);
        force
    };
    let force = force_at(&u);
    let power: f64 = force.iter().zip(&direction).map(|(f, d)| f * d).sum();
    let h = 1e-5;
    let slope = (operator.energy(0.0, &moved(h)) - operator.energy(0.0, &moved(-h))) / (2.0 * h);
    assert!(
        (slope + power).abs() < 1e-8 * power.abs(),
        "{slope} {power}"
    );
    let mut tangent = vec![f64::NAN; 2 * n];
    operator.tangent_into(0.0, &u, &direction, &mut tangent);
    let (up, down) = (force_at(&moved(h)), force_at(&moved(-h)));
    for k in 0..2 * n {
        let slope = (up[k] - down[k]) / (2.0 * h);
        assert!(
            (slope - tangent[k]).abs() < 1e-8,
            "{k}: {slope} {}",
            tangent[k]
        );
    }
    // The energies of the forces add up, and none is zero.
    let parts: Vec<f64> = system.forces().map(|force| force.energy(0.0, &u)).collect();
    assert!(parts.len() == 2 && parts.iter().all(|energy| *energy > 0.0));
    assert_eq!(operator.energy(0.0, &u), parts[0] + parts[1]);
    let mut density = vec![0.0; n];
    operator.add_energy_density(0.0, &u, &mut density);
    let total: f64 = density.iter().sum();
    assert!((total / (parts[0] + parts[1]) - 1.0).abs() < 1e-13);
}

#[test]
fn the_force_on_a_point_does_not_depend_on_the_subset() {
    let cloud = block();
    let system = above_the_wall(&cloud);
    let operator = system.operator();
    let n = cloud.len();
    let u = noise(2 * n, 0.3);
    let mut whole = vec![0.0; 2 * n];
    operator.add_force(0.0, &u, PointSubset::All, &mut whole);
    let odd: Vec<u32> = (0..n as u32).filter(|i| i % 3 == 1).collect();
    for on in [PointSubset::Set(&odd), PointSubset::Range(17..31)] {
        let mut part = vec![0.0; 2 * n];
        // Values of a previous evaluation must not be used.
        operator.add_force(
            0.0,
            &noise(2 * n, 0.1),
            PointSubset::All,
            &mut vec![0.0; 2 * n],
        );
        operator.add_force(0.0, &u, on.clone(), &mut part);
        let is_wanted = |i: usize| match &on {
            PointSubset::Set(set) => set.contains(&(i as u32)),
            PointSubset::Range(range) => range.contains(&i),
            PointSubset::All => true,
        };
        for k in 0..2 * n {
            let expected = if is_wanted(k % n) { whole[k] } else { 0.0 };
            assert_eq!(part[k].to_bits(), expected.to_bits(), "{k}");
        }
    }
}

#[test]
fn the_frequency_bound_is_an_upper_bound() {
    let cloud = block();
    let rest = vec![0.0; 2 * cloud.len()];
    for system in [free(&cloud), above_the_wall(&cloud)] {
        let bound = system.operator().frequency_bound(&|_| 1.0);
        let found = frequency_from_below(&system, &rest, 60);
        assert!(found <= bound && found > 0.3 * bound, "{found} {bound}");
    }
}

fn newmark(solver: InnerSolver, system: &System) -> Box<dyn Integrator> {
    let options = NewmarkOptions {
        tolerance: 1e-12,
        solver,
        ..NewmarkOptions::default()
    };
    Box::new(Newmark::new(options, system).unwrap())
}

fn two_steps(tableau: &Tableau, system: &System) -> Box<dyn Integrator> {
    let left: Vec<u32> = (0..system.points() as u32)
        .filter(|&i| system.cloud().point(i as usize)[0] < 5.0)
        .collect();
    let options = MultiTimeStepOptions {
        ratio: 2,
        fine: Fine::Fixed(vec![left]),
        predictor: Predictor::Structured,
        interpolant: Interpolant::Hermite,
    };
    Box::new(MultiTimeStep::new(tableau, options, system).unwrap())
}

type Make = fn(&System) -> Box<dyn Integrator>;

/// Schemes with their step, the allowed errors of state and energy at the end, and whether they conserve momentum
/// to rounding.
const SCHEMES: [(&str, Make, f64, f64, f64, bool); 10] = [
    (
        "velocity Verlet",
        |_| Box::new(VelocityVerlet),
        0.02,
        2e-3,
        1e-4,
        true,
    ),
    (
        "rk3",
        |system| Box::new(RungeKutta::new(&Tableau::rk3(0.75).unwrap(), system)),
        0.05,
        1e-3,
        1e-4,
        true,
    ),
    (
        "rk4",
        |system| Box::new(RungeKutta::new(&Tableau::rk4(), system)),
        0.05,
        1e-4,
        1e-5,
        true,
    ),
    (
        "multirate-rk3",
        |system| two_steps(&Tableau::rk3(0.75).unwrap(), system),
        0.05,
        1e-3,
        1e-4,
        false,
    ),
    (
        "multirate-rk4",
        |system| two_steps(&Tableau::rk4(), system),
        0.05,
        1e-4,
        1e-5,
        false,
    ),
    (
        "newmark",
        |system| newmark(InnerSolver::FixedPoint, system),
        0.02,
        2e-3,
        1e-4,
        true,
    ),
    (
        "newmark, Anderson",
        |system| newmark(InnerSolver::Anderson { depth: 4 }, system),
        0.02,
        2e-3,
        1e-4,
        true,
    ),
    (
        "newmark, Newton",
        |system| newmark(InnerSolver::NewtonKrylov, system),
        0.02,
        2e-3,
        1e-4,
        true,
    ),
    (
        "discrete gradient",
        |system| Box::new(DiscreteGradient::new(1e-10, system).unwrap()),
        0.02,
        2e-3,
        1e-9,
        true,
    ),
    (
        "implicit midpoint",
        |system| Box::new(Implicit::new(ImplicitRule::Midpoint, system).unwrap()),
        0.02,
        2e-3,
        1e-4,
        true,
    ),
];

fn run(system: System, make: Make, dt: f64) -> Simulation {
    let state = thrown(system.cloud());
    let steps = (END / dt).round() as u64;
    let scheme = make(&system);
    let mut run = Simulation::new(system, scheme, state, dt, steps).unwrap();
    run.run(|_| Control::Continue).unwrap();
    run
}

fn reference(system: &System) -> Box<dyn Integrator> {
    Box::new(AdaptiveRungeKutta::new(1e-10, system).unwrap())
}

#[test]
fn every_scheme_integrates_a_two_pass_force_and_a_second_force() {
    let cloud = block();
    let n = cloud.len();
    for (walled, system) in [(true, above_the_wall as fn(&_) -> System), (false, free)] {
        let exact = run(system(&cloud), reference, 0.5);
        let size = exact
            .state()
            .u
            .iter()
            .fold(0.0_f64, |most, u| most.max(u.abs()));
        // The block hits the wall and does not pass through it.
        assert!(!walled || exact.system().momentum(&exact.state().v)[1] > 0.0);
        let started = exact.system().momentum(&thrown(&cloud).v);
        for (name, make, dt, error, loss, keeps) in SCHEMES {
            let run = run(system(&cloud), make, dt);
            let pairs = run.state().u.iter().zip(&exact.state().u);
            let found = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / size;
            assert!(found < error, "{name}, wall {walled}: error {found:e}");
            let energies = run.snapshot().energies();
            let lost = energies.balance().abs() / energies.initial;
            assert!(lost < loss, "{name}, wall {walled}: energy {lost:e}");
            let ended = run.system().momentum(&run.state().v);
            // The wall exerts vertical forces only.
            for c in 0..if walled { 1 } else { 2 } {
                let limit = if keeps { 1e-11 } else { error };
                let off = (ended[c] - started[c]).abs() / n as f64;
                assert!(
                    off < limit * 0.2,
                    "{name}, wall {walled}: momentum {c} off by {off:e}"
                );
            }
        }
    }
}

#[test]
fn resumed_run_with_two_forces_is_bitwise_identical() {
    let cloud = block();
    let whole = run(above_the_wall(&cloud), |_| Box::new(VelocityVerlet), 0.02);
    let new = || {
        let steps = (END / 0.02).round() as u64;
        let system = above_the_wall(&cloud);
        Simulation::new(
            system,
            Box::new(VelocityVerlet),
            thrown(&cloud),
            0.02,
            steps,
        )
        .unwrap()
    };
    let mut first = new();
    let stop = |run: &Simulation| match run.state().step {
        150 => Control::Stop,
        _ => Control::Continue,
    };
    first.run(stop).unwrap();
    let mut archive = Archive::default();
    first.save(&mut archive);
    let mut second = new();
    second.restore(&archive).unwrap();
    second.run(|_| Control::Continue).unwrap();
    assert_eq!(second.state(), whole.state());
    assert_eq!(second.system().ledger(), whole.system().ledger());
}

#[test]
fn block_under_its_weight_is_in_equilibrium_on_the_wall() {
    let cloud = block();
    let mut system = above_the_wall(&cloud);
    let all: Vec<u32> = (0..cloud.len() as u32).collect();
    let ramp = TimeFunction::Ramp {
        start: 0.0,
        duration: 1.0,
    };
    let weight = 2e-3;
    system
        .add_load(Load::new(all, [0.0, -weight, 0.0], ramp))
        .unwrap();
    let options = RelaxationOptions {
        tolerance: 1e-9,
        ..RelaxationOptions::default()
    };
    let scheme = Box::new(Relaxation::new(options, &system).unwrap());
    let mut state = State::at_rest(2 * cloud.len());
    // Its lowest points touch the wall.
    state.u[cloud.len()..].fill(-0.3);
    let mut run = Simulation::new(system, scheme, state, 0.5, 2).unwrap();
    run.run(|_| Control::Continue).unwrap();
    let wall = run.system().forces().nth(1).unwrap();
    let mut push = vec![0.0; 2 * cloud.len()];
    wall.add_force(1.0, &run.state().u, PointSubset::All, &mut push);
    let total: f64 = push[cloud.len()..].iter().sum();
    let expected = weight * cloud.len() as f64;
    assert!((total / expected - 1.0).abs() < 1e-7, "{total} {expected}");
    let energies = run.snapshot().energies();
    // Forces are linear up to strains of about 1e-3, over which loads do the work of their means.
    assert!(energies.balance().abs() < 5e-3 * energies.work.abs());
}

#[test]
fn unsupported_combinations_with_two_passes_are_errors() {
    let cloud = block();
    let system = free(&cloud);
    let left: Vec<u32> = (0..cloud.len() as u32)
        .filter(|&i| cloud.point(i as usize)[0] < 6.0)
        .collect();
    let rejected = Respa::new(2, Fine::Fixed(vec![left]), &system)
        .err()
        .unwrap();
    assert!(
        rejected.to_string().contains("splits the force by bonds"),
        "{rejected}"
    );
    let other = boxed([0.0; 3], &[3.0, 3.0], 1.0, 1.0);
    let mut system = free(&cloud);
    let rejected = system.add_force(force(&other)).unwrap_err();
    assert!(matches!(
        rejected,
        PericlesError::ForceOfAnotherBody { points: 9, .. }
    ));
}
