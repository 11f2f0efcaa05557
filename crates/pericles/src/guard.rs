//! The guard: detects unstable runs and stops them.
//!
//! | checked for | when | in |
//! |---|---|---|
//! | NaN or infinity | every [`OFTEN`] steps | velocities |
//! | more kinetic energy than was supplied | every [`OFTEN`] steps | all bodies |
//! | growing kinetic and elastic energy | every step | runs whose step is above the bound of the stable step |
//! | growth by a measure without force evaluation | every [`OFTEN`] steps | nonlinear bodies under explicit schemes |
//! | more energy than the scheme conserves | every [`RARELY`] steps | all bodies |
//! | a deformation gradient with non-positive determinant | every step | forces that compute one |
//! | points that have passed each other | every [`OFTEN`] steps | nonlinear bars (linear laws do not depend on the order of points) |
//! | points about to pass through each other in contact | every [`OFTEN`] steps | bodies with contact |
//! | a step above the stable step of a body that stiffened | every [`RARELY`] steps, and when energy appears | nonlinear bodies under explicit schemes with one step, unless the step was too long from the start |
//!
//! A processor that computes several steps at once is checked when the host reads the state, if a check was due in these steps.
//! All checks run after the last step. The guard changes nothing, so that results do not depend on it. It costs
//! less than a hundredth of a force evaluation per step, except where the step is above the bound: there it costs
//! one evaluation of the energy per step.
//!
//! **Growth.** For linear bodies velocity Verlet conserves H = T + U − dt²/8 a·Ma. H does not measure growth: it is
//! indefinite beyond the stability limit, where T + U grows without bound at constant H. Below the limit, with x =
//! dt ω/(limit of ω dt), H ≥ T + (1 − x²) U, so that T + U cannot exceed H/(1 − x²): a linear body whose step is
//! below the bound cannot grow, and its plain energy, which may oscillate by that factor, needs no check. At the
//! limit, T + U of a mode can grow (3 + 2√2)-fold in a step, and above it exponentially: a run stopped at the first
//! step with 1.7 times the supplied energy has not exceeded ten times that energy. For nonlinear bodies, whose
//! limit changes, the measure is T + dt²/8 a·Ma, which needs no force evaluation: like T + U it is bounded by a
//! multiple of the energy in stable runs, and it grows as T + U does in unstable ones, where T alone is small at
//! full steps.
//!
//! **Rounding.** Energies below that of displacements of a few units in the last place, ½ M (ω ε L)² with the mass
//! M, frequency bound ω and size L of the body, are not significant: see [`Watched::rounding`].

use std::fmt;

use crate::observe::StartEnergy;
use crate::operator::LostYield;
use crate::system::System;
use crate::time::{Integrator, State, frequency_from_below, highest_frequency};
use crate::units::significant;

/// Steps between two checks of negligible cost.
const OFTEN: u64 = 20;
/// Steps between two checks that cost several force evaluations.
const RARELY: u64 = 2000;
/// Ratio to the available energy at which a run is stopped; it allows for the errors of coarse steps.
const GROWTH: f64 = 2.0;
/// The same ratio for the sum of kinetic and elastic energy where the step is above the bound.
const PLAIN_GROWTH: f64 = 1.7;
/// The same ratio for the measure of nonlinear bodies, relative to its bound in stable runs.
const SWING: f64 = 5.0;
/// Largest overlap of a contact relative to its distance.
const DEEPEST: f64 = 0.9;
/// Evaluations of the tangent in a check of the stiffness.
const APPLICATIONS: usize = 10;
/// Allowed ratio of the step to the stable step of the linearised motion; nonlinear motion does not grow at once above
/// it.
const SLACK: f64 = 1.02;

/// The kind of an instability.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum InstabilityCause {
    /// A velocity is NaN or infinite.
    NotANumber,
    /// The energy exceeds the initial energy plus the energy exchanged since.
    Growth {
        /// Ratio to that energy.
        ratio: f64,
    },
    /// Adjacent points of a bar have passed each other.
    Passed {
        /// The other point, in the user's numbering.
        other: usize,
    },
    /// The deformation gradient of a point has a non-positive determinant: the material is inverted.
    Inverted {
        /// The determinant J.
        volume_ratio: f64,
    },
    /// The yield stress of a point is not positive at its temperature.
    LostYield {
        /// Yield stress relative to that of the material.
        ratio: f64,
    },
    /// Points overlap so much in contact that they are about to pass through each other.
    Overlapping {
        /// Overlap relative to the contact distance.
        overlap: f64,
    },
    /// The body has stiffened so much that the step is too long.
    Stiffened {
        /// The time step, s.
        dt: f64,
        /// The present largest stable step or an upper bound of it, s.
        limit: f64,
    },
}

