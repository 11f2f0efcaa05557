//! The end of a step: the data of a scheme that forces, boundaries and the energy balance use.
//!
//! Velocity Verlet conserves ½ v(t−dt/2)·M v(t+dt/2) + elastic energy for linear forces. A bond that breaks in a step
//! has acted in its first half only, so that it dissipates its energy minus half the work of that step. With both
//! corrections the energy balance of a fracture run has an error of about 1e-6 of the dissipated energy; without them
//! the error would be as large as the starting transient.

use crate::domain::{Domain, Field};

/// The state at the end of an accepted step and the motion within it.
///
/// A scheme passes it to [`System::end_step`](crate::System::end_step). It determines breaking of bonds, the update
/// of boundaries with memory, and the work of loads and constraints; none of these depends on the scheme otherwise.
#[derive(Debug, Clone, Copy)]
pub struct StepEnd<'a> {
    /// Time at the end of the step, s.
    pub t: f64,
    /// Length of the step, s; zero at the start of a run.
    pub dt: f64,
    /// Displacement at the end of the step, m.
    pub u: &'a [f64],
    /// Motion and forces within the step.
    pub path: Path<'a>,
}

/// Motion of the points within a step, and the times at which forces act.
#[derive(Debug, Clone, Copy)]
pub enum Path<'a> {
    /// Motion with the mean velocity (u − u_before)/dt (m/s). The forces at both ends act for half of the step
    /// each: the quadrature of velocity Verlet, for which work and energy balance exactly. A bond that breaks at
    /// the end has acted for half of the step.
    MeanVelocity(&'a [f64]),
    /// Motion along the cubic through displacements and velocities at both ends, with forces acting throughout:
    /// work of fourth order.
    Cubic {
        /// Displacement before the step, m.
        u: &'a [f64],
        /// Velocity before and after the step, m/s.
        v: [&'a [f64]; 2],
    },
    /// Straight motion between two states, with forces that change linearly from one end to the other: the
    /// quadrature of the discrete gradient, and of load steps between static states, in which loads and constraints
    /// change slowly. They do the work of their mean forces, and a bond that breaks at the end has acted for the
    /// whole step.
    ///
    /// The first static state of a run is the unloaded body: in the first load step all loads grow from zero,
    /// whatever their time functions are at t = 0, and constraints move their points from their initial positions.
    Chord {
        /// Displacement at the start of the step, m.
        u: &'a [f64],
        /// True for the first load step of a static run.
        first: bool,
    },
    /// A part of the body at the end of a sub-step in which forces acted throughout. It does not enter the energy
    /// balance.
    SubStep,
}

/// A bond that exceeds its critical stretch at the end of a step.
#[derive(Debug, Clone, Copy)]
pub struct BreakingBond<const D: usize> {
    /// Its ends i and j; ghosts are counted after the own points.
    pub ends: [usize; 2],
    /// Mean velocity of j minus that of i over the step, m/s; see [`StepEnd::relative_velocity`].
    pub velocity: [f64; D],
    /// Vector of its force on i, in units of [`BreakingBond::weight`].
    pub force: [f64; D],
    /// Its elastic energy, in units of [`BreakingBond::weight`].
    pub energy: f64,
    /// Its elastic energy at the critical stretch in the same units, if known.
    pub critical: Option<f64>,
    /// Factor that converts force and energy to newtons and joules.
    pub weight: f64,
}

impl<'a> StepEnd<'a> {
    /// The initial state of a run, as a step of length zero.
    pub fn start(t: f64, u: &'a [f64], v: &'a [f64]) -> Self {
        Self {
            t,
            dt: 0.0,
            u,
            path: Path::MeanVelocity(v),
        }
    }

    /// Returns whether it is the initial state of a run.
    pub fn is_start(&self) -> bool {
        self.dt == 0.0 && matches!(self.path, Path::MeanVelocity(_))
    }

    /// The end of a sub-step of a part of the body in which forces acted throughout.
    pub fn sub_step(t: f64, dt: f64, u: &'a [f64]) -> Self {
        Self {
            t,
            dt,
            u,
            path: Path::SubStep,
        }
    }

    /// Returns the displacement at the start of the step, m; `None` for sub-steps.
    pub fn displacement_before(&self) -> Option<Vec<f64>> {
        match self.path {
            Path::MeanVelocity(mean) => {
                let entries = self.u.iter().zip(mean);
                Some(entries.map(|(u, v)| u - self.dt * v).collect())
            }
            Path::Cubic { u, .. } | Path::Chord { u, .. } => Some(u.to_vec()),
            Path::SubStep => None,
        }
    }

    /// Mean velocity of an entry over the step, m/s; zero for sub-steps.
    pub fn mean_velocity(&self, entry: usize) -> f64 {
        match self.path {
            Path::MeanVelocity(mean) => mean[entry],
            Path::Cubic { u, .. } | Path::Chord { u, .. } if self.dt > 0.0 => {
                (self.u[entry] - u[entry]) / self.dt
            }
            _ => 0.0,
        }
    }

    /// Returns the mean velocities over the step where breaking needs them, that is for [`Path::MeanVelocity`].
    /// `ghosts` are the values of [`StepEnd::ghost_velocities`].
    pub fn velocities(&self, ghosts: &'a [f64]) -> Option<Field<'a>> {
        match self.path {
            Path::MeanVelocity(mean) => Some(Field::new(mean, ghosts)),
            _ => None,
        }
    }

    /// Returns the mean velocities of ghosts over the step, m/s; empty if breaking does not need them. All
    /// processes must call it together.
    pub fn ghost_velocities(&self, domain: &Domain) -> Vec<f64> {
        match self.path {
            Path::MeanVelocity(mean) => domain.ghosts(mean),
            _ => Vec::new(),
        }
    }

    /// Mean velocity of own point j minus that of i over the step, m/s; zero if breaking does not need it.
    pub fn relative_velocity<const D: usize>(&self, ends: [usize; 2]) -> [f64; D] {
        relative_velocity(self.velocities(&[]), ends)
    }

    /// Returns the energy (J) dissipated by a bond that exceeds its critical stretch at the end of the step and
    /// exerts no force afterwards.
    ///
    /// It is the elastic energy at the end of the step minus the work that its force would still have done within
    /// the step: zero if forces act throughout, ½ f·Δη if they act for half of the step at each end. The sum of the
    /// energies of body, loads and dissipation thus does not change when a bond breaks, for every scheme.
    pub fn dissipated<const D: usize>(&self, bond: &BreakingBond<D>) -> f64 {
        let energy = match self.path {
            Path::MeanVelocity(_) => {
                let power: f64 = (0..D).map(|c| bond.force[c] * bond.velocity[c]).sum();
                self.dissipated_energy(bond.energy, power)
            }
            _ => bond.energy,
        };
        bond.weight * energy
    }

    /// Returns the energy (J) dissipated when an elastic energy is released at the end of the step: `energy` at the
    /// end of the step, which grows with `rate` (W) as the points move with their mean velocity.
    ///
    /// It is the energy minus the work that its forces would still have done within the step; see
    /// [`StepEnd::dissipated`].
    pub fn dissipated_energy(&self, energy: f64, rate: f64) -> f64 {
        match self.path {
            Path::MeanVelocity(_) => energy - 0.5 * self.dt * rate,
            _ => energy,
        }
    }

    /// Returns whether the forces at both ends act for half of the step each, so that bonds that break have a state at the
    /// start of the step, from which the points moved with their mean velocity.
    pub fn has_halves(&self) -> bool {
        matches!(self.path, Path::MeanVelocity(_))
    }

    /// Returns the energy (J) dissipated when an elastic energy is released that was `energy` at the start of the step and
    /// grew there with `rate` (W): the energy plus the work that its forces still did in the first half of the step. It equals
    /// [`StepEnd::dissipated_energy`] for linear forces, and holds also for bonds that turn around within the step.
    pub fn dissipated_from_start(&self, energy: f64, rate: f64) -> f64 {
        energy + 0.5 * self.dt * rate
    }

    /// Returns ∫ b dt and ∫ b v dt of a force b with the values `first`, `middle` and `last` at the start, middle
    /// and end of the step, for one entry.
    pub(crate) fn push_and_work(
        &self,
        [first, middle, last]: [f64; 3],
        entry: usize,
    ) -> (f64, f64) {
        let dt = self.dt;
        match self.path {
            Path::MeanVelocity(mean) => {
                let push = 0.5 * dt * (last + first);
                (push, push * mean[entry])
            }
            Path::Chord { u, .. } => {
                let mean = 0.5 * (first + last);
                (dt * mean, mean * (self.u[entry] - u[entry]))
            }
            // The midpoint velocity of the cubic is 3/2 Δu/dt − (v₀ + v₁)/4; insert it into Simpson's rule.
            Path::Cubic { u, v } => (
                dt / 6.0 * (first + 4.0 * middle + last),
                middle * (self.u[entry] - u[entry])
                    + dt / 6.0 * ((first - middle) * v[0][entry] + (last - middle) * v[1][entry]),
            ),
            Path::SubStep => (0.0, 0.0),
        }
    }
}

/// Velocity of end j of a bond minus that of end i, m/s; zero if velocities are not given.
pub(crate) fn relative_velocity<const D: usize>(
    velocities: Option<Field<'_>>,
    ends: [usize; 2],
) -> [f64; D] {
    velocities.map_or([0.0; D], |field| field.difference(ends))
}
