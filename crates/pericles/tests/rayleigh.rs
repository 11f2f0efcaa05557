//! Rayleigh damping.

use pericles::boundary::{PrescribedMotion, RayleighDamping, RayleighRates, TimeFunction};
use pericles::domain::Domain;
use pericles::material::{BondMaterial, ElasticModulus, PairLaw};
use pericles::prelude::*;
use pericles::round_trip::check_resume;
use pericles::time::{RungeKutta, Tableau};
use pericles::{Control, StepKind};

/// A damped vibration of a periodic bar of 32 cells with two waves along it.
fn bar(rates: RayleighRates, stages: bool, dt: f64, end: f64) -> Simulation {
    let grid = Grid::bar(32.0, 1.0, 1.0);
    let cloud = std::sync::Arc::new(grid.points().unwrap().with_periodic_faces().unwrap());
    let mut material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0);
    material.law = PairLaw::Linear;
    let mut system = Body::new(cloud.clone(), material).build().unwrap();
    let kind = match stages {
        true => StepKind::Stages,
        false => StepKind::EndOfStep,
    };
    let damping = RayleighDamping::new(rates, kind, system.masses(), system.domain()).unwrap();
    system.add_boundary(Box::new(damping));
    let mut start = State::of(&system);
    for i in 0..system.points() {
        start.v[i] = (2.0 * 2.0 * std::f64::consts::PI * cloud.point(i)[0] / 32.0).sin();
    }
    let scheme: Box<dyn Integrator> = match stages {
        true => Box::new(RungeKutta::new(&Tableau::rk4(), &system)),
        false => Box::new(VelocityVerlet),
    };
    let steps = (end / dt).round() as u64;
    Simulation::new(system, scheme, start, dt, steps).unwrap()
}

fn cases() -> [(RayleighRates, bool); 4] {
    let rates = |mass, stiffness| RayleighRates { mass, stiffness };
    [
        (rates(0.05, 0.0), false),
        (rates(0.05, 0.0), true),
        (rates(0.0, 0.2), false),
        (rates(0.02, 0.1), false),
    ]
}

/// ω² of the vibration, from the force of the undamped bar.
fn square(run: &Simulation) -> f64 {
    let system = run.system();
    let v = &run.state().v;
    let mut product = vec![0.0; v.len()];
    system.vibration_into(&run.state().u, v, &mut product);
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    dot(v, &product) / dot(v, v)
}

/// The amplitude of a vibration of angular frequency ω decays as exp(−½ (α + β ω²) t), and its phase advances with
/// √(ω² − ¼ (α + β ω²)²).
#[test]
fn vibrations_decay_at_the_rate_of_their_frequency() {
    for (rates, stages) in cases() {
        let omega2 = square(&bar(rates, stages, 0.01, 20.0));
        let rate = rates.at(omega2.sqrt());
        let damped = (omega2 - 0.25 * rate * rate).sqrt();
        let errors = [0.04, 0.02].map(|dt| {
            let mut run = bar(rates, stages, dt, 20.0);
            let first = run.state().v[1];
            run.run(|_| Control::Continue).unwrap();
            let t: f64 = 20.0;
            let expected = first / damped * (damped * t).sin() * (-0.5 * rate * t).exp();
            (run.state().u[1] - expected).abs() / first
        });
        let order = (errors[0] / errors[1]).log2();
        println!("{rates:?}: {errors:?}");
        // Velocity Verlet damps the velocity of half a step before: first order in damping times step.
        let (bound, least) = if stages { (1e-6, 3.5) } else { (1e-2, 0.9) };
        assert!(errors[1] < bound && order > least, "{rates:?}: {errors:?}");
    }
}

#[test]
fn the_energy_balance_includes_the_damping() {
    for (rates, stages) in cases() {
        let mut run = bar(rates, stages, 0.05, 20.0);
        run.run(|_| Control::Continue).unwrap();
        let energies = run.snapshot().energies();
        assert!(energies.work < -0.3 * energies.initial, "{energies:?}");
        let bound = if stages { 1e-7 } else { 1e-12 };
        let error = energies.balance().abs() / energies.initial;
        assert!(error < bound, "{rates:?}: {error:e}");
    }
}

#[test]
fn resumed_damped_runs_are_bitwise_identical() {
    for (rates, stages) in cases() {
        let make = || bar(rates, stages, 0.05, 5.0);
        check_resume(make, [37]).unwrap_or_else(|error| panic!("{rates:?}: {error}"));
    }
}

/// A plate with a prescribed motion whose bonds break: only free points are damped, and the balance closes.
#[test]
fn constrained_points_are_not_damped() {
    let cloud = std::sync::Arc::new(Grid::plate([16.0, 6.0], 1.0, 1.0).points().unwrap());
    let left = cloud.select(&Region::layer("-x", 2.0).unwrap());
    let right = cloud.select(&Region::layer("+x", 2.0).unwrap());
    let mut material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0);
    material.law = PairLaw::Linear;
    let material = material.with_critical_stretch(0.03);
    let pull = |points, speed| {
        PrescribedMotion::velocity(
            points,
            [Some(speed), Some(0.0), None],
            TimeFunction::Constant,
        )
    };
    let mut system = Body::new(cloud, material)
        .stress_state(StressState::PlaneStress)
        .form(BondForm::List)
        .motion(pull(left, -0.02))
        .motion(pull(right, 0.02))
        .build()
        .unwrap();
    let rates = RayleighRates {
        mass: 0.05,
        stiffness: 0.1,
    };
    let damping =
        RayleighDamping::new(rates, StepKind::EndOfStep, system.masses(), system.domain()).unwrap();
    system.add_boundary(Box::new(damping));
    let start = State::of(&system);
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), start, 0.1, 300).unwrap();
    run.run(|_| Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    assert!(run.system().operator().broken_bonds() > 20);
    let error = energies.balance().abs() / energies.dissipated;
    assert!(error < 1e-11, "{error:e}: {energies:?}");
}

#[test]
fn invalid_damping_factors_and_unsupported_schemes_are_errors() {
    let new = |mass, stiffness, kind| {
        let rates = RayleighRates { mass, stiffness };
        RayleighDamping::new(rates, kind, vec![1.0; 4], &Domain::alone(4)).map(|_| ())
    };
    let error = new(-1.0, 0.0, StepKind::EndOfStep).unwrap_err();
    assert!(error.to_string().contains("-1"), "{error}");
    let error = new(0.0, f64::NAN, StepKind::EndOfStep).unwrap_err();
    assert!(error.to_string().contains("NaN"), "{error}");
    assert!(new(1.0, 1.0, StepKind::EndOfStep).is_ok());
    let system = {
        let cloud = Grid::bar(32.0, 1.0, 1.0).points().unwrap();
        let material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0);
        let mut system = Body::new(cloud, material).build().unwrap();
        let rates = RayleighRates {
            mass: 0.0,
            stiffness: 1.0,
        };
        let masses = system.masses();
        let damping =
            RayleighDamping::new(rates, StepKind::Stages, masses, system.domain()).unwrap();
        system.add_boundary(Box::new(damping));
        system
    };
    let scheme = RungeKutta::new(&Tableau::rk4(), &system);
    let error = pericles::check_compatibility(&system, &scheme, 1).unwrap_err();
    assert!(error.to_string().contains("velocity-verlet"), "{error}");
}
