//! Load steps: static states along a linear path of loads and supports, and the work done.
//!
//! Rigid bodies in contact are at their positions of intermediate times, and their work is integrated like that of
//! the loads.

use pericles::{Interrupt, Result, System};

use crate::equilibrium::{Effort, Equilibrium, Target, add_internal, is_interrupt, is_linear};
use crate::error::StaticsError;

/// Loads and supports at both ends of a load step, interpolated linearly in between.
pub struct LoadStep<'a> {
    /// Time at the end, s.
    pub t: f64,
    /// Time at the start (s), from which rigid bodies in contact move to their positions at the end.
    pub start: f64,
    /// Loads before and after, N/m³.
    pub loads: [&'a [f64]; 2],
    /// Displacements before and after, m; only constrained entries are used.
    pub supports: [&'a [f64]; 2],
    /// Largest norm of loads or reactions before, N.
    pub largest: f64,
}

impl LoadStep<'_> {
    /// Returns whether loads and supports do not change, so that a part of the step is the same problem.
    fn is_jump(&self) -> bool {
        let same = |[a, b]: [&[f64]; 2]| std::ptr::eq(a, b);
        same(self.loads) && same(self.supports)
    }

    /// Returns the time at a fraction of the step.
    fn time_at(&self, s: f64) -> f64 {
        if s == 1.0 {
            return self.t;
        }
        self.start + s * (self.t - self.start)
    }
}

/// A static state on the path.
struct Station {
    /// Fraction of the load step, 0 … 1.
    s: f64,
    u: Vec<f64>,
    /// External force on each entry, N: loads on free entries, reactions and loads on constrained entries.
    acting: Vec<f64>,
}

/// Result of a load step.
#[derive(Debug, Clone, Copy, Default)]
pub struct Followed {
    /// Effort of all static states.
    pub effort: Effort,
    /// Work of loads and supports, J.
    pub work: f64,
    /// Number of parts into which the step was divided.
    pub parts: u32,
}

/// Shortest part of a load step, as a fraction of it.
const SHORTEST: f64 = 1.0 / 1024.0;
/// Relative tolerance of the estimated error of the work.
const WORK_TOLERANCE: f64 = 1e-8;
/// Largest number of halvings of a part of a load step for the integral of the work.
const DEPTH: u32 = 3;

/// Follows a load step with fixed bonds.
pub struct Follower<'a, 'i> {
    /// The body.
    pub system: &'a System,
    /// The solver.
    pub equilibrium: &'a mut Equilibrium,
    /// The load step.
    pub step: LoadStep<'a>,
    /// Interrupt, queried by the iterations.
    pub interrupt: Interrupt<'i>,
    /// Work exchanged before, J; the work of a step that is small relative to it may be less accurate.
    pub exchanged: f64,
}

impl Follower<'_, '_> {
    /// Advances `u` from the start of the load step to its end. The step is divided if Newton's method does
    /// not converge.
    ///
    /// # Errors
    /// No static state for the shortest part of the step; interruption.
    pub fn follow(&mut self, u: &mut Vec<f64>, with_work: bool) -> Result<Followed> {
        let mut followed = Followed::default();
        let mut here = self.station(0.0, std::mem::take(u));
        let mut length: f64 = 1.0;
        while here.s < 1.0 {
            let s = (here.s + length).min(1.0);
            let mut next = here.u.clone();
            match self.find(s, &mut next) {
                Ok(effort) => {
                    followed.effort.add(effort);
                    followed.parts += 1;
                    self.step.largest = self.step.largest.max(effort.acting);
                    let there = self.station(s, next);
                    let work = self.work(&here, &there, with_work, 0, &mut followed.effort);
                    here = there;
                    match work {
                        Ok(work) => followed.work += work,
                        Err(error) => {
                            *u = here.u;
                            return Err(error);
                        }
                    }
                    length = (2.0 * length).min(1.0 - here.s);
                }
                Err(error) => {
                    length *= 0.5;
                    if is_interrupt(&error) || self.step.is_jump() || length < SHORTEST {
                        *u = here.u;
                        return Err(at_fraction(error, here.s));
                    }
                }
            }
        }
        *u = here.u;
        Ok(followed)
    }

