//! Stability limits of the coarse step.

use pericles::space::PointSet;
use pericles::time::{Interpolant, MultiTimeStepOptions, Predictor, highest_frequency_on};
use pericles::{Interrupt, System};

use super::bodies::{Problem, small_plate};
use super::schemes::{Scheme, options, respa, two_steps};

/// Growth per step of the largest velocity between two step numbers, for ω dt of the coarse points.
fn growth(problem: Problem, omega_dt: f64, steps: [u64; 2], scheme: &Scheme<'_>) -> f64 {
    let (mut system, mut state, fine, _) = problem;
    let coarse: PointSet = (0..system.points() as u32)
        .filter(|i| fine.binary_search(i).is_err())
        .collect();
    let all: PointSet = (0..system.points() as u32).collect();
    // Points without fine neighbours have the frequency of the coarse material.
    let omega = highest_frequency_on(&system, &state.u, &coarse).unwrap();
    let whole = highest_frequency_on(&system, &state.u, &all).unwrap();
    assert!(omega.converged && omega.estimate <= whole.estimate * 1.001);
    let mut scheme = scheme(&system, &fine);
    let limiting = scheme.limiting_frequency(&system, &state.u, whole).unwrap();
    let dt = omega_dt / limiting.estimate;
    scheme.start(&mut system, &mut state);
    let mut sizes = [0.0; 2];
    for step in 1..=steps[1] {
        scheme
            .step(
                &mut system,
                &mut state,
                step as f64 * dt,
                Interrupt::never(),
            )
            .unwrap();
        for k in 0..2 {
            // The largest value of a few steps, so that the phase does not matter.
            if step <= steps[k] && step + 50 > steps[k] {
                sizes[k] = state.v.iter().fold(sizes[k], |m: f64, v| m.max(v.abs()));
            }
        }
        if sizes[0] > 1e100 {
            return f64::INFINITY;
        }
    }
    (sizes[1] / sizes[0]).ln() / (steps[1] - steps[0]) as f64
}

#[test]
fn multirate_schemes_are_stable_up_to_the_limit_of_the_method() {
    for (stiffness, core) in [(1.0, 0.0), (16.0, 0.012)] {
        for (order, limit) in [(3, 3f64.sqrt()), (4, 8f64.sqrt())] {
            for interpolant in [Interpolant::Hermite, Interpolant::Stages] {
                let scheme = |system: &System, fine: &PointSet| {
                    let options = MultiTimeStepOptions {
                        interpolant,
                        ..options(4, fine)
                    };
                    two_steps(system, order, options)
                };
                let below = growth(
                    small_plate(stiffness, core),
                    0.99 * limit,
                    [1000, 4000],
                    &scheme,
                );
                let above = growth(
                    small_plate(stiffness, core),
                    1.02 * limit,
                    [500, 1500],
                    &scheme,
                );
                println!(
                    "stiffness {stiffness}, order {order}, {interpolant:?}: {below:e} {above:e}"
                );
                assert!(below < 1e-9, "order {order}: {below} per step");
                assert!(above > 1e-3, "order {order}: {above} per step");
            }
        }
    }
}

#[test]
fn the_backward_difference_predictor_is_weakly_unstable_and_the_default_is_not() {
    let rate = |predictor, omega_dt| {
        let scheme = move |system: &System, fine: &PointSet| {
            let options = MultiTimeStepOptions {
                predictor,
                ..options(4, fine)
            };
            two_steps(system, 4, options)
        };
        growth(small_plate(1.0, 0.0), omega_dt, [10_000, 20_000], &scheme)
    };
    // The rate depends on the plate and its fine region; another code found 3.3e-4 and 1.5e-3 on a similar one.
    for (omega_dt, expected) in [(1.5, 3.3e-4), (2.0, 1.5e-3)] {
        let found = rate(Predictor::BackwardDifference, omega_dt);
        assert!(found > 0.1 * expected && found < 10.0 * expected, "{found}");
        assert!(rate(Predictor::Structured, omega_dt) < 1e-9);
    }
}

#[test]
fn respa_is_stable_up_to_the_limit_of_the_coarse_points() {
    for (stiffness, core) in [(1.0, 0.0), (16.0, 0.012)] {
        // Oscillations of the energy of symplectic schemes cause at most this growth over so many steps.
        let swing = 1e-3;
        let below = growth(small_plate(stiffness, core), 1.96, [1000, 9000], &respa(4));
        let above = growth(small_plate(stiffness, core), 2.1, [60, 160], &respa(4));
        assert!(
            below.abs() < swing,
            "stiffness {stiffness}: {below} per step"
        );
        assert!(
            above > 10.0 * swing,
            "stiffness {stiffness}: {above} per step"
        );
    }
}
