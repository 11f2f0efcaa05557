//! The highest frequency of a body, which limits explicit time steps: a lower estimate and an upper bound.
//!
//! | body | bound | certainty |
//! |---|---|---|
//! | any, at rest | Gershgorin discs ([`Force::frequency_bound`](crate::operator::Force::frequency_bound)) | rigorous |
//! | on a lattice, at rest, more than [`SMALL`] unknowns | plane waves of the infinite lattice (`zone`) | rigorous |
//! | any other | Lanczos polynomial (`lanczos`) | fails with a probability of at most [`FAILURE`] |
//!
//! The lowest bound is used. Bodies of up to [`SMALL`] unknowns are iterated until bound and estimate agree to 0.1
//! %, very small ones to 1e-6; larger bodies to 1 %, or 2 % where the lattice gives the bound.
//!
//! A stable step requires an upper bound: a Ritz value is a lower bound and would accept unstable steps. The plane
//! waves of the infinite lattice bound the frequencies of every part of the lattice whose springs are nowhere
//! stiffer.

mod lanczos;
mod zone;

use self::lanczos::{Lanczos, Problem};
use self::zone::{PlaneWave, zone_maximum};
use crate::error::{PericlesError, Result};
use crate::space::{check_length, check_points};
use crate::system::System;

/// The highest angular frequency of linearised free vibration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HighestFrequency {
    /// Lower estimate, 1/s: the largest Ritz value.
    pub estimate: f64,
    /// Upper bound, 1/s; it fails with [`failure_probability`](Self::failure_probability).
    pub bound: f64,
    /// Probability over random start vectors that the highest frequency exceeds the bound: [`FAILURE`], or zero for
    /// rigorous bounds.
    pub failure_probability: f64,
    /// Whether estimate and bound agree to 2 %.
    pub converged: bool,
    /// Number of operator applications.
    pub applications: usize,
}

/// Largest probability with which the bound by Lanczos iteration is too low. The start vector is the same in every
/// run, so that this is the probability of a body for which the vector is unsuitable.
pub const FAILURE: f64 = 1e-9;
/// Number of unknowns up to which bound and estimate agree to 0.1 %.
pub const SMALL: usize = 10_000;

impl HighestFrequency {
    /// Returns the largest certainly stable step (s) of a scheme with the limit ω dt ≤ `limit`, times a safety
    /// factor; it follows from the upper bound.
    pub fn stable_step(&self, limit: f64, safety: f64) -> f64 {
        safety * limit / self.bound
    }

    /// Returns the step (s) above which a scheme with the limit ω dt ≤ `limit` is certainly unstable; it follows
    /// from the lower estimate. Between [`stable_step`](Self::stable_step) and this step the scheme may be stable
    /// or unstable.
    pub fn unstable_step(&self, limit: f64) -> f64 {
        limit / self.estimate
    }

    /// Returns the frequency of the body together with another vibration of frequency `omega`, 1/s.
    #[must_use]
    pub fn at_least(self, omega: f64) -> Self {
        Self {
            estimate: self.estimate.max(omega),
            bound: self.bound.max(omega),
            ..self
        }
    }

    /// Returns the higher of two frequencies.
    #[must_use]
    pub(super) fn or_higher(self, other: Self) -> Self {
        Self {
            estimate: self.estimate.max(other.estimate),
            bound: self.bound.max(other.bound),
            failure_probability: self.failure_probability.max(other.failure_probability),
            converged: self.converged && other.converged,
            applications: self.applications.max(other.applications),
        }
    }

    /// Returns the frequency divided by `ratio`, for time steps that are `ratio` times smaller.
    pub(super) fn over(self, ratio: f64) -> Self {
        Self {
            estimate: self.estimate / ratio,
            bound: self.bound / ratio,
            ..self
        }
    }
}

/// Relative difference of bound and estimate below which the iteration has converged.
const CONVERGED: f64 = 0.02;
/// Relative difference (in ω) at which the iteration ends and largest number of products, by the number of
/// unknowns.
const EFFORT: [(usize, f64, usize); 3] = [
    (1000, 1e-6, 1500),
    (SMALL, 5e-4, 1500),
    (usize::MAX, 0.01, 400),
];
/// Number of products between computations of the bounds.
const CHECK_EVERY: usize = 10;

