//! Load steps: static states along a linear path of loads and supports, and the work done.
//!
//! Rigid bodies in contact are at their positions of intermediate times, and their work is integrated like that of
//! the loads.

use pericles::{Interrupt, PericlesError, Result, System};

use crate::control::Control;
use crate::equilibrium::{
    ControlledTarget, Effort, Equilibrium, Target, add_internal, is_interrupt, is_linear,
};
use crate::error::StaticsError;
use crate::reference::Reference;

/// Loads and supports along a load step.
pub enum Loading<'a> {
    /// Given at both ends and interpolated linearly in between.
    Prescribed {
        /// Loads before and after, N/m³.
        loads: [&'a [f64]; 2],
        /// Displacements before and after, m; only constrained entries are used.
        supports: [&'a [f64]; 2],
    },
    /// Multiples of their values at a reference time, with the factors at which a quantity has its values.
    Controlled {
        /// Loads and supports at the reference time.
        reference: &'a Reference,
        /// The quantity.
        control: &'a Control,
        /// Its values before and after, interpolated linearly in between, m.
        values: [f64; 2],
    },
}

/// A load step.
pub struct LoadStep<'a> {
    /// Time at the end, s.
    pub t: f64,
    /// Time at the start (s), from which rigid bodies in contact move to their positions at the end.
    pub start: f64,
    /// Loads and supports.
    pub loading: Loading<'a>,
    /// Largest norm of loads or reactions before, N.
    pub largest: f64,
    /// Tolerance of the residual of prescribed states.
    pub tolerance: f64,
}

