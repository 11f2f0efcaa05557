//! Exact ends within implicit steps, against a larger body with the same step.

use pericles::time::{Implicit, ImplicitRule};
use pericles::{Control, PericlesError, Simulation};
use pericles_run::RunError;
use pericles_waves::absorbing::history::BlockedHistory;
use pericles_waves::absorbing::{
    GhostKernels, LatticeStep, MidpointEnd, OuterLayer, Side, contour_kernels,
};

use super::bar::Bar;
use super::paper::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

pub(super) const MIDPOINT: Study = Study {
    id: "absorbing-boundaries/midpoint",
    paper: PAPER,
    title: "Ends within implicit midpoint steps of any size against a larger body",
    run: rows,
};

/// Steps, beyond the explicit limit of 0.25 as well, and how many.
const CASES: [(f64, u64); 4] = [(0.05, 800), (0.25, 200), (1.0, 60), (4.0, 30)];

/// The bar with a soft middle; `margin` nodes more on each side where there are no ends.
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
    simulation
        .run(|_| Control::Continue)
        .map_err(|error| RunError::of_run(error, String::new))?;
    Ok(simulation)
}

fn rows(_context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    for (dt, steps) in CASES {
        // Ten nodes per unit of time and back; an implicit step reaches everywhere, decaying as exp(−2 n/(10 dt)).
        let margin = (5.0 * dt * steps as f64 + 200.0 * dt.max(1.0)) as usize + 100;
        let (small, large) = (run(dt, steps, None)?, run(dt, steps, Some(margin))?);
        let fields = [
            (&small.state().u, &large.state().u),
            (&small.state().v, &large.state().v),
        ];
        let error = fields
            .iter()
            .flat_map(|(small, large)| small.iter().zip(&large[margin..]))
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        let energies = small.snapshot().energies();
        let label = |what: &str| format!("dt = {dt}, {steps} steps: {what}");
        rows.push(
            Row::new(
                label("largest error of displacement and velocity"),
                "",
                Some(error),
            )
            .within(0.0, 1e-12)
            .note(format!("against {} nodes", large.state().u.len())),
        );
        let balance = energies.balance().abs() / energies.initial;
        rows.push(
            Row::new(label("unbalanced share of the energy"), "", Some(balance)).within(0.0, 1e-11),
        );
    }
    Ok(rows)
}
