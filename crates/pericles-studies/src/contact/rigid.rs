//! A free rigid ball on a free block.

use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::material::{BondMaterial, ElasticModulus};
use pericles::time::{State, VelocityVerlet};
use pericles::{Body, Simulation};
use pericles_contact::{ContactBodies, ContactLaw, Impactor, ImpactorMotion, Inertia, Pose, Shape};
use pericles_run::RunError;

use crate::common::{cells, watch};
use crate::data::{Case, Found};

/// Forces after 10, 20 and 30 steps and the final velocity of a ball of radius 3 and mass 40 on a block of 8 × 8 × 5 cells
/// with E = ρ = dx = 1 and a horizon of 3 (1 + 1e-6) with the micromodulus of 3; relative errors of energy and momentum.
pub(super) fn ball(_case: &Case<'_>) -> Result<Found, RunError> {
    const MASS: f64 = 40.0;
    const SPEED: f64 = 0.08;
    let cloud = Arc::new(cells([-4.0, -4.0, -5.0], vec![8.0, 8.0, 5.0], 1.0)?);
    let n = cloud.len();
    let horizon = 3.0 * (1.0 + 1e-6);
    let young = ElasticModulus::Young((horizon / 3.0f64).powi(4));
    let mut material = BondMaterial::new(young, 1.0, horizon);
    material.volume_correction = VolumeCorrection::Linear;
    let mut system = Body::new(cloud.clone(), material).build()?;
    let free = ImpactorMotion::Free {
        inertia: Inertia::Mass {
            mass: MASS,
            inertia: None,
        },
        velocity: [0.0, 0.0, -SPEED],
        spin: [0.0; 3],
    };
    let ball = Impactor::new(
        "ball",
        Shape::Ball { radius: 3.0 },
        Pose::at([0.3, -0.2, 3.02]),
        free,
        cloud,
        ContactLaw::default(),
        ContactBodies::uniform(n, 1.0, 3.0, 1.0),
    )?;
    system.add_interaction(Box::new(ball))?;
    let state = State::of(&system);
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), state, 0.6, 40)?;
    let reading = |now: &Simulation| {
        let mut all = now.system().interactions();
        all.find_map(|one| one.downcast_ref::<Impactor>().map(Impactor::reading))
    };
    let mut forces = [f64::NAN; 3];
    watch(&mut run, |now| {
        let step = now.state().step;
        if matches!(step, 10 | 20 | 30)
            && let Some(reading) = reading(now)
        {
            forces[step as usize / 10 - 1] = reading.force[2];
        }
    })?;
    let velocity = reading(&run).map_or([f64::NAN; 3], |reading| reading.velocity);
    let points = run.system().momentum(&run.state().v)[2];
    let energies = run.snapshot().energies();
    Ok([
        ("first", forces[0]),
        ("second", forces[1]),
        ("third", forces[2]),
        ("velocity", velocity[2]),
        (
            "momentum",
            (points + MASS * velocity[2]) / (MASS * SPEED) + 1.0,
        ),
        ("balance", energies.balance().abs() / energies.initial),
    ]
    .into())
}
