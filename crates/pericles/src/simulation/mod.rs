//! The time loop.
//!
//! The time is step · dt, never a sum of steps. Work arrays are allocated in constructors, not in steps.

mod builder;
mod failure;
mod step;

use std::cell::OnceCell;
use std::sync::{Arc, OnceLock};

pub use builder::SimulationBuilder;
pub use failure::SimulationError;

use crate::archive::{Archive, Checkpointed};
use crate::compatibility::require;
use crate::domain::agreed;
use crate::error::{PericlesError, positive};
use crate::guard::{Alarm, Watched};
use crate::interrupt::Interrupt;
use crate::observe::{ObserveError, Observer, Schedule, Snapshot, StartEnergy};
use crate::space::{PointCloud, check_length};
use crate::stop::{StopReason, StopWhen};
use crate::system::System;
use crate::time::{HighestFrequency, Integrator, State, highest_frequency};

/// What to do after a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Continue with the next step.
    Continue,
    /// Stop here, between two steps.
    Stop,
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It reached its end time or a stop condition.
    Finished,
    /// The caller stopped it.
    Stopped,
}

/// An observer with its schedule.
struct Scheduled {
    schedule: Schedule,
    observer: Box<dyn Observer>,
}

/// Checks that a scheme can integrate a system with all its constraints and boundaries for a number of steps: the
/// [requirements](crate::Requirement) of the scheme on the system, and the requirements of the boundaries on the scheme.
///
/// # Errors
/// [`PericlesError::SchemeNotUsable`], [`PericlesError::BoundaryScheme`] and [`PericlesError::BoundarySteps`].
pub fn check_compatibility(
    system: &System,
    integrator: &dyn Integrator,
    steps: u64,
) -> Result<(), PericlesError> {
    let (scheme, kind) = (integrator.name(), integrator.step_kind());
    for boundary in system.boundaries() {
        let needed = boundary.step_kinds();
        if !needed.is_empty() && !needed.contains(&kind) {
            return Err(PericlesError::BoundaryScheme {
                what: "a boundary of this run",
                scheme,
                kind,
                needed,
            });
        }
        if let Some(made_for) = boundary.steps().filter(|made_for| *made_for < steps) {
            return Err(PericlesError::BoundarySteps { steps, made_for });
        }
    }
    require(scheme, integrator.requirements(), system)
}

/// A system, a time integrator, a state and the observers of a run.
pub struct Simulation {
    system: System,
    integrator: Box<dyn Integrator>,
    state: State,
    dt: f64,
    steps: u64,
    observers: Vec<Scheduled>,
    stops: Vec<StopWhen>,
    stopped: Option<StopReason>,
    /// The points of the whole body on the process that writes the results of a divided body.
    whole: Option<Arc<PointCloud>>,
    start: StartEnergy,
    /// The frequency that limits the step, if known.
    frequency: Option<HighestFrequency>,
    /// Ratio of the step to the stable step, computed on first use.
    step_ratio: OnceLock<Option<f64>>,
    allow_unstable: bool,
    instability: Option<Box<SimulationError>>,
}

impl Simulation {
    /// A run of `steps` steps of length `dt` from the given state, which the integrator prepares.
    /// [`Simulation::builder`] chooses scheme and step automatically.
    ///
    /// # Errors
    /// A state or an integrator made for another body; a step that is not positive.
    pub fn new(
        mut system: System,
        mut integrator: Box<dyn Integrator>,
        mut state: State,
        dt: f64,
        steps: u64,
    ) -> Result<Self, PericlesError> {
        positive("the time step", dt)?;
        let entries = system.dimension() * system.points();
        for (what, given) in [
            ("the displacement of the state", &state.u),
            ("the velocity of the state", &state.v),
            ("the acceleration of the state", &state.a),
        ] {
            check_length(what, given.len(), entries)?;
        }
        if let Some(made_for) = integrator.vector_length() {
            let what = "the vectors of a time integrator made for another system";
            check_length(what, made_for, entries)?;
        }
        system.start_activation(state.t, &mut state.v);
        integrator.start(&mut system, &mut state);
        let start = StartEnergy {
            energy: system.mechanical_energy(state.t, &state.u, &state.v),
            dissipated: system.operator().dissipated(),
            scheme: integrator.energy_correction(&system, &state, dt),
        };
        Ok(Self {
            system,
            integrator,
            state,
            dt,
            steps,
            observers: Vec::new(),
            stops: Vec::new(),
            stopped: None,
            whole: None,
            start,
            frequency: None,
            step_ratio: OnceLock::new(),
            allow_unstable: false,
            instability: None,
        })
    }