impl fmt::Display for InstabilityCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber => write!(f, "a velocity is NaN or infinite"),
            Self::Growth { ratio } if *ratio < 1e4 => {
                write!(f, "the energy is {ratio:.1} times the supplied energy")
            }
            Self::Growth { ratio } => {
                write!(f, "the energy is {ratio:.1e} times the supplied energy")
            }
            Self::Passed { other } => {
                write!(f, "the point has passed its neighbour, point {other}")
            }
            Self::Inverted { volume_ratio } => write!(
                f,
                "the deformation gradient has the determinant {volume_ratio:.3}, but it must be positive: the material is inverted"
            ),
            Self::LostYield { ratio } => write!(
                f,
                "the yield stress at the temperature of the point is {} times that of the material, but it must be positive",
                significant(*ratio, 3)
            ),
            Self::Overlapping { overlap } => write!(
                f,
                "points overlap in contact by {:.0} % of the contact distance; allowed: up to {:.0} %",
                100.0 * overlap,
                100.0 * DEEPEST
            ),
            Self::Stiffened { dt, limit } => write!(
                f,
                "the body has become stiffer: dt is {} s, but steps above {} s are now unstable",
                significant(*dt, 4),
                significant(*limit, 4)
            ),
        }
    }
}

impl InstabilityCause {
    /// Returns usual causes and remedies.
    pub fn advice(&self) -> &'static str {
        match self {
            Self::NotANumber | Self::Growth { .. } => {
                "Usual causes: a time step above the stable limit, a load that tears points off, a displacement prescribed too fast"
            }
            Self::Passed { .. } => {
                "Use a weaker load, a smoother initial field or a larger spacing"
            }
            Self::Inverted { .. } => {
                "Usual causes: a load or prescribed displacement that is too strong or too fast, a time step above the stable limit. Remedies: a neo-Hookean law, which resists compression, or \
                 bonds that break (`fracture_energy`)"
            }
            Self::LostYield { .. } => {
                "Use a `yield_stress` that is positive at all temperatures of the run, such as a table by temperature, which is constant beyond its last row"
            }
            Self::Overlapping { .. } => {
                "The impact is too fast for the contact: use a larger stiffness or more points in the body, a smaller horizon, or a lower speed"
            }
            Self::Stiffened { .. } => "Use a smaller dt",
        }
    }

    /// Returns whether the cause is growth from a time step that is too long, and not NaN or infinity.
    pub(crate) fn is_growth(&self) -> bool {
        matches!(self, Self::Growth { .. } | Self::Stiffened { .. })
    }
}

/// An instability and the point at which it was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Alarm {
    pub(crate) cause: InstabilityCause,
    /// The point on this process.
    pub(crate) point: usize,
    /// The process with the largest value reports its point.
    pub(crate) measure: f64,
}

/// The parts of a run that the guard checks.
pub(crate) struct Watched<'a> {
    pub(crate) system: &'a System,
    pub(crate) state: &'a State,
    pub(crate) integrator: &'a dyn Integrator,
    pub(crate) start: StartEnergy,
    pub(crate) dt: f64,
    /// Number of steps since the last checks.
    pub(crate) steps: u64,
    /// Ratio of the step to the largest step that is certainly stable at rest; `None` where no such step exists.
    pub(crate) step_ratio: Option<f64>,
}

