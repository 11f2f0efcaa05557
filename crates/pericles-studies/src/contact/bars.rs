//! Longitudinal impact of bars: E = ρ = A = L = 1, three points in the horizon, no partial volumes, small displacements, dt
//! of half a cell, first contact after 0.37 of a step.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use pericles::boundary::{MotionKind, TimeFunction};
use pericles::family::{Crack, VolumeCorrection};
use pericles::material::{BondMaterial, ElasticModulus, PairLaw};
use pericles::space::PointCloud;
use pericles::time::{State, VelocityVerlet};
use pericles::{Body, Simulation, System};
use pericles_contact::{
    ContactBodies, ContactLaw, Impactor, ImpactorMotion, PointContact, Pose, Shape,
};
use pericles_run::RunError;

use crate::common::watch;
use crate::data::{Case, Found};

/// Speed of the striking bar; small displacements do not depend on it.
const SPEED: f64 = 1e-3;

/// A striking bar of `cells` cells and, behind a gap, a struck one of `struck` cells or none.
fn body(
    cells: usize,
    struck: usize,
    gap: f64,
) -> Result<(System, Arc<PointCloud>, ContactBodies), RunError> {
    let dx = 1.0 / cells as f64;
    let first = (0..cells).map(|k| (k as f64 + 0.5) * dx);
    let second = (0..struck).map(|k| 1.0 + gap + (k as f64 + 0.5) * dx);
    let n = cells + struck;
    let cloud = PointCloud::new(1, first.chain(second).collect(), vec![dx; n], 1.0)?;
    let cloud = Arc::new(cloud);
    // The modulus of the lattice, 6 c dx², is 4/3 of that of the continuum, ½ c δ².
    let mut material =
        BondMaterial::new(ElasticModulus::Young(0.75), 1.0, 3.0 * dx).with_law(PairLaw::Linear);
    material.volume_correction = VolumeCorrection::None;
    let mut body = Body::new(cloud.clone(), material);
    if struck > 0 {
        body = body.crack(Crack::Section { x: 1.0 + 0.5 * gap });
    }
    let bodies = ContactBodies {
        piece: (0..n).map(|i| u32::from(i >= cells)).collect(),
        ..ContactBodies::uniform(n, 1.0, 3.0 * dx, 1.0)
    };
    Ok((body.build()?, cloud, bodies))
}

fn law(case: &Case<'_>) -> Result<ContactLaw, RunError> {
    Ok(ContactLaw {
        damping: case.number("damping")?,
        ..ContactLaw::default()
    })
}

/// Runs the impact; returns the end and the duration of the contact: the number of steps that end in contact times dt.
fn impact(
    system: System,
    cells: usize,
    dt: f64,
    lengths: f64,
) -> Result<(Simulation, f64), RunError> {
    let mut state = State::of(&system);
    state.v[..cells].fill(SPEED);
    let steps = (lengths / dt).round() as u64;
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), state, dt, steps)?;
    let (mut first, mut last) = (f64::NAN, f64::NAN);
    watch(&mut run, |now| {
        if now.snapshot().energies().contact > 0.0 {
            let t = now.state().t;
            first = if first.is_nan() { t } else { first };
            last = t;
        }
    })?;
    Ok((run, last - first + dt))
}

fn mean(v: &[f64]) -> f64 {
    v.iter().sum::<f64>() / v.len() as f64
}

/// Velocities of both bars after the impact relative to the first velocity, restitution and duration.
pub(super) fn bars(case: &Case<'_>) -> Result<Found, RunError> {
    let (cells, ratio) = (case.count("cells")?, case.count("ratio")?);
    let dt = 0.5 / cells as f64;
    let (mut system, cloud, bodies) = body(cells, ratio * cells, 0.37 * SPEED * dt)?;
    let contact = PointContact::new(cloud, law(case)?, bodies)?;
    system.add_interaction(Box::new(contact))?;
    let (run, duration) = impact(system, cells, dt, 2.0 * ratio as f64 + 1.0)?;
    let (a, b) = run.state().v.split_at(cells);
    let (first, second) = (mean(a) / SPEED, mean(b) / SPEED);
    Ok([
        ("first", first),
        ("second", second),
        ("restitution", second - first),
        ("duration", duration),
        ("momentum", first + ratio as f64 * second - 1.0),
    ]
    .into())
}

/// Restitution and duration of a bar on a rigid wall.
pub(super) fn wall(case: &Case<'_>) -> Result<Found, RunError> {
    let cells = case.count("cells")?;
    let dt = 0.5 / cells as f64;
    let (mut system, cloud, bodies) = body(cells, 0, 0.0)?;
    let still = ImpactorMotion::Prescribed {
        kind: MotionKind::Displacement,
        amplitude: [0.0; 3],
        function: TimeFunction::Constant,
    };
    let place = Pose::at([1.0 + 0.37 * SPEED * dt, 0.0, 0.0]).turned(1, -FRAC_PI_2);
    let law = law(case)?;
    let wall = Impactor::new("wall", Shape::HalfSpace, place, still, cloud, law, bodies)?;
    system.add_interaction(Box::new(wall))?;
    let (run, duration) = impact(system, cells, dt, 3.0)?;
    Ok([
        ("restitution", -mean(&run.state().v) / SPEED),
        ("duration", duration),
    ]
    .into())
}
