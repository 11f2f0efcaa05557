//! Static states by fictitious motion against those of Newton's method.

use pericles::prelude::*;
use pericles::time::{Damping, Relaxation, RelaxationOptions};
use pericles_statics::{StaticOptions, StaticScheme};

use crate::bodies::pulled_plate;
use crate::equilibrium::stretched_plate;

const TOLERANCE: f64 = 1e-9;

fn state(system: System, scheme: Box<dyn Integrator>) -> (Vec<f64>, Energies) {
    let start = State::of(&system);
    let mut run = Simulation::new(system, scheme, start, 1.0, 1).unwrap();
    run.run_to_end().unwrap();
    (run.state().u.clone(), run.snapshot().energies())
}

#[test]
fn fire_finds_the_states_of_newtons_method() {
    let bodies: [&dyn Fn() -> System; 2] =
        [&|| pulled_plate(20, 0.25, vec![]), &|| stretched_plate(20)];
    for body in bodies {
        let system = body();
        let options = StaticOptions {
            tolerance: TOLERANCE,
            ..StaticOptions::default()
        };
        let newton = StaticScheme::new(options, &system).unwrap();
        let (exact, stored) = state(system, Box::new(newton));
        let size = exact.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        for damping in [Damping::Fire, Damping::Adaptive] {
            let system = body();
            let options = RelaxationOptions {
                damping,
                tolerance: TOLERANCE,
                ..RelaxationOptions::default()
            };
            let scheme = Relaxation::new(options, &system).unwrap();
            let (u, energies) = state(system, Box::new(scheme));
            let pairs = u.iter().zip(&exact);
            let error = pairs.fold(0.0, |most: f64, (u, v)| most.max((u - v).abs())) / size;
            // The condition number of these plates is a few thousand, so that the error of displacements may exceed
            // the relative residual by about this factor.
            assert!(error < 1e3 * TOLERANCE, "{damping:?}: {error:e}");
            let energy = energies.elastic / stored.elastic - 1.0;
            assert!(energy.abs() < 1e3 * TOLERANCE, "{damping:?}: {energy:e}");
        }
    }
}
