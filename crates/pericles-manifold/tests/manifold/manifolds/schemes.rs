//! Implicit schemes on surfaces.

use pericles::round_trip::check_resume;
use pericles::time::{
    DiscreteGradient, InnerSolver, Integrator, Newmark, NewmarkOptions, State, VelocityVerlet,
    highest_frequency,
};
use pericles::{Control, PericlesError, Simulation, SimulationError, System};

use super::sphere::*;

#[test]
fn newmark_has_its_theoretical_numerical_frequency() {
    // For an eigenvector the trapezoidal rule is a rotation with tan(ω̃ dt/2) = ω dt/2.
    let sphere = Sphere::standard();
    let material = material(2.0, 0.5);
    let (value, vector) = breathing(&sphere, &material);
    let (omega, dt, steps) = (value.sqrt(), 0.05, 200);
    let numerical = 2.0 / dt * (0.5 * omega * dt).atan();
    for solver in [
        InnerSolver::FixedPoint,
        InnerSolver::Anderson { depth: 4 },
        InnerSolver::NewtonKrylov,
    ] {
        let system = sphere.system(&material);
        let scheme = Newmark::new(newmark(solver), &system).unwrap();
        let mut state = State::at_rest(3 * sphere.cloud.len());
        state.u[..vector.len()].copy_from_slice(&vector);
        let (run, spread) = spread(system, Box::new(scheme), state, dt, steps);
        let expected = (numerical * dt * steps as f64).cos();
        for (u, x) in run.state().u.iter().zip(&vector) {
            assert!((u - expected * x).abs() < 1e-8, "{solver:?}");
        }
        assert!(spread < 1e-8, "{solver:?}: {spread}");
    }
}

#[test]
fn energy_error_of_cubic_bonds_is_second_order_in_the_step() {
    let sphere = Sphere::standard();
    let material = material(3.0, 0.999);
    let spreads: Vec<f64> = [1000, 2000]
        .map(|steps| {
            let system = sphere.system(&material);
            let scheme = Newmark::new(newmark(InnerSolver::FixedPoint), &system).unwrap();
            let dt = 1.0 / steps as f64;
            spread(system, Box::new(scheme), sphere.thrown(1.0), dt, steps).1
        })
        .to_vec();
    assert!(spreads[0] < 2e-3, "{spreads:?}");
    assert!((spreads[0] / spreads[1] - 4.0).abs() < 0.4, "{spreads:?}");
}

#[test]
fn implicit_schemes_are_stable_at_ten_times_the_explicit_limit() {
    let sphere = Sphere::standard();
    let linear = material(2.0, 0.5);
    let dt = 10.0 * 2.0 / 8.007;
    let system = sphere.system(&linear);
    let scheme = Newmark::new(newmark(InnerSolver::NewtonKrylov), &system).unwrap();
    assert!(scheme.stability_limit().is_none());
    let (run, change) = spread(system, Box::new(scheme), sphere.thrown(0.1), dt, 100);
    assert!(change < 1e-8, "{change}");
    assert!(run.integrator().inner_iterations().unwrap().most < 20);
    for p in [2.0, 3.0, 5.0] {
        let material = material(p, 0.5);
        // Explicit limit at a state that the body reaches: the highest frequency after one time unit.
        let scout = VelocityVerlet;
        let (run, _) = spread(
            sphere.system(&material),
            Box::new(scout),
            sphere.thrown(0.5),
            1e-2,
            100,
        );
        let omega = highest_frequency(run.system(), &run.state().u)
            .unwrap()
            .estimate;
        let system = sphere.system(&material);
        let scheme = DiscreteGradient::new(1e-10, &system).unwrap();
        let before = system.momentum(&sphere.thrown(0.5).v);
        let dt = 20.0 / omega;
        let (run, change) = spread(system, Box::new(scheme), sphere.thrown(0.5), dt, 15);
        assert!(change < 1e-8, "p = {p}: {change}");
        let after = run.system().momentum(&run.state().v);
        for c in 0..3 {
            assert!((after[c] - before[c]).abs() < 1e-9, "p = {p}");
        }
    }
}

