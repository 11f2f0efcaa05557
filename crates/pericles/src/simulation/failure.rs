//! Why a run failed.

use super::Simulation;
use crate::error::PericlesError;
use crate::guard::Cause;
use crate::observe::ObserveError;

/// Why a run failed.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The guard found something that no body does.
    #[error(
        "the run became unstable at step {step}, t = {t:e} s: {cause}; at point {point}, ({}, {}, {}) m, with {speed:e} m/s. {}",
        place[0], place[1], place[2], cause.advice()
    )]
    Unstable {
        /// Step at which it was found.
        step: u64,
        /// Time, s.
        t: f64,
        /// What was found.
        cause: Cause,
        /// The point where it is worst, in the user's numbering.
        point: usize,
        /// Its reference position, m.
        place: [f64; 3],
        /// Its speed, m/s.
        speed: f64,
    },
    /// The scheme found no way on.
    #[error(
        "the run cannot go on from step {step}, t = {t:e} s: {source}; the fastest point is {point} at ({}, {}, {}) m with {speed:e} m/s",
        place[0], place[1], place[2]
    )]
    Stuck {
        /// Steps taken.
        step: u64,
        /// Time, s.
        t: f64,
        /// Why.
        source: Box<PericlesError>,
        /// The fastest point, in the user's numbering.
        point: usize,
        /// Its reference position, m.
        place: [f64; 3],
        /// Its speed, m/s.
        speed: f64,
    },
    /// A load step has no static state, or none was found.
    #[error(
        "no static state was found for the load step that follows step {step}, t = {t:.4e} s: {source}. The largest force out of balance acts on point {point} at ({}, {}, {}) m; \
         {}. {}",
        short(place[0]), short(place[1]), short(place[2]), broke(*broken), no_state_advice(*broken)
    )]
    NoStaticState {
        /// Load steps that were completed.
        step: u64,
        /// Time of the last static state, s.
        t: f64,
        /// Why.
        source: Box<PericlesError>,
        /// The point with the largest force out of balance, in the user's numbering.
        point: usize,
        /// Its reference position, m.
        place: [f64; 3],
        /// Bonds that broke in the load step.
        broken: u64,
    },
    /// The parts of the run do not fit together.
    #[error(transparent)]
    Misfit(#[from] PericlesError),
    /// An observer failed, usually because it could not write.
    #[error("{0}")]
    Observe(#[source] ObserveError),
}

/// Four digits are enough to find a place.
fn short(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

fn broke(bonds: u64) -> String {
    match bonds {
        0 => "no bond broke in this load step".into(),
        1 => "1 bond broke in this load step".into(),
        _ => format!("{bonds} bonds broke in this load step"),
    }
}

fn no_state_advice(broken: u64) -> &'static str {
    if broken > 0 {
        "The body can probably not bear this load any more. A stop condition (reaction_below or damage_above) ends such a run in time; a prescribed displacement in place of a \
         load follows the failure; more load steps or iterations help where it only converges slowly"
    } else {
        "Usual causes: a part of the body that no support holds, a load beyond buckling, too few iterations, or load steps so large that the body becomes much stiffer within one"
    }
}

impl Simulation {
    /// Of a load step before which `broken` bonds had broken.
    pub(super) fn no_static_state(&self, source: PericlesError, broken: u64) -> SimulationError {
        let (system, state) = (&self.system, &self.state);
        let (cloud, n) = (system.cloud(), system.points());
        // Loads are those that the step goes to.
        let t_next = (state.step + 1) as f64 * self.dt;
        let mut force = vec![0.0; state.u.len()];
        system.force_density_into(t_next, &state.u, &mut force);
        system.hold_at(t_next, &mut force);
        let size = |i: usize| -> f64 {
            let components = (0..system.dimension()).map(|c| force[c * n + i]);
            components.map(|f| f * f).sum::<f64>().sqrt() * cloud.volumes()[i]
        };
        let worst = (0..n).fold(0, |best, i| if size(i) > size(best) { i } else { best });
        SimulationError::NoStaticState {
            step: state.step,
            t: state.t,
            source: source.into(),
            point: cloud.user_number(worst),
            place: cloud.point(worst),
            broken: system.operator().broken_bonds().saturating_sub(broken),
        }
    }
}
