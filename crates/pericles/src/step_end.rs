//! The end of a step: all that forces, boundaries and accounts ask of a scheme.

use crate::domain::{Domain, Field};

/// The state at the end of an accepted step, and how the body got there.
///
/// A scheme hands it to [`System::end_step`](crate::System::end_step). Forces decide breaking by it, boundaries with a memory go on by it, and the work of loads and supports is booked by it; none of them
/// knows the scheme.
#[derive(Debug, Clone, Copy)]
pub struct StepEnd<'a> {
    /// Time at the end, s.
    pub t: f64,
    /// Length of the step, s; zero at the start of a run.
    pub dt: f64,
    /// Displacement at the end, m.
    pub u: &'a [f64],
    /// How the points moved and were pushed within the step.
    pub path: Path<'a>,
}

/// How points went from the start of a step to its end, and when forces acted on them.
#[derive(Debug, Clone, Copy)]
pub enum Path<'a> {
    /// With this mean velocity (m/s), (u − u before)/dt, pushed by the forces at both ends, half of the step by each: the quadrature of velocity Verlet, for which work and energy match exactly. A bond that
    /// breaks at the end has acted for half of the step.
    MeanVelocity(&'a [f64]),
    /// Along the cubic through displacements and velocities at both ends, pushed by forces all the way: work to fourth order.
    Cubic {
        /// Displacement before the step, m.
        u: &'a [f64],
        /// Velocity before and after the step, m/s.
        v: [&'a [f64]; 2],
    },
    /// Straight from one state to the next, pushed all the way by forces that change linearly between their values at both: the quadrature of the discrete gradient, and of load steps between static states, in
    /// which loads and supports change slowly. They do the work of their means, and a bond that breaks at the end has acted for the whole step.
    ///
    /// The first static state of a run is the body without loads: in the first load step all loads grow from
    /// zero, whatever their time functions say at t = 0, and supports move their points from where they are.
    Chord {
        /// Displacement at the state before, m.
        u: &'a [f64],
        /// Whether it is the first load step of a static run.
        first: bool,
    },
    /// A part of the body at the end of a sub-step, over which forces acted all the time. Nothing is booked by it.
    SubStep,
}

/// A bond as it is found over-stretched at the end of a step.
#[derive(Debug, Clone, Copy)]
pub struct BreakingBond<const D: usize> {
    /// Its ends i and j; ghosts are counted behind own points.
    pub ends: [usize; 2],
    /// The mean velocity of j over the step less that of i, m/s; see [`StepEnd::relative_velocity`].
    pub velocity: [f64; D],
    /// The direction of its force on i, in units of [`BreakingBond::weight`].
    pub force: [f64; D],
    /// Its elastic energy, in units of [`BreakingBond::weight`].
    pub energy: f64,
    /// Its elastic energy at the critical stretch, in the same units, where that is known.
    pub critical: Option<f64>,
    /// What turns these into newtons and joules.
    pub weight: f64,
}

impl<'a> StepEnd<'a> {
    /// The initial state of a run, a step of length zero.
    pub fn start(t: f64, u: &'a [f64], v: &'a [f64]) -> Self {
        Self {
            t,
            dt: 0.0,
            u,
            path: Path::MeanVelocity(v),
        }
    }

    /// Whether it is the initial state of a run.
    pub fn is_start(&self) -> bool {
        self.dt == 0.0 && matches!(self.path, Path::MeanVelocity(_))
    }

    /// The end of a sub-step of a part of the body, over which forces acted all the time.
    pub fn sub_step(t: f64, dt: f64, u: &'a [f64]) -> Self {
        Self {
            t,
            dt,
            u,
            path: Path::SubStep,
        }
    }

    /// The displacement at the start of the step, m; none where the path is not known.
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

    /// The mean velocity of an entry over the step, m/s; zero where the path is not known.
    pub fn mean_velocity(&self, entry: usize) -> f64 {
        match self.path {
            Path::MeanVelocity(mean) => mean[entry],
            Path::Cubic { u, .. } | Path::Chord { u, .. } if self.dt > 0.0 => {
                (self.u[entry] - u[entry]) / self.dt
            }
            _ => 0.0,
        }
    }

    /// The mean velocities over the step, where breaking asks for them: on paths that forces at both ends of the step push the body along. `ghosts` are those of [`StepEnd::ghost_velocities`].
    pub fn velocities(&self, ghosts: &'a [f64]) -> Option<Field<'a>> {
        match self.path {
            Path::MeanVelocity(mean) => Some(Field::new(mean, ghosts)),
            _ => None,
        }
    }

    /// The mean velocities of ghosts over the step, m/s; none where breaking does not ask for them. Every process must ask at the same time.
    pub fn ghost_velocities(&self, domain: &Domain) -> Vec<f64> {
        match self.path {
            Path::MeanVelocity(mean) => domain.ghosts(mean),
            _ => Vec::new(),
        }
    }

    /// The mean velocity of own point j less that of i over the step, m/s; zero where breaking does not ask for it.
    pub fn relative_velocity<const D: usize>(&self, ends: [usize; 2]) -> [f64; D] {
        relative_velocity(self.velocities(&[]), ends)
    }

    /// The energy that a bond dissipates which is found over-stretched at the end of the step and exerts no force from then on, J.
    ///
    /// It is what the bond stores at the end less the work that its force would have done within the step and did not do: none where forces acted all the way, ½ f·Δη where they act for half of the step at
    /// each end. So the energy of body, loads and dissipation together does not change when a bond breaks, whatever the scheme.
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

    /// The energy that is dissipated where a part of the elastic energy ends with the step, J: `energy` at the end of the step, which grows with `rate` (W) as the points move with their mean velocity.
    ///
    /// It is the energy less the work that its forces would have done in the part of the step that they no longer act in; see [`StepEnd::dissipated`].
    pub fn dissipated_energy(&self, energy: f64, rate: f64) -> f64 {
        match self.path {
            Path::MeanVelocity(_) => energy - 0.5 * self.dt * rate,
            _ => energy,
        }
    }

    /// ∫ b and ∫ b v of a force b that is `first`, `middle` and `last` at the start, middle and end of the step, on one entry of the arrays.
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
            // The middle velocity of the cubic is 3/2 Δu/dt − (v₀ + v₁)/4, and Simpson's rule becomes what stands here.
            Path::Cubic { u, v } => (
                dt / 6.0 * (first + 4.0 * middle + last),
                middle * (self.u[entry] - u[entry])
                    + dt / 6.0 * ((first - middle) * v[0][entry] + (last - middle) * v[1][entry]),
            ),
            Path::SubStep => (0.0, 0.0),
        }
    }
}

/// The velocity of end j of a bond less that of end i, m/s; zero where velocities are not asked for.
pub(crate) fn relative_velocity<const D: usize>(
    velocities: Option<Field<'_>>,
    ends: [usize; 2],
) -> [f64; D] {
    velocities.map_or([0.0; D], |field| field.difference(ends))
}
