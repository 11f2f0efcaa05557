//! The physics watch: what is odd about a run at its end, in words, by thresholds.
//!
//! | what | warned of beyond |
//! |---|---|
//! | energy account | [`ENERGY`] of the work done or of the energy at the start, whichever is larger, at any row of the history |
//! | momentum account | [`MOMENTUM`] of the momentum that the energy there was could have made |
//! | loads and reactions of a static state | [`REACTIONS`] of the reactions |
//! | points near breaking, where nothing broke | [`ENDANGERED`] of the points have bonds beyond [`NEAR`] of the critical stretch |
//!
//! Waves that the grid cannot carry are found before the run (`pericles check`). Symmetry is not looked at: whether a deck is symmetric is not known without comparing all of it.

use pericles::Simulation;
use pericles::observe::Field;

use crate::report::Audit;
use crate::units::{percent, significant};

/// The account closes to 10⁻³ and better with steps near the stable one.
const ENERGY: f64 = 0.01;
/// Momentum is exact but for rounding.
const MOMENTUM: f64 = 1e-6;
/// A hundred times the default tolerance of relaxation.
const REACTIONS: f64 = 1e-4;
const NEAR: f64 = 0.9;
const ENDANGERED: f64 = 0.01;

/// What is odd.
pub(crate) fn warnings(simulation: &Simulation, audit: &Audit) -> Vec<String> {
    let found = [
        energy(audit),
        momentum(simulation, audit),
        reactions(simulation),
        endangered(simulation, audit),
    ];
    found.into_iter().flatten().collect()
}

fn energy(audit: &Audit) -> Option<String> {
    let scale = audit.external_work.abs().max(audit.initial_energy.abs());
    let drift = audit.largest_balance / scale;
    (drift > ENERGY).then(|| {
        format!(
            "the energy account is off by up to {}: a smaller time step shows whether results depend on it",
            percent(drift)
        )
    })
}

fn momentum(simulation: &Simulation, audit: &Audit) -> Option<String> {
    let system = simulation.system();
    let mass: f64 = system.masses().iter().sum::<f64>() / system.dimension() as f64;
    // Not what is left: waves may have gone, and static states have none.
    let energy = audit.initial_energy.abs() + system.ledger().exchanged;
    let error = audit.momentum_error / (2.0 * energy * mass).sqrt();
    (error > MOMENTUM).then(|| {
        format!(
            "the momentum account is off by {} of what the energy could have made",
            significant(error, 2)
        )
    })
}

/// Of a static state: loads and reactions together are nothing.
fn reactions(simulation: &Simulation) -> Option<String> {
    let system = simulation.system();
    if simulation.integrator().name() != "relaxation" || system.motions().is_empty() {
        return None;
    }
    let snapshot = simulation.snapshot();
    let (n, volumes) = (system.points(), system.cloud().volumes());
    let sum = |field: Field, c: usize| -> f64 {
        let component = &snapshot.field(field)[c * n..(c + 1) * n];
        component
            .iter()
            .zip(volumes)
            .map(|(f, volume)| f * volume)
            .sum()
    };
    let (mut left, mut size) = (0.0f64, 0.0f64);
    for c in 0..system.dimension() {
        let reaction = sum(Field::Reaction, c);
        left = left.max((reaction + sum(Field::ExternalForce, c)).abs());
        size = size.max(reaction.abs());
    }
    (left > REACTIONS * size).then(|| {
        format!(
            "loads and reactions differ by {}: a smaller tolerance of the relaxation helps",
            percent(left / size)
        )
    })
}

fn endangered(simulation: &Simulation, audit: &Audit) -> Option<String> {
    let (system, state) = (simulation.system(), simulation.state());
    let operator = system.operator();
    if audit.broken_bonds > 0 || !operator.can_break() {
        return None;
    }
    let mut marks = vec![false; system.points()];
    operator
        .as_zoned()?
        .mark_endangered(&state.u, NEAR, &mut marks);
    let share = marks.iter().filter(|mark| **mark).count() as f64 / marks.len() as f64;
    (share > ENDANGERED).then(|| {
        format!(
            "{} of the points have bonds beyond {} of the critical stretch, and none broke: a little more load would break them",
            percent(share),
            percent(NEAR)
        )
    })
}
