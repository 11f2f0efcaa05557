//! A load step: static states along a straight path of loads and supports, and the work done on it.

use pericles::operator::On;
use pericles::{Interrupt, Result, System};

use crate::equilibrium::{Effort, Equilibrium, Target, is_interrupt};
use crate::error::StaticsError;

/// Loads and supports at both ends of a load step; in between they are interpolated linearly.
pub struct LoadStep<'a> {
    /// Time at the end, s.
    pub t: f64,
    /// Loads before and after, N/m³.
    pub loads: [&'a [f64]; 2],
    /// Displacements before and after, m; the entries that supports hold count.
    pub supports: [&'a [f64]; 2],
    /// The largest norm of loads or reactions before, N.
    pub largest: f64,
}

/// A static state on the way.
struct Station {
    /// Part of the load step, 0 … 1.
    s: f64,
    u: Vec<f64>,
    /// What acts on each entry from outside, N: loads on free entries, reactions and loads on held ones.
    acting: Vec<f64>,
}

/// What a load step took and did.
#[derive(Debug, Clone, Copy, Default)]
pub struct Followed {
    /// Of all static states.
    pub effort: Effort,
    /// Work of loads and supports, J.
    pub work: f64,
    /// Parts that the step was cut to.
    pub parts: u32,
}

/// The shortest part of a load step.
const SHORTEST: f64 = 1.0 / 1024.0;
/// Work is integrated until its estimated error is below this part of it.
const WORK_TOLERANCE: f64 = 1e-8;
/// Halvings of a part of a load step for the integral of the work.
const DEPTH: u32 = 3;

/// Follows a load step with the bonds as they are.
pub struct Follower<'a, 'i> {
    /// The body.
    pub system: &'a System,
    /// The solver.
    pub equilibrium: &'a mut Equilibrium,
    /// The load step.
    pub step: LoadStep<'a>,
    /// Polled on the way.
    pub interrupt: Interrupt<'i>,
    /// Work exchanged before, J: the work of a step that is small beside it need not be accurate by itself.
    pub exchanged: f64,
}

impl Follower<'_, '_> {
    /// Moves `u` from the start of the load step to its end. The step is cut where Newton's method does not converge.
    ///
    /// # Errors
    /// If no part of the step, however short, leads to a static state; if it is interrupted.
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
                    followed.work +=
                        self.work(&here, &there, with_work, 0, &mut followed.effort)?;
                    here = there;
                    length = (2.0 * length).min(1.0 - here.s);
                }
                Err(error) => {
                    length *= 0.5;
                    if is_interrupt(&error) || length < SHORTEST {
                        *u = here.u;
                        return Err(at_fraction(error, here.s));
                    }
                }
            }
        }
        *u = here.u;
        Ok(followed)
    }

    /// Moves `u` to the static state at a part of the step.
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
        let operator = system.operator();
        operator.add_force(self.step.t, &u, On::All, &mut acting);
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

    /// The work between two stations, by the trapezoidal rule and, for forces that are not linear, by Simpson's rule on as many halves as needed.
    fn work(
        &mut self,
        a: &Station,
        b: &Station,
        with_work: bool,
        depth: u32,
        effort: &mut Effort,
    ) -> Result<f64> {
        let whole = self.trapezoid(a, b);
        if !with_work || self.system.operator().as_linear().is_some() {
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
            // The body jumps from one state to the other: there is none in between.
            Err(_) => return Ok(whole),
        }
        let middle = self.station(s, u);
        let halves = self.trapezoid(a, &middle) + self.trapezoid(&middle, b);
        let correction = (halves - whole) / 3.0;
        let scale = halves.abs().max(self.exchanged);
        // The error of Simpson's rule is of the order of the square of that of the trapezoidal rule.
        let error = (4.0 * correction / scale).powi(2);
        if scale == 0.0 || error <= WORK_TOLERANCE || depth == DEPTH {
            return Ok(halves + correction);
        }
        let first = self.work(a, &middle, with_work, depth + 1, effort)?;
        Ok(first + self.work(&middle, b, with_work, depth + 1, effort)?)
    }

    fn trapezoid(&self, a: &Station, b: &Station) -> f64 {
        let term = |k: usize| 0.5 * (a.acting[k] + b.acting[k]) * (b.u[k] - a.u[k]);
        self.system.domain().sum(a.u.len(), term)
    }
}

/// The error with the part of the load step up to which static states were found.
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
