//! The guard of a run: what stops it before it fills a disk with nonsense.
//!
//! | what | looked for | in |
//! |---|---|---|
//! | numbers that are none | every [`OFTEN`] steps | velocities |
//! | energy from nowhere | kinetic every [`OFTEN`], all of it every [`RARELY`] steps | all bodies |
//! | points that have passed each other | every [`OFTEN`] steps | bars that are not linear: a linear law knows no order of points |
//! | a step above the bound | every [`RARELY`] steps, and where energy came from nowhere | bodies that are not linear, under explicit schemes of one step, unless the step was too long from the start |
//!
//! Everything is looked for after the last step. The guard touches nothing, so that results do not depend on it; its cost is below one evaluation of the force in a hundred.

use std::fmt;

use crate::observe::StartEnergy;
use crate::system::System;
use crate::time::{Integrator, State, frequency_from_below, highest_frequency};

/// Steps between two looks that cost next to nothing.
const OFTEN: u64 = 20;
/// Steps between two looks that cost as much as some evaluations of the force.
const RARELY: u64 = 2000;
/// Energy over what was there and what was exchanged at which a run is given up: there is room for the errors of coarse steps.
const GROWTH: f64 = 2.0;
/// Evaluations of the tangent for a look at the stiffness.
const APPLICATIONS: usize = 10;
/// By how much the bound of the linearised motion may be passed: motion that is not linear does not grow at once.
const SLACK: f64 = 1.02;

/// Why a run is given up.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Cause {
    /// A velocity is not a number.
    NotANumber,
    /// More energy than was there and was put in.
    Growth {
        /// Its ratio to that.
        ratio: f64,
    },
    /// Neighbours of a bar have changed places.
    Passed {
        /// The other point, in the user's numbering.
        other: usize,
    },
    /// The body has become so stiff that the step is too long.
    Stiffened {
        /// The step, s.
        dt: f64,
        /// The largest stable step now, or a bound of it from above, s.
        limit: f64,
    },
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber => write!(f, "a velocity is not a number"),
            Self::Growth { ratio } => {
                write!(f, "the energy is {ratio:.3e} times what was put in")
            }
            Self::Passed { other } => write!(f, "it has passed its neighbour, point {other}"),
            Self::Stiffened { dt, limit } => write!(
                f,
                "the body has become stiffer: steps above {limit:.4e} s are unstable now, and dt is {dt:.4e} s"
            ),
        }
    }
}

impl Cause {
    /// What can be done.
    pub fn advice(&self) -> &'static str {
        match self {
            Self::NotANumber | Self::Growth { .. } => {
                "usual causes: a time step above the stable limit, a load that tears points off, a displacement prescribed too fast"
            }
            Self::Passed { .. } => {
                "a weaker load, a smoother initial field or a larger spacing keeps points apart"
            }
            Self::Stiffened { .. } => "give a smaller dt",
        }
    }
}

/// What was found, and at which point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Alarm {
    pub(crate) cause: Cause,
    pub(crate) point: usize,
}

/// A run as the guard sees it.
pub(crate) struct Watched<'a> {
    pub(crate) system: &'a System,
    pub(crate) state: &'a State,
    pub(crate) integrator: &'a dyn Integrator,
    pub(crate) start: StartEnergy,
    pub(crate) dt: f64,
}