impl Watched<'_> {
    /// Runs the checks that are due after a step; all checks after the last step.
    pub(crate) fn look(&self, last: bool) -> Result<(), Alarm> {
        self.look_at_volumes()?;
        self.look_at_yield()?;
        let due = |every: u64| last || self.is_due(every);
        if due(OFTEN) {
            self.look_at_motion()?;
            self.look_at_order()?;
            self.look_at_overlap()?;
            self.look_at_swing()?;
        }
        if self.step_ratio.is_some_and(|ratio| ratio > 1.0) {
            self.look_at_growth()?;
        }
        if due(RARELY) {
            self.look_at_energy()?;
            self.look_at_stiffness()?;
        }
        Ok(())
    }

    /// Returns whether a multiple of a number of steps was reached since the last checks.
    fn is_due(&self, every: u64) -> bool {
        let step = self.state.step;
        step / every > step.saturating_sub(self.steps) / every
    }

    /// Checks for NaN, infinity and inverted points only.
    pub(crate) fn look_at_numbers(&self, last: bool) -> Result<(), Alarm> {
        self.look_at_volumes()?;
        self.look_at_yield()?;
        if !(last || self.is_due(OFTEN)) {
            return Ok(());
        }
        self.finite_kinetic_energy().map(|_| ())
    }

    /// Returns the fastest point; NaN counts as fastest.
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

    /// Speed of a point, m/s; infinite if it is NaN.
    pub(crate) fn speed(&self, i: usize) -> f64 {
        let n = self.system.points();
        let components = (0..self.system.dimension()).map(|c| self.state.v[c * n + i]);
        let speed = components.map(|v| v * v).sum::<f64>().sqrt();
        if speed.is_nan() { f64::INFINITY } else { speed }
    }

    /// The alarm of a cause at the fastest point.
    fn alarm(&self, cause: InstabilityCause) -> Alarm {
        let point = self.fastest();
        Alarm {
            cause,
            point,
            measure: self.speed(point),
        }
    }

    fn finite_kinetic_energy(&self) -> Result<f64, Alarm> {
        let kinetic = self.system.kinetic_energy(&self.state.v);
        if kinetic.is_finite() {
            return Ok(kinetic);
        }
        Err(self.alarm(InstabilityCause::NotANumber))
    }

    fn look_at_volumes(&self) -> Result<(), Alarm> {
        let (inversion, domain) = (self.system.operator().inversion(), self.system.domain());
        if domain.all(inversion.is_none()) {
            return Ok(());
        }
        let measure = inversion.map_or(f64::NEG_INFINITY, |found| -found.volume_ratio);
        let volume_ratio = -domain.max(measure);
        Err(Alarm {
            cause: InstabilityCause::Inverted { volume_ratio },
            point: inversion.map_or(0, |found| found.point),
            measure,
        })
    }

    fn look_at_yield(&self) -> Result<(), Alarm> {
        let (operator, domain) = (self.system.operator(), self.system.domain());
        let lost = operator.lost_yield();
        if !operator.capabilities().path_dependent || domain.all(lost.is_none()) {
            return Ok(());
        }
        let finite = |lost: LostYield| match lost.ratio.is_nan() {
            true => f64::INFINITY,
            false => -lost.ratio,
        };
        let measure = lost.map_or(f64::NEG_INFINITY, finite);
        let ratio = -domain.max(measure);
        Err(Alarm {
            cause: InstabilityCause::LostYield { ratio },
            point: lost.map_or(0, |found| found.point),
            measure,
        })
    }

    fn look_at_motion(&self) -> Result<(), Alarm> {
        let kinetic = self.finite_kinetic_energy()?;
        self.compare(kinetic, GROWTH)
    }

    fn look_at_growth(&self) -> Result<(), Alarm> {
        let State { t, u, v, .. } = self.state;
        let energy = self.system.mechanical_energy(*t, u, v);
        self.compare(energy, PLAIN_GROWTH)
    }

    /// Checks the kinetic energy half a step away against its bound in a stable run, for nonlinear bodies whose
    /// step may have become too long.
    fn look_at_swing(&self) -> Result<(), Alarm> {
        let Some(ratio) = self.step_ratio.filter(|ratio| *ratio < 1.0) else {
            return Ok(());
        };
        if self.system.is_linear() {
            return Ok(());
        }
        let hidden = 0.25 * self.dt * self.dt * self.system.kinetic_energy(&self.state.a);
        let energy = self.system.kinetic_energy(&self.state.v) + hidden;
        let most = SWING / (1.0 - ratio * ratio);
        if energy <= most * (self.available() + self.rounding()) {
            return Ok(());
        }
        let omega = highest_frequency(self.system, &self.state.u);
        match omega.ok().and_then(|omega| self.stiffened(omega.estimate)) {
            None => Ok(()),
            Some(cause) => Err(self.alarm(cause)),
        }
    }

    /// Energy that was supplied or exchanged with the outside, J: energy that left may return.
    fn available(&self) -> f64 {
        self.start.energy + self.system.ledger().exchanged
    }

    /// Energy that rounding alone may create, J: the mass of the body times the square of ω ε L, the velocity of
    /// vibrations by one unit in the last place of coordinates and displacements. Rounding acts anew in every step,
    /// like a random walk.
    fn rounding(&self) -> f64 {
        let (system, operator) = (self.system, self.system.operator());
        let density = |i: usize| system.density().at(i);
        let omega = operator.frequency_bound(&density);
        let n = system.points();
        let size = (0..system.dimension())
            .flat_map(|c| {
                let x = system.cloud().axis(c);
                (0..n).map(move |i| x[i].abs() + self.state.u[c * n + i].abs())
            })
            .fold(0.0, f64::max);
        let (size, volumes) = (system.domain().max(size), system.cloud().volumes());
        let mass = system.domain().sum(n, |i| density(i) * volumes[i]);
        let unit = if operator.rounding(&self.state.u).is_some() {
            f64::from(f32::EPSILON)
        } else {
            f64::EPSILON
        };
        let steps = self.state.step as f64 + 64.0;
        mass * (omega * unit * size).powi(2) * steps
    }

    /// Checks the energy that the scheme conserves: close to the stable limit the plain energy oscillates by orders
    /// of magnitude.
    fn look_at_energy(&self) -> Result<(), Alarm> {
        let (system, state) = (self.system, self.state);
        let correction = self.integrator.energy_correction(system, state, self.dt);
        let conserved = system.mechanical_energy(state.t, &state.u, &state.v)
            + system.dissipated()
            + correction;
        self.compare(conserved, GROWTH)
    }

    /// Fails if an energy is above `most` times the available one.
    fn compare(&self, energy: f64, most: f64) -> Result<(), Alarm> {
        let available = self.available();
        if energy <= most * available || energy <= most * (available + self.rounding()) {
            return Ok(());
        }
        let omega = highest_frequency(self.system, &self.state.u);
        let stiffened = omega.ok().and_then(|omega| self.stiffened(omega.estimate));
        let ratio = energy / available.max(f64::MIN_POSITIVE);
        Err(self.alarm(stiffened.unwrap_or(InstabilityCause::Growth { ratio })))
    }

    /// Checks the order of adjacent cells of a bar, which stays the same as long as the bonds between them exist.
    fn look_at_order(&self) -> Result<(), Alarm> {
        let (system, cloud) = (self.system, self.system.cloud());
        let operator = system.operator();
        if system.dimension() != 1 || system.is_linear() {
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
        // Points of different processes are not compared.
        let domain = system.domain();
        if domain.all(passed.is_none()) {
            return Ok(());
        }
        let (point, measure) = match passed {
            Some(point) => (point, 1.0),
            None => (1, f64::NEG_INFINITY),
        };
        let other = cloud.user_number(point - 1) as f64;
        let [other] = domain.of_largest(measure, [other]);
        Err(Alarm {
            cause: InstabilityCause::Passed {
                other: other as usize,
            },
            point,
            measure,
        })
    }

    /// Checks that no contact is so deep that points are about to pass through each other.
    fn look_at_overlap(&self) -> Result<(), Alarm> {
        let overlaps = self.system.interactions().map(|one| one.overlap());
        let overlap = overlaps.fold(0.0, f64::max);
        match overlap > DEEPEST {
            false => Ok(()),
            true => Err(self.alarm(InstabilityCause::Overlapping { overlap })),
        }
    }

    fn look_at_stiffness(&self) -> Result<(), Alarm> {
        if self.system.is_linear() || self.stable_step(1.0).is_none() {
            return Ok(());
        }
        let omega = frequency_from_below(self.system, &self.state.u, APPLICATIONS);
        match self.stiffened(omega) {
            None => Ok(()),
            Some(cause) => {
                let (point, measure) = self.hardest();
                Err(Alarm {
                    cause,
                    point,
                    measure,
                })
            }
        }
    }

    /// Returns the cause if the step is too long for a frequency (1/s) but was not too long for that of the body at
    /// rest; a step too long from the start has another cause.
    fn stiffened(&self, omega: f64) -> Option<InstabilityCause> {
        let (dt, limit) = (self.dt, self.stable_step(omega)?);
        if dt <= SLACK * limit {
            return None;
        }
        let rest = vec![0.0; self.state.u.len()];
        let first = highest_frequency(self.system, &rest).ok()?.estimate;
        (dt <= SLACK * self.stable_step(first)?)
            .then_some(InstabilityCause::Stiffened { dt, limit })
    }

    /// Largest stable step for a frequency, of schemes with one limit for all points.
    fn stable_step(&self, omega: f64) -> Option<f64> {
        let one = self.integrator.refinement().is_none();
        Some(self.integrator.stability_limit().filter(|_| one)? / omega)
    }

    /// Returns the point with the largest elastic energy density, and this density, J/m³.
    fn hardest(&self) -> (usize, f64) {
        let mut energy = vec![0.0; self.system.points()];
        let operator = self.system.operator();
        operator.add_energy_density(self.state.t, &self.state.u, &mut energy);
        let larger = |best, i| if energy[i] > energy[best] { i } else { best };
        let point = (0..energy.len()).fold(0, larger);
        (point, energy.get(point).copied().unwrap_or_default())
    }
}