    /// Sets the frequency that limits the step, which the guard would compute otherwise.
    #[must_use]
    pub fn with_frequency(self, frequency: HighestFrequency) -> Self {
        Self {
            frequency: Some(frequency),
            ..self
        }
    }

    /// Continues when the energy grows, until a value is NaN or infinite; see [`Simulation::instability`].
    #[must_use]
    pub fn allowing_instability(self) -> Self {
        Self {
            allow_unstable: true,
            ..self
        }
    }

    /// Sets the points of the whole body, which observers use on the process that writes the results of a divided body.
    #[must_use]
    pub fn of_whole(self, whole: Option<Arc<PointCloud>>) -> Self {
        Self { whole, ..self }
    }

    /// Returns the first instability of a run that continued nevertheless.
    pub fn instability(&self) -> Option<&SimulationError> {
        self.instability.as_deref()
    }

    /// Adds an observer.
    pub fn observe(&mut self, schedule: Schedule, observer: Box<dyn Observer>) {
        self.observers.push(Scheduled { schedule, observer });
    }

    /// Adds a condition that ends the run early.
    ///
    /// # Errors
    /// Constraints or points that the system does not have.
    pub fn stop_when(&mut self, condition: StopWhen) -> Result<(), PericlesError> {
        condition.check(&self.system)?;
        self.stops.push(condition);
        Ok(())
    }

    /// Returns the condition that ended the run, if one did.
    pub fn stop_reason(&self) -> Option<&StopReason> {
        self.stopped.as_ref()
    }

    /// Returns the system.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Returns the current state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Returns the time integrator.
    pub fn integrator(&self) -> &dyn Integrator {
        &*self.integrator
    }

    /// Time step, s.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Number of steps of the whole run.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Energies at the start of the run.
    pub fn start_energy(&self) -> StartEnergy {
        self.start
    }