impl LoadStep<'_> {
    /// Returns whether loads and supports do not change, so that a part of the step is the same problem.
    fn is_jump(&self) -> bool {
        let same = |[a, b]: [&[f64]; 2]| std::ptr::eq(a, b);
        match self.loading {
            Loading::Prescribed { loads, supports } => same(loads) && same(supports),
            Loading::Controlled { values: [a, b], .. } => a == b,
        }
    }

    /// Returns the shortest part, as a fraction of the step. Under control it is larger, because a body without a static
    /// path fails at the value at the end of the step.
    fn shortest_part(&self) -> f64 {
        match self.loading {
            Loading::Prescribed { .. } => 1.0 / 1024.0,
            Loading::Controlled { .. } => 1.0 / 4.0,
        }
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
    /// Factor of the reference loads; 1 for prescribed loads.
    factor: f64,
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
    /// Advances `u` from the start of the load step to its end, and the factor of the loads if it is controlled. The step is
    /// divided if the iteration does not converge.
    ///
    /// # Errors
    /// No static state for the shortest part of the step; interruption.
    pub fn follow(
        &mut self,
        u: &mut Vec<f64>,
        factor: &mut f64,
        with_work: bool,
    ) -> Result<Followed> {
        let mut followed = Followed::default();
        let mut here = self.station(0.0, std::mem::take(u), *factor);
        let end = self.advance(&mut here, &mut followed, with_work);
        *u = here.u;
        *factor = here.factor;
        end.map_err(|error| at_fraction(error, here.s))?;
        Ok(followed)
    }

    /// Advances a station to the end of the load step, or to the last static state before an error.
    fn advance(
        &mut self,
        here: &mut Station,
        followed: &mut Followed,
        with_work: bool,
    ) -> Result<()> {
        let mut length: f64 = 1.0;
        while here.s < 1.0 {
            let s = (here.s + length).min(1.0);
            match self.find(s, (here.u.clone(), here.factor)) {
                Ok((there, effort)) => {
                    followed.effort.add(effort);
                    followed.parts += 1;
                    self.step.largest = self.step.largest.max(effort.acting);
                    let work = self.work(here, &there, with_work, 0, &mut followed.effort);
                    *here = there;
                    followed.work += work?;
                    length = (2.0 * length).min(1.0 - here.s);
                }
                Err(error) => {
                    length *= 0.5;
                    if is_interrupt(&error)
                        || self.step.is_jump()
                        || length < self.step.shortest_part()
                    {
                        return Err(error);
                    }
                }
            }
        }
        Ok(())
    }

    /// Returns the static state at a fraction of the step, from a state and a factor nearby.
    fn find(&mut self, s: f64, (mut u, mut factor): (Vec<f64>, f64)) -> Result<(Station, Effort)> {
        let effort = match &self.step.loading {
            Loading::Prescribed { loads, supports } => {
                let (load, supports) = (mix(*loads, s), mix(*supports, s));
                let target = Target {
                    t: self.step.t,
                    place: self.step.time_at(s),
                    load: &load,
                    supports: &supports,
                    largest: self.step.largest,
                    tolerance: self.step.tolerance,
                };
                (self.equilibrium).find(self.system, &target, &mut u, self.interrupt)?
            }
            Loading::Controlled {
                reference,
                control,
                values: [before, after],
            } => {
                let target = ControlledTarget {
                    t: self.step.t,
                    reference,
                    control,
                    value: before + s * (after - before),
                    largest: self.step.largest,
                };
                let found = (&mut u[..], &mut factor);
                (self.equilibrium).find_controlled(self.system, &target, found, self.interrupt)?
            }
        };
        Ok((self.station(s, u, factor), effort))
    }

    fn station(&self, s: f64, u: Vec<f64>, factor: f64) -> Station {
        let (system, n) = (self.system, self.system.points());
        let mut acting = vec![0.0; u.len()];
        let times = [self.step.t, self.step.time_at(s)];
        add_internal(system, times, &u, &mut acting);
        let load = |k: usize| match &self.step.loading {
            Loading::Prescribed {
                loads: [before, after],
                ..
            } => (1.0 - s) * before[k] + s * after[k],
            Loading::Controlled { reference, .. } => factor * reference.load[k],
        };
        let free = self.equilibrium.free();
        let volumes = system.cloud().volumes();
        for k in 0..u.len() {
            let density = if free[k] != 0.0 { load(k) } else { -acting[k] };
            acting[k] = volumes[k % n] * density;
        }
        Station {
            s,
            u,
            factor,
            acting,
        }
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
        if !with_work || is_linear(self.system) || self.is_idle(a, b) {
            return Ok(whole);
        }
        let s = 0.5 * (a.s + b.s);
        let u = a.u.iter().zip(&b.u).map(|(a, b)| 0.5 * (a + b)).collect();
        let middle = match self.find(s, (u, 0.5 * (a.factor + b.factor))) {
            Ok((middle, found)) => {
                effort.add(Effort {
                    residual: effort.residual,
                    ..found
                });
                middle
            }
            Err(error) if is_interrupt(&error) => return Err(error),
            // The body jumps from one state to the other, without intermediate static states.
            Err(_) => return Ok(whole),
        };
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

    /// Returns whether no load and no support does work between two stations, as in a body that changes its temperature only.
    fn is_idle(&self, a: &Station, b: &Station) -> bool {
        let works = |k: usize| (a.acting[k] != 0.0 || b.acting[k] != 0.0) && a.u[k] != b.u[k];
        let any = self.system.has_interactions() || (0..a.u.len()).any(works);
        self.system.domain().all(!any)
    }

    fn trapezoid(&self, a: &Station, b: &Station) -> f64 {
        let term = |k: usize| 0.5 * (a.acting[k] + b.acting[k]) * (b.u[k] - a.u[k]);
        let [from, to] = [a, b].map(|station| (self.step.time_at(station.s), &station.u[..]));
        self.system.domain().sum(a.u.len(), term) + self.system.contact_work(from, to)
    }
}

/// Returns the value at a fraction of a linear path.
fn mix([a, b]: [&[f64]; 2], s: f64) -> Vec<f64> {
    if s == 1.0 {
        return b.to_vec();
    }
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (1.0 - s) * a + s * b).collect()
}

/// Adds the fraction of the load step up to which static states were found to an error.
fn at_fraction(error: PericlesError, s: f64) -> PericlesError {
    let PericlesError::Extension(inner) = error else {
        return error;
    };
    match inner.downcast::<StaticsError>() {
        Ok(mut found) => {
            if let StaticsError::NoEquilibrium { fraction, .. }
            | StaticsError::NotControlled { fraction, .. } = &mut *found
            {
                *fraction = s;
            }
            PericlesError::Extension(found)
        }
        Err(inner) => PericlesError::Extension(inner),
    }
}