impl Watched<'_> {
    /// Looks at what is due after a step; at everything after the last.
    pub(crate) fn look(&self, last: bool) -> Result<(), Alarm> {
        let due = |every: u64| last || self.state.step.is_multiple_of(every);
        if due(OFTEN) {
            self.look_at_motion()?;
            self.look_at_order()?;
        }
        if due(RARELY) {
            self.look_at_energy()?;
            self.look_at_stiffness()?;
        }
        Ok(())
    }

    /// The fastest point; one whose velocity is not a number counts as such.
    pub(crate) fn fastest(&self) -> usize {
        let n = self.system.points();
        (0..n).fold(0, |best, i| {
            if self.speed(i) > self.speed(best) {
                i
            } else {
                best
            }
        })
    }

    /// The speed of a point, m/s; infinite if it is not a number.
    pub(crate) fn speed(&self, i: usize) -> f64 {
        let n = self.system.points();
        let components = (0..self.system.dimension()).map(|c| self.state.v[c * n + i]);
        let speed = components.map(|v| v * v).sum::<f64>().sqrt();
        if speed.is_nan() { f64::INFINITY } else { speed }
    }

    fn look_at_motion(&self) -> Result<(), Alarm> {
        let kinetic = self.system.kinetic_energy(&self.state.v);
        if kinetic.is_finite() {
            return self.compare(kinetic);
        }
        Err(Alarm {
            cause: Cause::NotANumber,
            point: self.fastest(),
        })
    }

    /// What the scheme conserves: close to the stable limit the plain energy swings by orders of magnitude.
    fn look_at_energy(&self) -> Result<(), Alarm> {
        let (system, state) = (self.system, self.state);
        let operator = system.operator();
        let elastic = operator.energy(state.t, &state.u);
        let kinetic = system.kinetic_energy(&state.v);
        let correction = self.integrator.energy_correction(system, state, self.dt);
        self.compare(kinetic + elastic + operator.dissipated() + correction)
    }

    /// Energy cannot exceed what was there and what was exchanged with the outside, whichever way: what left may come back.
    fn compare(&self, energy: f64) -> Result<(), Alarm> {
        let available = self.start.energy + self.system.ledger().exchanged;
        let ratio = energy / available.max(f64::MIN_POSITIVE);
        if ratio <= GROWTH {
            return Ok(());
        }
        let omega = highest_frequency(self.system, &self.state.u);
        let stiffened = omega.ok().and_then(|omega| self.stiffened(omega.estimate));
        Err(Alarm {
            cause: stiffened.unwrap_or(Cause::Growth { ratio }),
            point: self.fastest(),
        })
    }

    /// Cells of a bar that lie side by side stay in their order as long as the bonds between them hold.
    fn look_at_order(&self) -> Result<(), Alarm> {
        let (system, cloud) = (self.system, self.system.cloud());
        let operator = system.operator();
        if system.dimension() != 1 || operator.as_linear().is_some() {
            return Ok(());
        }
        let mut damage = vec![0.0; cloud.len()];
        if operator.broken_bonds() > 0 {
            operator.damage_into(&mut damage);
        }
        let x = cloud.axis(0);
        let passed = (1..cloud.len()).find(|&k| {
            let (xi, eta) = (x[k] - x[k - 1], self.state.u[k] - self.state.u[k - 1]);
            let beside = xi.abs() < cloud.cell_size(k - 1) + cloud.cell_size(k);
            let whole = damage[k - 1] == 0.0 && damage[k] == 0.0;
            beside && whole && xi * (xi + eta) <= 0.0
        });
        match passed {
            None => Ok(()),
            Some(point) => Err(Alarm {
                cause: Cause::Passed {
                    other: cloud.user_number(point - 1),
                },
                point,
            }),
        }
    }

    fn look_at_stiffness(&self) -> Result<(), Alarm> {
        if self.system.operator().as_linear().is_some() || self.stable_step(1.0).is_none() {
            return Ok(());
        }
        let omega = frequency_from_below(self.system, &self.state.u, APPLICATIONS);
        match self.stiffened(omega) {
            None => Ok(()),
            Some(cause) => Err(Alarm {
                cause,
                point: self.hardest(),
            }),
        }
    }

    /// The cause of a step that is too long for a frequency, 1/s, but was not for that of the body at rest: what was too long from the start is wanted.
    fn stiffened(&self, omega: f64) -> Option<Cause> {
        let (dt, limit) = (self.dt, self.stable_step(omega)?);
        if dt <= SLACK * limit {
            return None;
        }
        let rest = vec![0.0; self.state.u.len()];
        let first = highest_frequency(self.system, &rest).ok()?.estimate;
        (dt <= SLACK * self.stable_step(first)?).then_some(Cause::Stiffened { dt, limit })
    }

    /// The largest stable step of a frequency, for schemes whose step has one bound for all points.
    fn stable_step(&self, omega: f64) -> Option<f64> {
        let one = self.integrator.refinement().is_none();
        Some(self.integrator.stability_limit().filter(|_| one)? / omega)
    }

    /// The point with the most elastic energy in its volume.
    fn hardest(&self) -> usize {
        let mut energy = vec![0.0; self.system.points()];
        let operator = self.system.operator();
        operator.add_energy_density(self.state.t, &self.state.u, &mut energy);
        (0..energy.len()).fold(0, |best, i| if energy[i] > energy[best] { i } else { best })
    }
}