    /// Returns the view of the current state that observers receive.
    pub fn snapshot(&self) -> Snapshot<'_> {
        let scheme = self
            .integrator
            .energy_correction(&self.system, &self.state, self.dt);
        Snapshot::new(&self.system, &self.state, self.start, scheme)
            .with_inner(self.integrator.inner_iterations())
            .with_whole(self.whole.as_deref())
    }

    /// Runs to the end.
    ///
    /// # Errors
    /// The errors of [`Simulation::run`].
    pub fn run_to_end(&mut self) -> Result<Outcome, SimulationError> {
        self.run(|_| Control::Continue)
    }

    /// Runs to the end, or until `control`, which is called after every step, returns [`Control::Stop`].
    ///
    /// Observers see the initial state of a new run, every state of their schedule, and the last state; then
    /// [`Observer::finish`] is called. A run ended by one of its [conditions](Simulation::stop_when) counts as
    /// finished; its last state is the one that meets the condition.
    ///
    /// # Errors
    /// Instability, an error of the integrator, an error of an observer. The simulation keeps the state at which it
    /// occurred. If a load step has no static state, observers see the unbalanced state as the last one.
    pub fn run(
        &mut self,
        control: impl FnMut(&Self) -> Control,
    ) -> Result<Outcome, SimulationError> {
        self.run_interruptible(Interrupt::never(), control)
    }

    /// Runs as [`Simulation::run`]; iterative schemes also poll `interrupt` within a step, which may take much
    /// longer than an explicit step. An interrupted step is undone: the run stops at the last complete step and
    /// continues from there bit for bit as if it had not been interrupted. So is a step in which the evaluation of a
    /// load or prescribed motion [fails](crate::boundary::PointValues::has_failed).
    ///
    /// # Errors
    /// The errors of [`Simulation::run`].
    pub fn run_interruptible(
        &mut self,
        interrupt: Interrupt<'_>,
        mut control: impl FnMut(&Self) -> Control,
    ) -> Result<Outcome, SimulationError> {
        check_compatibility(&self.system, &*self.integrator, self.steps)?;
        if self.state.step == 0 {
            self.show(false)?;
        }
        while self.state.step < self.steps {
            let first = self.state.step;
            let broken = self.system.operator().broken_bonds();
            match self.step(self.steps_to_next_visit(), interrupt) {
                Err(PericlesError::Interrupted) => return Ok(Outcome::Stopped),
                Err(source) => {
                    let error = self.stuck(source, broken);
                    self.show_failed((self.state.step + 1) as f64 * self.dt);
                    return Err(error);
                }
                Ok(()) => {}
            }
            self.stopped = self.met()?;
            let last = self.state.step == self.steps || self.stopped.is_some();
            self.guard(self.state.step - first, last)?;
            self.show(last)?;
            if self.stopped.is_some() {
                break;
            }
            if !last && control(self) == Control::Stop {
                return Ok(Outcome::Stopped);
            }
        }
        let observers = &mut self.observers;
        let finished = observers
            .iter_mut()
            .try_for_each(|scheduled| scheduled.observer.finish());
        self.agreed(finished)?;
        Ok(Outcome::Finished)
    }

    /// Waits until the observers have written what they have seen. Otherwise a checkpoint may refer to output that
    /// does not exist yet.
    ///
    /// # Errors
    /// An error of an observer.
    pub fn settle(&self) -> Result<(), SimulationError> {
        let settled = (self.observers.iter()).try_for_each(|scheduled| scheduled.observer.settle());
        self.agreed(settled)
    }

    /// Returns the result of the observers, or an error if those of another process have failed.
    fn agreed(&self, observed: Result<(), ObserveError>) -> Result<(), SimulationError> {
        let elsewhere = || Box::new(PericlesError::OnAnotherProcess).into();
        let comm = &**self.system.domain().comm();
        agreed(comm, observed, elsewhere).map_err(SimulationError::Observe)
    }

    /// Evaluates all conditions and returns the first that the current state meets.
    fn met(&mut self) -> Result<Option<StopReason>, SimulationError> {
        let mut stops = std::mem::take(&mut self.stops);
        let snapshot = OnceCell::new();
        let (mut met, mut failed) = (None, Ok(()));
        // All conditions are evaluated, because other processes may have no error.
        for stop in &mut stops {
            match stop.look(&self.system, || snapshot.get_or_init(|| self.snapshot())) {
                Ok(found) => {
                    met = met.or(found.map(|found| StopReason {
                        name: stop.name.clone(),
                        step: self.state.step,
                        t: self.state.t,
                        found,
                    }));
                }
                Err(error) => failed = failed.and(Err(error)),
            }
        }
        let has_tests = stops.iter().any(StopWhen::is_test);
        self.stops = stops;
        if has_tests {
            self.agreed(failed)?;
        }
        Ok(met)
    }

    /// Passes the current state to the observers that are due; the last state to all observers with a schedule.
    fn show(&mut self, last: bool) -> Result<(), SimulationError> {
        let (step, dt) = (self.state.step, self.dt);
        let steps = if last { step } else { self.steps };
        let due = |s: &Scheduled| s.schedule.is_due(step, dt, steps);
        if !self.observers.iter().any(due) {
            return Ok(());
        }
        let mut observers = std::mem::take(&mut self.observers);
        let snapshot = self.snapshot();
        // All observers are called, because other processes may have no error.
        let mut shown = Ok(());
        for scheduled in observers.iter_mut().filter(|s| due(s)) {
            shown = shown.and(scheduled.observer.observe(&snapshot));
        }
        self.observers = observers;
        self.agreed(shown)
    }

    /// Checks that step number and time of the state belong to this run.
    fn check_time(&self) -> Result<(), PericlesError> {
        /// Tolerance as a fraction of a step: a step derived from a computed frequency depends on the instruction
        /// set by rounding.
        const ROUNDING: f64 = 1e-3;
        let State { step, t, .. } = self.state;
        let of_step = step as f64 * self.dt;
        if step <= self.steps && (t - of_step).abs() <= ROUNDING * self.dt {
            return Ok(());
        }
        let (steps, dt) = (self.steps, self.dt);
        let reason = format!(
            "step {step} at t = {t:e} s does not belong to this run of {steps} steps of {dt:e} s"
        );
        Err(PericlesError::BadArchive { reason })
    }

    fn watched(&self, steps: u64) -> Watched<'_> {
        Watched {
            steps,
            system: &self.system,
            state: &self.state,
            integrator: &*self.integrator,
            start: self.start,
            dt: self.dt,
            step_ratio: *self.step_ratio.get_or_init(|| self.found_step_ratio()),
        }
    }

    /// Returns the ratio of the step to the largest step that is certainly stable at rest; `None` for schemes
    /// without a stable step and bodies without stiffness.
    fn found_step_ratio(&self) -> Option<f64> {
        let limit = self.integrator.stability_limit()?;
        if let Some(frequency) = self.frequency {
            return Some(self.dt / frequency.stable_step(limit, 1.0));
        }
        let density = |i: usize| self.system.density().at(i);
        let crude = self.system.operator().frequency_bound(&density);
        if crude * self.dt <= limit {
            return (crude > 0.0).then_some(crude * self.dt / limit);
        }
        let rest = vec![0.0; self.state.u.len()];
        let body = highest_frequency(&self.system, &rest).ok()?;
        let limiting = self
            .integrator
            .limiting_frequency(&self.system, &rest, body)
            .ok()?;
        Some(self.dt / limiting.stable_step(limit, 1.0))
    }

    fn guard(&mut self, steps: u64, last: bool) -> Result<(), SimulationError> {
        let watched = self.watched(steps);
        let looked = if self.instability.is_some() {
            watched.look_at_numbers(last)
        } else {
            watched.look(last)
        };
        let Err(Alarm {
            cause,
            point,
            measure,
        }) = looked
        else {
            return Ok(());
        };
        let (point, place, speed) = self.located(measure, point, watched.speed(point));
        let found = SimulationError::Unstable {
            step: self.state.step,
            t: self.state.t,
            cause,
            point,
            place,
            speed,
        };
        if !(self.allow_unstable && cause.is_growth()) {
            return Err(found);
        }
        self.instability = Some(Box::new(found));
        Ok(())
    }
}

impl Checkpointed for Simulation {
    fn save(&self, archive: &mut Archive) {
        let Self {
            // Saved by `save_motion`.
            state: _,
            system: _,
            integrator: _,
            stops,
            observers,
            // Given with the run, or computed again.
            dt: _,
            steps: _,
            start: _,
            frequency: _,
            allow_unstable: _,
            stopped: _,
            whole: _,
            step_ratio: _,
            instability: _,
        } = self;
        self.save_motion(archive);
        stops.save(archive);
        observers.save(archive);
    }

    fn restore(&mut self, archive: &Archive) -> crate::Result<()> {
        self.restore_motion(archive)?;
        self.stops.restore(archive)?;
        // Observers of the other processes write no files that they could continue.
        match self.system.domain().is_first() {
            true => self.observers.restore(archive),
            false => Ok(()),
        }
    }
}

crate::saved! {
    impl Checkpointed for Scheduled {
        observer: part,
        schedule: fixed,
    }
}
