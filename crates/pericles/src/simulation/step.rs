//! One step of a simulation, and its reversal.

use super::Simulation;
use crate::archive::{Archive, Checkpointed};
use crate::boundary::Exchange;
use crate::error::PericlesError;
use crate::interrupt::Interrupt;
use crate::time::State;

impl Simulation {
    /// Returns the number of steps to the next state that an observer sees, at most the number that the scheme takes at once.
    pub(super) fn steps_to_next_visit(&self) -> u64 {
        let (step, dt, steps) = (self.state.step, self.dt, self.steps);
        let seen = |step: u64| {
            let mut schedules = self.observers.iter().map(|scheduled| scheduled.schedule);
            schedules.any(|schedule| schedule.is_due(step, dt, steps))
        };
        let most = self.integrator.steps_at_once().min(steps - step);
        (1..most).find(|&k| seen(step + k)).unwrap_or(most.max(1))
    }

    /// Performs up to `steps` steps; undoes them if they are interrupted, or if the evaluation of a load or motion has failed.
    pub(super) fn step(
        &mut self,
        steps: u64,
        interrupt: Interrupt<'_>,
    ) -> Result<(), PericlesError> {
        let evaluated = self.system.evaluated_points();
        let fallible = self.system.can_fail();
        let copied = fallible || (interrupt.is_possible() && self.integrator.changes_within_step());
        let copy = copied.then(|| {
            let mut archive = Archive::default();
            self.save_motion(&mut archive);
            archive
        });
        let mut stepped = self
            .integrator
            .advance(
                &mut self.system,
                &mut self.state,
                (self.dt, steps),
                interrupt,
            )
            .and_then(|()| self.system.end_fields(self.state.t));
        if stepped.is_ok() && self.system.activates_at(self.state.t) {
            self.activate();
        }
        if fallible && self.system.has_failed() {
            stepped = Err(PericlesError::Interrupted);
        }
        if matches!(stepped, Err(PericlesError::Interrupted)) {
            self.system.set_evaluated_points(evaluated);
            if let Some(copy) = copy {
                self.restore_motion(&copy)?;
            }
        }
        stepped
    }

    /// Activates the points whose time has come. The energy that the scheme attributes to the state changes with the
    /// accelerations of new points; like their kinetic energy it comes from outside.
    fn activate(&mut self) {
        let correction = |simulation: &Self| {
            let Self {
                system,
                integrator,
                state,
                dt,
                ..
            } = simulation;
            integrator.energy_correction(system, state, *dt)
        };
        let before = correction(self);
        let State { t, u, v, a, .. } = &mut self.state;
        let accelerations = (!self.integrator.is_static()).then_some(&mut a[..]);
        self.system.activate(*t, [u, v], accelerations);
        let work = correction(self) - before;
        self.system.book_exchange(Exchange {
            work,
            ..Exchange::default()
        });
    }

    /// Saves everything that a step changes.
    pub(super) fn save_motion(&self, archive: &mut Archive) {
        self.state.save(archive);
        self.system.save(archive);
        self.integrator.save(archive);
    }

    pub(super) fn restore_motion(&mut self, archive: &Archive) -> Result<(), PericlesError> {
        self.state.restore(archive)?;
        self.check_time()?;
        self.system.restore(archive)?;
        self.integrator.restore(archive)
    }
}