#[test]
fn discrete_gradient_scheme_is_second_order() {
    let sphere = Sphere::standard();
    let material = material(4.0, 0.5);
    let end = |integrator: &dyn Fn(&System) -> Box<dyn Integrator>, steps: u64| {
        let system = sphere.system(&material);
        let scheme = integrator(&system);
        let dt = 0.5 / steps as f64;
        let (run, _) = spread(system, scheme, sphere.thrown(1.0), dt, steps);
        run.state().u.clone()
    };
    let reference = end(&|_| Box::new(VelocityVerlet), 4000);
    let errors = [10, 20].map(|steps| {
        let u = end(
            &|system| Box::new(DiscreteGradient::new(1e-11, system).unwrap()),
            steps,
        );
        let square: f64 = u.iter().zip(&reference).map(|(a, b)| (a - b).powi(2)).sum();
        square.sqrt()
    });
    let order = (errors[0] / errors[1]).log2();
    assert!((order - 2.0).abs() < 0.2, "{order}");
}

#[test]
fn fixed_point_iteration_converges_only_below_the_explicit_limit() {
    let sphere = Sphere::standard();
    let material = material(2.0, 0.999);
    let most = |part: f64, solver| {
        let system = sphere.system(&material);
        let options = NewmarkOptions {
            solver,
            iterations: 400,
            ..NewmarkOptions::default()
        };
        let scheme = Newmark::new(options, &system).unwrap();
        let dt = part * 2.0 / 20.17;
        let mut run =
            Simulation::new(system, Box::new(scheme), sphere.thrown(0.1), dt, 20).unwrap();
        run.run(|_| Control::Continue)
            .map(|_| run.integrator().inner_iterations().unwrap().most)
    };
    let plain = most(0.9, InnerSolver::FixedPoint).unwrap();
    assert!((50..100).contains(&plain), "{plain}");
    let accelerated = most(0.9, InnerSolver::Anderson { depth: 5 }).unwrap();
    assert!(2 * accelerated < plain, "{accelerated} and {plain}");
    match most(1.02, InnerSolver::FixedPoint).unwrap_err() {
        SimulationError::Stuck { source, .. } => {
            let PericlesError::InnerIteration { omega, safe, .. } = *source else {
                panic!("{source}");
            };
            assert!((omega / 20.17 - 1.0).abs() < 1e-2, "{omega}");
            let safe = safe.unwrap();
            assert!(safe < 2.0 / 20.17 && safe > 0.9 * 2.0 / 20.17, "{safe}");
        }
        other => panic!("{other}"),
    }
}

#[test]
fn too_few_iterations_advise_more_iterations_not_a_smaller_step() {
    let sphere = Sphere::standard();
    let message = |dt: f64, iterations| {
        let system = sphere.system(&material(2.0, 0.999));
        let options = NewmarkOptions {
            iterations,
            ..NewmarkOptions::default()
        };
        let scheme = Newmark::new(options, &system).unwrap();
        let mut run =
            Simulation::new(system, Box::new(scheme), sphere.thrown(0.1), dt, 20).unwrap();
        run.run(|_| Control::Continue).unwrap_err().to_string()
    };
    let one = message(0.01, 1);
    assert!(one.contains("after 1 evaluation the velocity"), "{one}");
    assert!(one.contains("Give iterations = 2 or more"), "{one}");
    assert!(!one.contains("dt ≤") && !one.contains("NaN"), "{one}");
    // Far above the limit the iterates overflow.
    let far = message(1e100, 50);
    assert!(
        far.contains("NaN or infinite") && far.contains("give dt ≤"),
        "{far}"
    );
    assert!(!far.contains("changes by"), "{far}");
}

#[test]
fn implicit_schemes_resume_from_a_checkpoint() {
    let sphere = Sphere::standard();
    let material = material(3.0, 0.5);
    type Make<'a> = &'a dyn Fn(&System) -> Box<dyn Integrator>;
    let schemes: [Make<'_>; 2] = [
        &|system| {
            Box::new(Newmark::new(newmark(InnerSolver::Anderson { depth: 3 }), system).unwrap())
        },
        &|system| Box::new(DiscreteGradient::new(1e-9, system).unwrap()),
    ];
    for scheme in schemes {
        let make = || {
            let system = sphere.system(&material);
            let integrator = scheme(&system);
            Simulation::new(system, integrator, sphere.thrown(1.0), 0.05, 12).unwrap()
        };
        check_resume(make, [5]).unwrap();
    }
}
