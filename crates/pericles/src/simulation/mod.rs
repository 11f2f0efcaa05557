//! The loop over time, written once.

mod builder;
mod failure;

use std::sync::OnceLock;

pub use builder::SimulationBuilder;
pub use failure::SimulationError;

use crate::archive::{Archive, Saved};
use crate::compatibility::require;
use crate::error::{PericlesError, positive};
use crate::guard::{Alarm, Watched};
use crate::interrupt::Interrupt;
use crate::observe::{Observer, Schedule, Snapshot, StartEnergy};
use crate::space::check_length;
use crate::stop::{StopReason, StopWhen};
use crate::system::System;
use crate::time::{HighestFrequency, Integrator, State, highest_frequency};

/// What the caller wants after a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Control {
    /// Go on.
    Continue,
    /// Stop here, between two steps.
    Stop,
}

/// Why a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It reached its end.
    Finished,
    /// The caller stopped it.
    Stopped,
}

/// An observer with its schedule.
struct Scheduled {
    schedule: Schedule,
    observer: Box<dyn Observer>,
}

/// Whether a system, with all its supports and boundaries, can be stepped by a scheme for a number of steps: what the scheme needs of the system, and what its boundaries need of the scheme.
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

/// A body, a scheme, and those who look on.
pub struct Simulation {
    system: System,
    integrator: Box<dyn Integrator>,
    state: State,
    dt: f64,
    steps: u64,
    observers: Vec<Scheduled>,
    stops: Vec<StopWhen>,
    stopped: Option<StopReason>,
    start: StartEnergy,
    /// The frequency that limits the step, if it is known.
    frequency: Option<HighestFrequency>,
    /// The step over the stable one, once it was asked for.
    step_ratio: OnceLock<Option<f64>>,
    allow_unstable: bool,
    instability: Option<Box<SimulationError>>,
}