    /// Advances `u` to the static state at a fraction of the step.
    fn find(&mut self, s: f64, u: &mut [f64]) -> Result<Effort> {
        let mix = |[a, b]: [&[f64]; 2]| -> Vec<f64> {
            if s == 1.0 {
                return b.to_vec();
            }
            let pairs = a.iter().zip(b);
            pairs.map(|(a, b)| (1.0 - s) * a + s * b).collect()
        };
        let (load, supports) = (mix(self.step.loads), mix(self.step.supports));
        let target = Target {
            t: self.step.t,
            place: self.step.time_at(s),
            load: &load,
            supports: &supports,
            largest: self.step.largest,
        };
        self.equilibrium
            .find(self.system, &target, u, self.interrupt)
    }

    fn station(&self, s: f64, u: Vec<f64>) -> Station {
        let (system, n) = (self.system, self.system.points());
        let mut acting = vec![0.0; u.len()];
        let times = [self.step.t, self.step.time_at(s)];
        add_internal(system, times, &u, &mut acting);
        let [before, after] = self.step.loads;
        let free = self.equilibrium.free();
        let volumes = system.cloud().volumes();
        for k in 0..u.len() {
            let density = if free[k] != 0.0 {
                (1.0 - s) * before[k] + s * after[k]
            } else {
                -acting[k]
            };
            acting[k] = volumes[k % n] * density;
        }
        Station { s, u, acting }
    }

    /// Returns the work between two stations by the trapezoidal rule; for nonlinear forces by Simpson's rule
    /// with adaptive halving.
    fn work(
        &mut self,
        a: &Station,
        b: &Station,
        with_work: bool,
        depth: u32,
        effort: &mut Effort,
    ) -> Result<f64> {
        let whole = self.trapezoid(a, b);
        if !with_work || is_linear(self.system) {
            return Ok(whole);
        }
        let s = 0.5 * (a.s + b.s);
        let mut u: Vec<f64> = a.u.iter().zip(&b.u).map(|(a, b)| 0.5 * (a + b)).collect();
        match self.find(s, &mut u) {
            Ok(found) => effort.add(Effort {
                residual: effort.residual,
                ..found
            }),
            Err(error) if is_interrupt(&error) => return Err(error),
            // The body jumps from one state to the other, without intermediate static states.
            Err(_) => return Ok(whole),
        }
        let middle = self.station(s, u);
        let halves = self.trapezoid(a, &middle) + self.trapezoid(&middle, b);
        let correction = (halves - whole) / 3.0;
        let scale = halves.abs().max(self.exchanged);
        // The error of Simpson's rule is of the order of the squared error of the trapezoidal rule.
        let error = (4.0 * correction / scale).powi(2);
        if scale == 0.0 || error <= WORK_TOLERANCE || depth == DEPTH {
            return Ok(halves + correction);
        }
        let first = self.work(a, &middle, with_work, depth + 1, effort)?;
        Ok(first + self.work(&middle, b, with_work, depth + 1, effort)?)
    }

    fn trapezoid(&self, a: &Station, b: &Station) -> f64 {
        let term = |k: usize| 0.5 * (a.acting[k] + b.acting[k]) * (b.u[k] - a.u[k]);
        let [from, to] = [a, b].map(|station| (self.step.time_at(station.s), &station.u[..]));
        self.system.domain().sum(a.u.len(), term) + self.system.contact_work(from, to)
    }
}

/// Adds the fraction of the load step up to which static states were found to an error.
fn at_fraction(error: pericles::PericlesError, s: f64) -> pericles::PericlesError {
    let pericles::PericlesError::Extension(inner) = error else {
        return error;
    };
    match inner.downcast::<StaticsError>() {
        Ok(found) => match *found {
            StaticsError::NoEquilibrium {
                t,
                residual,
                tolerance,
                indefinite,
                ..
            } => StaticsError::NoEquilibrium {
                t,
                fraction: s,
                residual,
                tolerance,
                indefinite,
            }
            .into(),
            other => other.into(),
        },
        Err(inner) => pericles::PericlesError::Extension(inner),
    }
}
