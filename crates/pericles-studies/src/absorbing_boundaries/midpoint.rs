//! Exact absorbing boundaries of implicit schemes, compared with a larger body with the same time step.

use pericles::time::{Implicit, ImplicitRule};
use pericles::{PericlesError, Simulation};
use pericles_run::RunError;
use pericles_waves::absorbing::history::BlockedHistory;
use pericles_waves::absorbing::{
    GhostKernels, LatticeStep, MidpointEnd, OuterLayer, Side, contour_kernels,
};

use super::bar::Bar;
use crate::common::{difference, finish};
use crate::data::{Case, Found};

/// Bar with a soft middle; `margin` is the number of additional nodes on each side, in place of absorbing
/// boundaries.
fn run(dt: f64, steps: u64, margin: Option<usize>) -> Result<Simulation, RunError> {
    let bar = Bar {
        margin: margin.unwrap_or(0),
        ..Bar::infinite(0.5)
    };
    let (mut system, state) = bar.system()?;
    let sides = match margin {
        None => &[Side::Left, Side::Right][..],
        Some(_) => &[],
    };
    for &side in sides {
        let end = OuterLayer::of(&system, side, &state, &[]).and_then(|layer| {
            let step = LatticeStep::midpoint(dt);
            let kernels = contour_kernels(&layer.stencil, step, steps as usize);
            let history = BlockedHistory::new(GhostKernels::shift(kernels));
            MidpointEnd::new(layer, Box::new(history), dt)
        });
        system.add_boundary(Box::new(end.map_err(PericlesError::from)?));
    }
    let scheme = Implicit::new(ImplicitRule::Midpoint, &system)?;
    let mut simulation = Simulation::new(system, Box::new(scheme), state, dt, steps)?;
    finish(&mut simulation)?;
    Ok(simulation)
}

/// Largest error of displacement and velocity after `steps` steps `dt`, and the relative energy imbalance.
pub(super) fn midpoint(case: &Case<'_>) -> Result<Found, RunError> {
    let (dt, steps) = (case.number("dt")?, case.count("steps")? as u64);
    // Ten nodes per unit of time and back; an implicit step has unlimited range and decays as exp(−2 n/(10 dt)).
    let margin = (5.0 * dt * steps as f64 + 200.0 * dt.max(1.0)) as usize + 100;
    let (small, large) = (run(dt, steps, None)?, run(dt, steps, Some(margin))?);
    let (a, b) = (small.state(), large.state());
    let error = difference(&a.u, &b.u[margin..]).max(difference(&a.v, &b.v[margin..]));
    let energies = small.snapshot().energies();
    Ok([
        ("error", error),
        ("nodes", large.state().u.len() as f64),
        ("unbalanced", energies.balance().abs() / energies.initial),
    ]
    .into())
}
