//! Builder of simulations.

use super::{Simulation, check_compatibility};
use crate::error::{PericlesError, Result, positive};
use crate::observe::{Observer, Schedule};
use crate::space::{Point, PointSet, check_length, check_points};
use crate::stop::StopWhen;
use crate::system::System;
use crate::time::{HighestFrequency, Integrator, State, VelocityVerlet, highest_frequency};

/// How the length of the run is given.
#[derive(Clone, Copy)]
enum Length {
    /// Up to this time, s.
    End(f64),
    /// This number of steps.
    Steps(u64),
}

/// How the time step is given.
#[derive(Clone, Copy)]
enum Step {
    /// This fraction of the largest stable step.
    Safety(f64),
    /// This time step, s, or slightly less, so that a whole number of steps reaches the end.
    Fixed(f64),
}

/// Default fraction of the stable step, small enough for slightly nonlinear bodies too.
const SAFETY: f64 = 0.95;
/// Relative rounding error tolerated in a number of steps that should be whole.
const WHOLE: f64 = 1e-9;

/// Builder of a [`Simulation`], made by [`Simulation::builder`].
///
/// Set the end with [`end`](Self::end) or [`steps`](Self::steps). Everything else has a default: velocity Verlet,
/// 0.95 of the largest stable step, the undeformed body at rest, no observers.
#[must_use]
pub struct SimulationBuilder {
    system: System,
    scheme: Box<dyn Integrator>,
    state: State,
    length: Option<Length>,
    step: Step,
    observers: Vec<(Schedule, Box<dyn Observer>)>,
    stops: Vec<StopWhen>,
    allow_unstable: bool,
}

impl Simulation {
    /// Starts to build a simulation of a system.
    ///
    /// ```
    /// use pericles::prelude::*;
    ///
    /// // A steel bar of 0.2 m vibrating in its first mode.
    /// let bar = Grid::bar(0.2, 1e-3, 1e-4).points()?;
    /// let steel = BondMaterial::new(ElasticModulus::Young(210e9), 7850.0, 3e-3);
    /// let mut run = Simulation::builder(Body::new(bar, steel).build()?)
    ///     .velocity(|[x, ..]| [(std::f64::consts::PI * x / 0.2).cos(), 0.0, 0.0])
    ///     .end(50e-6)
    ///     .build()?;
    /// run.run_to_end()?;
    /// let energies = run.snapshot().energies();
    /// assert!(energies.balance().abs() < 1e-9 * energies.initial);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn builder(system: System) -> SimulationBuilder {
        SimulationBuilder {
            state: State::of(&system),
            system,
            scheme: Box::new(VelocityVerlet),
            length: None,
            step: Step::Safety(SAFETY),
            observers: Vec::new(),
            stops: Vec::new(),
            allow_unstable: false,
        }
    }
}

impl SimulationBuilder {
    /// Sets the time integrator.
    pub fn scheme(mut self, scheme: impl Integrator + 'static) -> Self {
        self.scheme = Box::new(scheme);
        self
    }