impl Simulation {
    /// A run of `steps` steps of length `dt` from the given state, which is prepared by the integrator. [`Simulation::builder`] finds steps and scheme by itself.
    ///
    /// # Errors
    /// A state or an integrator of another body, a step that is not positive.
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
            let what = "the vectors of a time integrator that was made for another system";
            check_length(what, made_for, entries)?;
        }
        integrator.start(&mut system, &mut state);
        let start = StartEnergy {
            energy: system.kinetic_energy(&state.v) + system.operator().energy(state.t, &state.u),
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
            start,
            frequency: None,
            step_ratio: OnceLock::new(),
            allow_unstable: false,
            instability: None,
        })
    }

    /// The same where the frequency that limits the step is known, which the guard would look for otherwise.
    #[must_use]
    pub fn with_frequency(self, frequency: HighestFrequency) -> Self {
        Self {
            frequency: Some(frequency),
            ..self
        }
    }

    /// The same, going on where energy grows until numbers end; see [`Simulation::instability`].
    #[must_use]
    pub fn allowing_instability(self) -> Self {
        Self {
            allow_unstable: true,
            ..self
        }
    }

    /// The first instability of a run that goes on all the same.
    pub fn instability(&self) -> Option<&SimulationError> {
        self.instability.as_deref()
    }

    /// Adds an observer.
    pub fn observe(&mut self, schedule: Schedule, observer: Box<dyn Observer>) {
        self.observers.push(Scheduled { schedule, observer });
    }

    /// Adds a condition that ends the run before its last step.
    ///
    /// # Errors
    /// Motions or points that the system does not have.
    pub fn stop_when(&mut self, condition: StopWhen) -> Result<(), PericlesError> {
        condition.check(&self.system)?;
        self.stops.push(condition);
        Ok(())
    }

    /// The condition that ended the run, if one did.
    pub fn stop_reason(&self) -> Option<&StopReason> {
        self.stopped.as_ref()
    }

    /// The equation of motion.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// The present state.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The scheme.
    pub fn integrator(&self) -> &dyn Integrator {
        &*self.integrator
    }

    /// Step length, s.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Steps of the whole run.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Energies at the start.
    pub fn start_energy(&self) -> StartEnergy {
        self.start
    }

    /// A view of the present for observers.
    pub fn snapshot(&self) -> Snapshot<'_> {
        let scheme = self
            .integrator
            .energy_correction(&self.system, &self.state, self.dt);
        Snapshot::new(&self.system, &self.state, self.start, scheme)
            .with_inner(self.integrator.inner_iterations())
    }

    /// Runs to the end.
    ///
    /// # Errors
    /// As [`Simulation::run`].
    pub fn run_to_end(&mut self) -> Result<Outcome, SimulationError> {
        self.run(|_| Control::Continue)
    }

    /// Runs to the end, or until `control` says stop; `control` is asked after every step.
    ///
    /// Observers see the initial state of a fresh run, every state their schedule names, and the last; then they hear that the run has come to its end. A run that one
    /// of its [conditions](Simulation::stop_when) ends has finished as well: its last state is that in which the condition was met.
    ///
    /// # Errors
    /// Instability, a failing integrator, a failing observer. The state is then the one at which it happened.
    pub fn run(
        &mut self,
        control: impl FnMut(&Self) -> Control,
    ) -> Result<Outcome, SimulationError> {
        self.run_interruptible(Interrupt::never(), control)
    }

    /// The same; schemes that iterate also poll `interrupt` within a step, which may take much longer than a step of an explicit scheme. A step that is interrupted is
    /// undone: the run is then stopped at the last complete step, and a run that is continued from there takes the same path, bit for bit.
    ///
    /// # Errors
    /// As [`Simulation::run`].
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
            // From the step's number, not by adding up, so that time carries no error.
            let t_next = (self.state.step + 1) as f64 * self.dt;
            let broken = self.system.operator().broken_bonds();
            match self.step(t_next, interrupt) {
                Err(PericlesError::Interrupted) => return Ok(Outcome::Stopped),
                stepped => stepped.map_err(|source| self.stuck(source, broken))?,
            }
            self.stopped = self.met();
            let last = self.state.step == self.steps || self.stopped.is_some();
            self.guard(last)?;
            self.show(last)?;
            if self.stopped.is_some() {
                break;
            }
            if !last && control(self) == Control::Stop {
                return Ok(Outcome::Stopped);
            }
        }
        for scheduled in &mut self.observers {
            let finished = scheduled.observer.finish();
            finished.map_err(SimulationError::Observe)?;
        }
        Ok(Outcome::Finished)
    }

    /// One step; one that is interrupted is undone.
    fn step(&mut self, t_next: f64, interrupt: Interrupt<'_>) -> Result<(), PericlesError> {
        let evaluated = self.system.evaluated_points();
        let copied = interrupt.is_possible() && self.integrator.changes_within_step();
        let copy = copied.then(|| {
            let mut archive = Archive::default();
            self.save_motion(&mut archive);
            archive
        });
        let stepped = self
            .integrator
            .step(&mut self.system, &mut self.state, t_next, interrupt);
        if matches!(stepped, Err(PericlesError::Interrupted)) {
            self.system.set_evaluated_points(evaluated);
            if let Some(copy) = copy {
                self.restore_motion(&copy)?;
            }
        }
        stepped
    }

    /// What steps change.
    fn save_motion(&self, archive: &mut Archive) {
        self.state.save(archive);
        self.system.save(archive);
        self.integrator.save(archive);
    }

    fn restore_motion(&mut self, archive: &Archive) -> Result<(), PericlesError> {
        self.state.restore(archive)?;
        self.check_time()?;
        self.system.restore(archive)?;
        self.integrator.restore(archive)
    }

    /// Waits until the observers have kept what they have seen; a state saved before may know of outputs that are not there.
    ///
    /// # Errors
    /// A failing observer.
    pub fn settle(&self) -> Result<(), SimulationError> {
        for scheduled in &self.observers {
            let settled = scheduled.observer.settle();
            settled.map_err(SimulationError::Observe)?;
        }
        Ok(())
    }

    /// The first condition that the present state meets; all of them look at it.
    fn met(&mut self) -> Option<StopReason> {
        let mut met = None;
        for stop in &mut self.stops {
            let found = stop.look(&self.system);
            met = met.or(found.map(|found| StopReason {
                set: stop.set.clone(),
                step: self.state.step,
                t: self.state.t,
                found,
            }));
        }
        met
    }

    /// Shows the present state to the observers that are due; the last one to all that are ever due.
    fn show(&mut self, last: bool) -> Result<(), SimulationError> {
        let (step, dt) = (self.state.step, self.dt);
        let steps = if last { step } else { self.steps };
        let due = |s: &Scheduled| s.schedule.is_due(step, dt, steps);
        if !self.observers.iter().any(due) {
            return Ok(());
        }
        let mut observers = std::mem::take(&mut self.observers);
        let snapshot = self.snapshot();
        let mut shown = Ok(());
        for scheduled in observers.iter_mut().filter(|s| due(s)) {
            shown = scheduled.observer.observe(&snapshot);
            if shown.is_err() {
                break;
            }
        }
        self.observers = observers;
        shown.map_err(SimulationError::Observe)
    }

    /// Whether the state's step is one of this run, and its time that step's.
    fn check_time(&self) -> Result<(), PericlesError> {
        /// Parts of a step. A step that is found from frequencies differs by rounding where it is found with other instructions.
        const ROUNDING: f64 = 1e-3;
        let State { step, t, .. } = self.state;
        let of_step = step as f64 * self.dt;
        if step <= self.steps && (t - of_step).abs() <= ROUNDING * self.dt {
            return Ok(());
        }
        let (steps, dt) = (self.steps, self.dt);
        let reason = format!("step {step} at t = {t:e} s is none of the {steps} steps of {dt:e} s");
        Err(PericlesError::BadArchive { reason })
    }

    fn watched(&self) -> Watched<'_> {
        Watched {
            system: &self.system,
            state: &self.state,
            integrator: &*self.integrator,
            start: self.start,
            dt: self.dt,
            step_ratio: *self.step_ratio.get_or_init(|| self.found_step_ratio()),
        }
    }

    /// The step over the largest one that is stable at rest for certain; none for schemes without such a step and bodies without stiffness at rest.
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

    fn guard(&mut self, last: bool) -> Result<(), SimulationError> {
        let watched = self.watched();
        let looked = if self.instability.is_some() {
            watched.look_at_numbers(last)
        } else {
            watched.look(last)
        };
        let Err(Alarm { cause, point }) = looked else {
            return Ok(());
        };
        let found = SimulationError::Unstable {
            step: self.state.step,
            t: self.state.t,
            cause,
            point: self.system.cloud().user_number(point),
            place: self.system.cloud().point(point),
            speed: watched.speed(point),
        };
        if !(self.allow_unstable && cause.is_growth()) {
            return Err(found);
        }
        self.instability = Some(Box::new(found));
        Ok(())
    }

    fn stuck(&self, source: PericlesError, broken: u64) -> SimulationError {
        if self.integrator.is_static() {
            return self.no_static_state(source, broken);
        }
        let watched = self.watched();
        let point = watched.fastest();
        SimulationError::Stuck {
            step: self.state.step,
            t: self.state.t,
            source: source.into(),
            point: self.system.cloud().user_number(point),
            place: self.system.cloud().point(point),
            speed: watched.speed(point),
        }
    }
}

impl Saved for Simulation {
    fn save(&self, archive: &mut Archive) {
        let Self {
            // In `save_motion`.
            state: _,
            system: _,
            integrator: _,
            stops,
            observers,
            // Given with the run, found at its start, or found anew.
            dt: _,
            steps: _,
            start: _,
            frequency: _,
            allow_unstable: _,
            stopped: _,
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
        self.observers.restore(archive)
    }
}

crate::saved! {
    impl Saved for Scheduled {
        observer: part,
        schedule: fixed,
    }
}
