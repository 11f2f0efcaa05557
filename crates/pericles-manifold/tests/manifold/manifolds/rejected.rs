//! Invalid parameters.

use pericles::time::{DiscreteGradient, InnerSolver, Newmark, NewmarkOptions};
use pericles_manifold::PowerMaterial;

use super::sphere::*;

#[test]
fn materials_and_parameters_out_of_range_are_errors() {
    let good = material(2.0, 0.5);
    let wrong = [
        PowerMaterial { alpha: 1.0, ..good },
        PowerMaterial { alpha: 0.0, ..good },
        PowerMaterial {
            alpha: f64::NAN,
            ..good
        },
        PowerMaterial { p: 1.9, ..good },
        PowerMaterial {
            p: f64::NAN,
            ..good
        },
        PowerMaterial { kappa: 0.0, ..good },
        PowerMaterial {
            density: -1.0,
            ..good
        },
        PowerMaterial {
            horizon: 0.0,
            ..good
        },
        PowerMaterial {
            critical_stretch: 0.0,
            ..good
        },
        PowerMaterial {
            p: 3.0,
            self_interaction: true,
            ..good
        },
    ];
    assert!(good.check().is_ok());
    for material in wrong {
        assert!(material.check().is_err(), "{material:?}");
    }
    let sphere = Sphere::standard();
    let system = sphere.system(&good);
    for options in [
        NewmarkOptions {
            beta: -0.1,
            ..Default::default()
        },
        NewmarkOptions {
            beta: 0.6,
            ..Default::default()
        },
        NewmarkOptions {
            gamma: 0.4,
            ..Default::default()
        },
        NewmarkOptions {
            tolerance: 0.0,
            ..Default::default()
        },
        NewmarkOptions {
            iterations: 0,
            ..Default::default()
        },
        newmark(InnerSolver::Anderson { depth: 9 }),
        NewmarkOptions {
            beta: 0.0,
            ..newmark(InnerSolver::NewtonKrylov)
        },
    ] {
        assert!(Newmark::new(options, &system).is_err(), "{options:?}");
    }
    assert!(DiscreteGradient::new(0.0, &system).is_err());
}
