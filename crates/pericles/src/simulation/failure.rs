//! Errors of a running simulation.

use super::Simulation;
use crate::error::PericlesError;
use crate::guard::InstabilityCause;
use crate::observe::ObserveError;
use crate::units::significant;

/// An error that ends a run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The guard found a motion that is not physical.
    #[error(
        "the run became unstable at step {step}, t = {} s: {cause}; at point {point}, ({}, {}, {}) m, speed {} m/s. {}",
        significant(*t, 5), short(place[0]), short(place[1]), short(place[2]), significant(*speed, 3), cause.advice()
    )]
    Unstable {
        /// Step at which the instability was found.
        step: u64,
        /// Time, s.
        t: f64,
        /// The instability.
        cause: InstabilityCause,
        /// Point where it is strongest, in the user's numbering.
        point: usize,
        /// Its reference position, m.
        place: [f64; 3],
        /// Its speed, m/s.
        speed: f64,
    },
    /// The scheme could not complete the next step.
    #[error(
        "the run stopped after step {step}, t = {} s: {source}. Fastest point: {point} at ({}, {}, {}) m, speed {} m/s",
        significant(*t, 5), short(place[0]), short(place[1]), short(place[2]), significant(*speed, 3)
    )]
    Stuck {
        /// Number of completed steps.
        step: u64,
        /// Time, s.
        t: f64,
        /// The reason.
        source: Box<PericlesError>,
        /// The fastest point, in the user's numbering.
        point: usize,
        /// Its reference position, m.
        place: [f64; 3],
        /// Its speed, m/s.
        speed: f64,
    },
    /// No static state was found for a load step.
    #[error(
        "no static state was found for the load step that follows step {step}, t = {} s: {source}. The largest residual force acts on point {point} at ({}, {}, {}) m; \
         {}. {}",
        significant(*t, 5), short(place[0]), short(place[1]), short(place[2]), broke(*broken), no_state_advice(*broken)
    )]
    NoStaticState {
        /// Number of completed load steps.
        step: u64,
        /// Time of the last static state, s.
        t: f64,
        /// The reason.
        source: Box<PericlesError>,
        /// Point with the largest residual force, in the user's numbering.
        point: usize,
        /// Its reference position, m.
        place: [f64; 3],
        /// Number of bonds that broke in the load step.
        broken: u64,
    },
    /// Parts of the simulation do not fit together.
    #[error(transparent)]
    Misfit(#[from] PericlesError),
    /// An observer failed, usually because a file could not be written.
    #[error("{0}")]
    Observe(#[source] ObserveError),
}

/// Rounds to four digits, enough to locate a point.
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
        "The body has probably lost its load-bearing capacity. Use a stop condition (reaction_below or damage_above) to end such a run in time, or a prescribed displacement instead \
         of a load to follow the failure; more load steps or iterations help if convergence is only slow"
    } else {
        "Usual causes: a part of the body without constraints, a load beyond buckling, too few iterations, or load steps so large that the body stiffens strongly within one"
    }
}

impl Simulation {
    pub(super) fn stuck(&self, source: PericlesError, broken: u64) -> SimulationError {
        if self.integrator.is_static() {
            return self.no_static_state(source, broken);
        }
        let watched = self.watched(1);
        let fastest = watched.fastest();
        let speed = watched.speed(fastest);
        let (point, place, speed) = self.located(speed, fastest, speed);
        SimulationError::Stuck {
            step: self.state.step,
            t: self.state.t,
            source: source.into(),
            point,
            place,
            speed,
        }
    }

    /// Returns the user's number, the reference position (m) and the given value of the point of the process with the largest
    /// measure.
    pub(super) fn located(&self, measure: f64, point: usize, value: f64) -> (usize, [f64; 3], f64) {
        let cloud = self.system.cloud();
        let [x, y, z] = cloud.point(point);
        let own = [cloud.user_number(point) as f64, x, y, z, value];
        let [number, x, y, z, value] = self.system.domain().of_largest(measure, own);
        (number as usize, [x, y, z], value)
    }

    /// Returns the error of a load step before which `broken` bonds had broken.
    pub(super) fn no_static_state(&self, source: PericlesError, broken: u64) -> SimulationError {
        let (system, state) = (&self.system, &self.state);
        let (cloud, n) = (system.cloud(), system.points());
        // Loads at the end of the failed load step.
        let t_next = (state.step + 1) as f64 * self.dt;
        let mut force = vec![0.0; state.u.len()];
        system.force_density_into(t_next, &state.u, &mut force);
        system.hold_at(t_next, &mut force);
        let size = |i: usize| -> f64 {
            let components = (0..system.dimension()).map(|c| force[c * n + i]);
            components.map(|f| f * f).sum::<f64>().sqrt() * cloud.volumes()[i]
        };
        let worst = (0..n).fold(0, |best, i| if size(i) > size(best) { i } else { best });
        let (point, place, _) = self.located(size(worst), worst, 0.0);
        SimulationError::NoStaticState {
            step: state.step,
            t: state.t,
            source: source.into(),
            point,
            place,
            broken: system.operator().broken_bonds().saturating_sub(broken),
        }
    }

    /// Passes the unbalanced state of a failed load step that ends at `t_next` to all observers with a schedule.
    pub(super) fn show_failed(&mut self, t_next: f64) {
        if !self.integrator.is_static() {
            return;
        }
        let (step, t, dt) = (self.state.step, self.state.t, self.dt);
        (self.state.step, self.state.t) = (step + 1, t_next);
        let mut observers = std::mem::take(&mut self.observers);
        let snapshot = self.snapshot();
        let due = |s: &&mut super::Scheduled| s.schedule.is_due(step + 1, dt, step + 1);
        for scheduled in observers.iter_mut().filter(due) {
            // Errors are ignored, because the failed step is reported.
            let _ = scheduled.observer.observe_failed(&snapshot);
            let _ = scheduled.observer.settle();
        }
        self.observers = observers;
        // The last complete step.
        (self.state.step, self.state.t) = (step, t);
    }
}