/// Computes the highest frequency of M⁻¹K at displacement `u` with the tangent stiffness K.
///
/// # Errors
/// A body without stiffness; a displacement of wrong length.
pub fn highest_frequency(system: &System, u: &[f64]) -> Result<HighestFrequency> {
    check_length(
        "the displacement",
        u.len(),
        system.dimension() * system.points(),
    )?;
    Search::new(system, u, &|vector| system.hold(vector)).run()
}

/// Returns a lower bound of the highest frequency from a number of operator applications; zero if nothing resists
/// motion.
pub fn frequency_from_below(system: &System, u: &[f64], applications: usize) -> f64 {
    Search::new(system, u, &|vector| system.hold(vector)).estimate_by(applications)
}

/// As [`highest_frequency`] with all points fixed except those given (in ascending order).
///
/// # Errors
/// Points without stiffness; points that the body does not have; a displacement of wrong length.
pub fn highest_frequency_on(
    system: &System,
    u: &[f64],
    points: &[u32],
) -> Result<HighestFrequency> {
    check_length(
        "the displacement",
        u.len(),
        system.dimension() * system.points(),
    )?;
    check_points("the free points", points, system.points())?;
    let mut held = vec![true; system.points()];
    points.iter().for_each(|&i| held[i as usize] = false);
    let hold = |vector: &mut [f64]| {
        system.hold(vector);
        for component in vector.chunks_mut(held.len().max(1)) {
            for (entry, held) in component.iter_mut().zip(&held) {
                if *held {
                    *entry = 0.0;
                }
            }
        }
    };
    Search::new(system, u, &hold).run()
}

/// Data of the computation.
struct Search<'a> {
    system: &'a System,
    u: &'a [f64],
    hold: &'a dyn Fn(&mut [f64]),
}

impl<'a> Search<'a> {
    fn new(system: &'a System, u: &'a [f64], hold: &'a dyn Fn(&mut [f64])) -> Self {
        Self { system, u, hold }
    }

