//! Orders of the schemes for smooth motion.

use pericles::System;
use pericles::boundary::MotionKind;
use pericles::space::PointSet;
use pericles::time::{AdaptiveRungeKutta, Integrator};

use super::bodies::{nonlinear_plate, plate, pushed_bar};
use super::schemes::{error_x, mixed, reference, respa, run, uniform};

#[test]
fn orders_on_a_nonlinear_plate_with_ragged_fine_points() {
    let exact = reference(nonlinear_plate());
    // Errors at T/128 and T/256, computed by another code.
    for (order, expected, band) in [
        (3, [9.523e-7, 1.178e-7], 2.95..3.10),
        (4, [4.989e-8, 3.103e-9], 3.90..4.05),
    ] {
        let errors = [128, 256]
            .map(|steps| error_x(&run(nonlinear_plate(), steps, mixed(order, 4)), &exact));
        for (found, expected) in errors.iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 0.03, "{errors:?}");
        }
        let observed = (errors[0] / errors[1]).log2();
        assert!(band.contains(&observed), "order {observed} of {errors:?}");
    }
}

#[test]
fn multirate_with_equal_steps_differs_from_the_single_rate_scheme_by_its_order() {
    for order in [3, 4] {
        let difference = |steps| {
            let plain = run(nonlinear_plate(), steps, uniform(order));
            let zoned = run(nonlinear_plate(), steps, mixed(order, 1));
            error_x(&zoned, &plain.state().u)
        };
        let (coarse, fine) = (difference(64), difference(128));
        let observed = (coarse / fine).log2();
        assert!(
            observed > f64::from(order) - 0.15 && observed < f64::from(order) + 1.2,
            "order {order}: {observed} from {coarse} {fine}"
        );
    }
}

#[test]
fn respa_is_of_second_order() {
    let exact = reference(nonlinear_plate());
    let errors: Vec<f64> = [128, 256, 512]
        .into_iter()
        .map(|steps| error_x(&run(nonlinear_plate(), steps, respa(4)), &exact))
        .collect();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.93..2.05).contains(&order), "{order} of {errors:?}");
    }
}

#[test]
fn loads_and_prescribed_motion_preserve_the_order() {
    for kind in [
        None,
        Some(MotionKind::Displacement),
        Some(MotionKind::Velocity),
    ] {
        let exact = reference(pushed_bar(kind));
        for order in [3, 4] {
            let errors = [64, 128].map(|steps| {
                let plain = run(pushed_bar(kind), steps, uniform(order));
                let zoned = run(pushed_bar(kind), steps, mixed(order, 4));
                for simulation in [&plain, &zoned] {
                    let state = simulation.state();
                    if let [motion] = simulation.system().motions() {
                        let g = &motion.function;
                        let amplitude = motion.amplitude(0).unwrap();
                        let (u, v) = match motion.kind {
                            MotionKind::Displacement => (g.value(state.t), g.derivative(state.t)),
                            MotionKind::Velocity => (g.integral(state.t), g.value(state.t)),
                        };
                        assert_eq!(state.u[0], amplitude * u);
                        assert_eq!(state.v[0], amplitude * v);
                    }
                }
                [error_x(&plain, &exact), error_x(&zoned, &exact)]
            });
            for k in 0..2 {
                let observed = (errors[0][k] / errors[1][k]).log2();
                println!("{kind:?} {order} {k}: {observed} {errors:?}");
                assert!(observed > f64::from(order) - 0.2, "{kind:?}: {observed}");
            }
        }
    }
}

#[test]
fn the_adaptive_pair_meets_its_tolerance() {
    let exact = {
        let (system, state, fine, _) = nonlinear_plate();
        run((system, state, fine, 1.2e-4), 2048, uniform(4))
            .state()
            .u
            .clone()
    };
    let size = exact.iter().fold(0.0, |max: f64, u| max.max(u.abs()));
    let mut last = (f64::INFINITY, 0);
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let pair = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
            Box::new(AdaptiveRungeKutta::new(tolerance, system).unwrap())
        };
        // Two steps of the run: the scheme chooses its own sub-steps.
        let simulation = run(nonlinear_plate(), 2, pair);
        let error = error_x(&simulation, &exact) / size;
        let evaluations = simulation.system().evaluated_points();
        println!("{tolerance:e}: {error:e} with {evaluations}");
        assert!(error < 30.0 * tolerance, "{error} for {tolerance}");
        assert!(error < 0.2 * last.0 && evaluations > last.1);
        last = (error, evaluations);
    }
    assert!(AdaptiveRungeKutta::new(0.0, &plate().0).is_err());
}