    /// Sets a time integrator that is constructed from the system, such as `|system|
    /// Implicit::new(ImplicitRule::Midpoint, system)`.
    ///
    /// # Errors
    /// The errors of `make`.
    pub fn scheme_for<I: Integrator + 'static>(
        self,
        make: impl FnOnce(&System) -> Result<I>,
    ) -> Result<Self> {
        let scheme = make(&self.system)?;
        Ok(self.scheme(scheme))
    }

    /// Sets the complete initial state.
    ///
    /// # Errors
    /// A state whose vectors do not fit the body.
    pub fn state(mut self, state: State) -> Result<Self> {
        let entries = self.state.u.len();
        check_length("the displacement of the state", state.u.len(), entries)?;
        check_length("the velocity of the state", state.v.len(), entries)?;
        check_length("the acceleration of the state", state.a.len(), entries)?;
        self.state = state;
        Ok(self)
    }

    /// Sets the initial displacement (m) as a function of the reference position (m); components beyond the
    /// dimension are ignored.
    pub fn displacement(mut self, field: impl Fn(Point) -> Point) -> Self {
        set(&self.system, &mut self.state.u, field);
        self
    }

    /// Sets the initial velocity (m/s) as a function of the reference position (m); components beyond the dimension
    /// are ignored.
    pub fn velocity(mut self, field: impl Fn(Point) -> Point) -> Self {
        set(&self.system, &mut self.state.v, field);
        self
    }

    /// Sets the same initial velocity (m/s) on a set of points.
    ///
    /// # Errors
    /// Points that the body does not have.
    pub fn velocity_of(mut self, points: &PointSet, velocity: Point) -> Result<Self> {
        let n = self.system.points();
        check_points("the points of an initial velocity", points, n)?;
        for c in 0..self.system.dimension() {
            for &i in points {
                self.state.v[c * n + i as usize] = velocity[c];
            }
        }
        Ok(self)
    }

    /// Sets the end time, s. The step is shortened so that a whole number of steps reaches it.
    pub fn end(mut self, end: f64) -> Self {
        self.length = Some(Length::End(end));
        self
    }

    /// Sets the number of steps.
    pub fn steps(mut self, steps: u64) -> Self {
        self.length = Some(Length::Steps(steps));
        self
    }

    /// Sets the time step, s.
    pub fn dt(mut self, dt: f64) -> Self {
        self.step = Step::Fixed(dt);
        self
    }

    /// Sets the time step as a fraction of the largest stable step; the default is 0.95.
    pub fn safety(mut self, part: f64) -> Self {
        self.step = Step::Safety(part);
        self
    }

    /// Adds an observer and its schedule. To read it after the run, pass it as `Arc<Mutex<…>>` and keep a clone.
    pub fn observe(mut self, schedule: Schedule, observer: impl Observer + 'static) -> Self {
        self.observers.push((schedule, Box::new(observer)));
        self
    }

    /// Adds a condition that ends the run early.
    pub fn stop_when(mut self, condition: StopWhen) -> Self {
        self.stops.push(condition);
        self
    }

    /// Accepts time steps above the stable step, and continues when the energy grows.
    pub fn allow_unstable(mut self) -> Self {
        self.allow_unstable = true;
        self
    }

    /// Builds the simulation in its initial state.
    ///
    /// # Errors
    /// No end time or number of steps; a step that is not positive or is unstable; no step for a scheme without a
    /// stable step of its own; a scheme that is not available for this system.
    pub fn build(mut self) -> Result<Simulation> {
        let length = self.length.ok_or(PericlesError::NotGiven {
            what: "the end of the simulation",
            allowed: "give end (s) or steps",
        })?;
        self.system.start_from(&self.state.u);
        let frequency = self.limiting_frequency()?;
        let longest = self.longest_step(frequency)?;
        let (dt, steps) = match length {
            Length::Steps(steps) => (longest, steps),
            Length::End(end) => whole_steps(end, longest)?,
        };
        check_compatibility(&self.system, &*self.scheme, steps)?;
        let mut run = Simulation::new(self.system, self.scheme, self.state, dt, steps)?;
        if let Some(frequency) = frequency {
            run = run.with_frequency(frequency);
        }
        if self.allow_unstable {
            run = run.allowing_instability();
        }
        for (schedule, observer) in self.observers {
            run.observe(schedule, observer);
        }
        for stop in self.stops {
            run.stop_when(stop)?;
        }
        Ok(run)
    }

    /// Returns the frequency that limits the step; `None` for schemes that are stable at any step.
    fn limiting_frequency(&self) -> Result<Option<HighestFrequency>> {
        if self.scheme.stability_limit().is_none() {
            return Ok(None);
        }
        let (system, u) = (&self.system, &self.state.u);
        let found = highest_frequency(system, u)
            .and_then(|body| self.scheme.limiting_frequency(system, u, body));
        match (found, self.step) {
            // Bodies without stiffness accept any given step.
            (Err(PericlesError::NoStiffness), Step::Fixed(_)) => Ok(None),
            (found, _) => found.map(Some),
        }
    }

    /// Returns the step before it is shortened to reach the end exactly.
    fn longest_step(&self, frequency: Option<HighestFrequency>) -> Result<f64> {
        let limit = self.scheme.stability_limit().zip(frequency);
        match (self.step, limit) {
            (Step::Safety(part), Some((limit, frequency))) => {
                positive("the fraction of the stable step", part)?;
                let stable = frequency.stable_step(limit, 1.0);
                let stable = part * self.system.stable_contact_step(stable, limit);
                Ok(stable.min(self.system.longest_contact_step()))
            }
            (Step::Safety(_), None) => Err(PericlesError::NotGiven {
                what: "the time step of a scheme that is stable for any step",
                allowed: "give dt (s)",
            }),
            (Step::Fixed(dt), limit) => {
                positive("the time step", dt)?;
                match limit {
                    Some((limit, frequency))
                        if dt > frequency.unstable_step(limit) && !self.allow_unstable =>
                    {
                        Err(PericlesError::UnstableStep {
                            dt,
                            omega: frequency.estimate,
                            limit: frequency.stable_step(limit, 1.0),
                            scheme: self.scheme.name(),
                        })
                    }
                    _ => Ok(dt),
                }
            }
        }
    }
}

/// Returns the largest step, at most `longest`, of which a whole number reaches `end`, and that number.
fn whole_steps(end: f64, longest: f64) -> Result<(f64, u64)> {
    /// Larger numbers of steps are not exact in a double.
    const MOST: f64 = 9e15;
    let ratio = positive("the end of the simulation", end)? / longest;
    if ratio > MOST {
        return Err(PericlesError::OutOfRange {
            quantity: "the number of steps",
            value: ratio,
            allowed: "at most 9e15",
        });
    }
    let count = (ratio * (1.0 - WHOLE)).ceil().max(1.0);
    Ok((end / count, count as u64))
}

/// Evaluates a vector field at all points.
fn set(system: &System, values: &mut [f64], field: impl Fn(Point) -> Point) {
    let (cloud, n) = (system.cloud(), system.points());
    for i in 0..n {
        let vector = field(cloud.point(i));
        for c in 0..system.dimension() {
            values[c * n + i] = vector[c];
        }
    }
}