    fn density(&self) -> impl Fn(usize) -> f64 + '_ {
        move |i| self.system.density().at(i)
    }

    /// Calls `work` with the matrix M⁻¹K.
    fn with_problem<T>(&self, work: impl FnOnce(Problem<'_>) -> T) -> T {
        let (n, volumes) = (self.system.points(), self.system.cloud().volumes());
        let mass = |entry: usize| volumes[entry % n] * self.system.density().at(entry % n);
        let product = |x: &[f64], y: &mut [f64]| {
            self.system.vibration_into(self.u, x, y);
            (self.hold)(y);
        };
        work(Problem {
            product: &product,
            mass: &mass,
            domain: self.system.domain(),
        })
    }

    fn estimate_by(&self, applications: usize) -> f64 {
        let hold = |vector: &mut [f64]| (self.hold)(vector);
        self.with_problem(|problem| {
            let lanczos = Lanczos::from_noise(problem, self.u.len(), FAILURE, hold);
            let Some(mut lanczos) = lanczos else {
                return 0.0;
            };
            while lanczos.products() < applications && !lanczos.advance() {}
            lanczos.enclosure().estimate.max(0.0).sqrt()
        })
    }

    fn run(&self) -> Result<HighestFrequency> {
        let operator = self.system.operator();
        let domain = self.system.domain();
        // Bounds at rest hold at other displacements only for linear forces.
        let known = self.system.is_linear() || domain.all(self.u.iter().all(|u| *u == 0.0));
        if !known {
            return self.iterate(f64::INFINITY);
        }
        if self.unknowns() > SMALL
            && let Some((bound, wave)) = self.lattice_bound()
        {
            return match self.confirm(bound, &wave) {
                Some(found) => Ok(found),
                None => self.iterate(bound),
            };
        }
        let gershgorin = operator.frequency_bound(&self.density());
        self.iterate(gershgorin * gershgorin * (1.0 + 1e-12))
    }

    /// Number of unknowns of the whole body.
    fn unknowns(&self) -> usize {
        self.system.domain().count(self.u.len() as u64) as usize
    }

    /// Returns the bound of ω² by the plane waves of the infinite lattice, and the wave with the highest frequency.
    fn lattice_bound(&self) -> Option<(f64, PlaneWave)> {
        let springs = self.system.operator().lattice_springs()?;
        let own = (0..self.system.points())
            .map(self.density())
            .fold(f64::INFINITY, f64::min);
        let least = -self.system.domain().max(-own);
        let found = zone_maximum(&springs);
        Some((found.bound / least, found.wave))
    }

    /// Checks with a few products that the body nearly attains the bound of its lattice, using the highest wave
    /// tapered towards the faces; `None` if it does not.
    fn confirm(&self, bound: f64, wave: &PlaneWave) -> Option<HighestFrequency> {
        /// Relative differences (in ω) that are accepted at once, and after [`PRODUCTS`].
        const GOOD: f64 = 0.002;
        const PRODUCTS: usize = 8;
        let mut start = self.faded_wave(wave)?;
        (self.hold)(&mut start);
        self.with_problem(|problem| {
            let mut lanczos = Lanczos::from_vector(problem, start)?;
            loop {
                let exhausted = lanczos.advance();
                let estimate = lanczos.enclosure().estimate;
                let distance = (bound / estimate).sqrt() - 1.0;
                let last = exhausted || lanczos.products() == PRODUCTS;
                if distance <= GOOD || (last && distance <= CONVERGED) {
                    return Some(HighestFrequency {
                        estimate: estimate.sqrt(),
                        bound: bound.max(estimate).sqrt(),
                        failure_probability: 0.0,
                        converged: true,
                        applications: lanczos.products(),
                    });
                }
                if last {
                    return None;
                }
            }
        })
    }

    fn faded_wave(&self, wave: &PlaneWave) -> Option<Vec<f64>> {
        let cloud = self.system.cloud();
        let lattice = cloud.lattice()?;
        let n = cloud.len();
        let mut vector = vec![0.0; self.u.len()];
        for i in 0..n {
            let node = lattice.coordinates(lattice.node[i]).map(f64::from);
            let phase: f64 = (0..3).map(|c| wave.phase[c] * node[c]).sum();
            let fading =
                |c: usize| (std::f64::consts::PI * (node[c] + 0.5) / lattice.shape[c] as f64).sin();
            let amplitude = phase.cos() * (0..3).map(fading).product::<f64>();
            for c in 0..cloud.dimension() {
                vector[c * n + i] = amplitude * wave.polarisation[c];
            }
        }
        Some(vector)
    }

    /// Lanczos iteration from a random vector; `bound` is a known bound of ω², or infinite.
    fn iterate(&self, bound: f64) -> Result<HighestFrequency> {
        let (entries, unknowns) = (self.u.len(), self.unknowns());
        let effort = EFFORT.iter().find(|(most, ..)| unknowns <= *most);
        let &(_, tolerance, most) = effort.unwrap_or(&EFFORT[EFFORT.len() - 1]);
        let hold = |vector: &mut [f64]| (self.hold)(vector);
        self.with_problem(|problem| {
            let mut lanczos = Lanczos::from_noise(problem, entries, FAILURE, hold)
                .ok_or(PericlesError::NoStiffness)?;
            loop {
                let exhausted = lanczos.advance();
                let products = lanczos.products();
                let last = exhausted || products == most;
                if !last && !products.is_multiple_of(CHECK_EVERY) {
                    continue;
                }
                let found = lanczos.enclosure();
                if !(found.estimate > 0.0 && found.estimate.is_finite()) {
                    if last {
                        return Err(PericlesError::NoStiffness);
                    }
                    continue;
                }
                let lowest = bound.min(found.bound).max(found.estimate);
                let distance = (lowest / found.estimate).sqrt() - 1.0;
                if last || distance <= tolerance {
                    return Ok(HighestFrequency {
                        estimate: found.estimate.sqrt(),
                        bound: lowest.sqrt(),
                        failure_probability: if found.bound < bound { FAILURE } else { 0.0 },
                        converged: distance <= CONVERGED,
                        applications: products,
                    });
                }
            }
        })
    }
}
