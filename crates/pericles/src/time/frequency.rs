//! The highest frequency of a body, which limits explicit time steps.

use crate::error::{PericlesError, Result};
use crate::noise::noise;
use crate::parallel::ordered_sum;
use crate::system::System;

/// The highest angular frequency of the linearised free vibration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HighestFrequency {
    /// Estimate from below, 1/s: the largest Ritz value.
    pub estimate: f64,
    /// Whether the estimate can be relied on: its residual is below 0.1 %, or it rests after so many applications that it is expected to be within 1 %.
    pub converged: bool,
    /// A bound that is never exceeded at rest, 1/s (Gershgorin).
    pub bound: f64,
    /// Operator applications used.
    pub applications: usize,
}

impl HighestFrequency {
    /// The largest stable step of a scheme with the limit ω dt ≤ `limit`, with a safety factor: from the estimate if it converged, else from the
    /// bound.
    pub fn stable_step(&self, limit: f64, safety: f64) -> f64 {
        safety * limit
            / if self.converged {
                self.estimate
            } else {
                self.bound
            }
    }

    /// The same where something else swings as fast as `omega`, 1/s.
    #[must_use]
    pub fn at_least(self, omega: f64) -> Self {
        Self {
            estimate: self.estimate.max(omega),
            bound: self.bound.max(omega),
            ..self
        }
    }

    /// The same for time steps that are `ratio` times smaller.
    pub(super) fn over(self, ratio: f64) -> Self {
        Self {
            estimate: self.estimate / ratio,
            bound: self.bound / ratio,
            ..self
        }
    }
}

/// Relative residual at which the largest Ritz value counts as converged; the value's own error is smaller still.
const TOLERANCE: f64 = 1e-3;
const MOST_APPLICATIONS: usize = 300;
const CHECK_EVERY: usize = 10;
/// Applications from which on a value that rests is taken. The upper end of the spectrum of a large body is dense: the value is found long before its vector. From a random start
/// its relative error (that of ω²) is expected to be at most 0.103 (ln(n (k − 1)⁴)/(k − 1))² after k applications to n unknowns, whatever the spectrum (Kuczyński & Woźniakowski 1992): 0.6 %
/// in ω for a million points; measured ones are a tenth of that.
const ENOUGH: usize = 100;
/// Relative growth between checks below which a value rests.
const AT_REST: f64 = 1e-4;

/// Lanczos iteration on M⁻¹K at displacement `u`, in the inner product of the masses, from a fixed start vector.
///
/// # Errors
/// A body without any stiffness.
pub fn highest_frequency(system: &System, u: &[f64]) -> Result<HighestFrequency> {
    iterate(system, u, MOST_APPLICATIONS, &|vector| system.hold(vector))
}

/// A frequency that the highest one is not below, by so many applications of the operator; zero where nothing resists motion.
pub fn frequency_from_below(system: &System, u: &[f64], applications: usize) -> f64 {
    let found = iterate(system, u, applications, &|vector| system.hold(vector));
    found.map_or(0.0, |frequency| frequency.estimate)
}

/// The same with all points held but those given, ascending.
///
/// # Errors
/// Points without any stiffness.
pub fn highest_frequency_on(
    system: &System,
    u: &[f64],
    points: &[u32],
) -> Result<HighestFrequency> {
    let mut held = vec![true; system.points()];
    points.iter().for_each(|&i| held[i as usize] = false);
    iterate(system, u, MOST_APPLICATIONS, &|vector| {
        system.hold(vector);
        for component in vector.chunks_mut(held.len()) {
            for (entry, held) in component.iter_mut().zip(&held) {
                if *held {
                    *entry = 0.0;
                }
            }
        }
    })
}

fn iterate(
    system: &System,
    u: &[f64],
    most: usize,
    hold: &dyn Fn(&mut [f64]),
) -> Result<HighestFrequency> {
    let density = |i: usize| system.density().at(i);
    let bound = system.operator().frequency_bound(&density);
    let n = system.points();
    let mass = |entry: usize| system.cloud().volumes()[entry % n] * density(entry % n);
    let inner = |x: &[f64], y: &[f64]| ordered_sum(x.len(), |k| mass(k) * x[k] * y[k]);

    let mut current = noise(u.len(), 0x9E37_79B9_7F4A_7C15);
    hold(&mut current);
    let norm = inner(&current, &current).sqrt();
    if norm == 0.0 {
        return Err(PericlesError::NoStiffness);
    }
    scale(&mut current, 1.0 / norm);
    let mut previous = vec![0.0; u.len()];
    let mut next = vec![0.0; u.len()];
    let (mut diagonal, mut off) = (Vec::new(), Vec::<f64>::new());
    let mut estimate = 0.0;
    let mut converged = false;
    while diagonal.len() < most && !converged {
        system.vibration_into(u, &current, &mut next);
        hold(&mut next);
        let alpha = inner(&next, &current);
        let before = off.last().copied().unwrap_or(0.0);
        for k in 0..next.len() {
            next[k] -= alpha * current[k] + before * previous[k];
        }
        let beta = inner(&next, &next).sqrt();
        diagonal.push(alpha);
        let exhausted = beta <= 1e-12 * (alpha.abs() + before);
        if exhausted || diagonal.len() % CHECK_EVERY == 0 || diagonal.len() == most {
            let (value, last) = largest_eigenpair(&diagonal, &off);
            let rests = diagonal.len() >= ENOUGH && value - estimate <= AT_REST * value;
            estimate = value;
            converged = exhausted || rests || beta * last.abs() <= TOLERANCE * value;
        }
        if exhausted {
            break;
        }
        off.push(beta);
        scale(&mut next, 1.0 / beta);
        std::mem::swap(&mut previous, &mut current);
        std::mem::swap(&mut current, &mut next);
    }
    if !(estimate > 0.0 && estimate.is_finite()) {
        return Err(PericlesError::NoStiffness);
    }
    Ok(HighestFrequency {
        estimate: estimate.sqrt(),
        converged,
        // Forces without stiffness at rest can have one elsewhere.
        bound: bound.max(estimate.sqrt()),
        applications: diagonal.len(),
    })
}

fn scale(x: &mut [f64], factor: f64) {
    x.iter_mut().for_each(|x| *x *= factor);
}

/// The largest eigenvalue of a symmetric tridiagonal matrix, by bisection, and the last entry of its unit eigenvector, by inverse iteration.
fn largest_eigenpair(diagonal: &[f64], off: &[f64]) -> (f64, f64) {
    let n = diagonal.len();
    let coupling = |k: usize| off.get(k).copied().unwrap_or(0.0);
    let radius = |k: usize| {
        let before = if k > 0 { coupling(k - 1).abs() } else { 0.0 };
        let after = if k + 1 < n { coupling(k).abs() } else { 0.0 };
        before + after
    };
    let mut high = (0..n).fold(f64::NEG_INFINITY, |m, k| m.max(diagonal[k] + radius(k)));
    let mut low = (0..n).fold(f64::NEG_INFINITY, |m, k| m.max(diagonal[k]));
    // Sturm: all pivots of T − x are negative exactly if x lies above every eigenvalue.
    let above = |x: f64| {
        let mut pivot = diagonal[0] - x;
        for k in 1..n {
            if pivot >= 0.0 {
                return false;
            }
            pivot = diagonal[k] - x - coupling(k - 1).powi(2) / pivot;
        }
        pivot < 0.0
    };
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if above(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    let value = high;
    let mut vector = vec![1.0; n];
    for _ in 0..3 {
        solve_shifted(diagonal, off, value * (1.0 + 1e-14), &mut vector);
        let norm = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
        vector.iter_mut().for_each(|x| *x /= norm);
    }
    (value, vector[n - 1])
}

/// Solves (T − x) y = y in place; x above the spectrum, so that no pivoting is needed.
fn solve_shifted(diagonal: &[f64], off: &[f64], x: f64, y: &mut [f64]) {
    let n = diagonal.len();
    let tiny = f64::EPSILON * x.abs().max(f64::MIN_POSITIVE);
    let mut pivots = vec![0.0; n];
    pivots[0] = (diagonal[0] - x).min(-tiny);
    for k in 1..n {
        let factor = off[k - 1] / pivots[k - 1];
        pivots[k] = (diagonal[k] - x - factor * off[k - 1]).min(-tiny);
        y[k] -= factor * y[k - 1];
    }
    y[n - 1] /= pivots[n - 1];
    for k in (0..n - 1).rev() {
        y[k] = (y[k] - off[k] * y[k + 1]) / pivots[k];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tridiagonal_matrix_of_a_string() {
        // 2 on the diagonal, −1 beside it: eigenvalues 2 − 2 cos(kπ/(n+1)).
        let n = 40;
        let (value, last) = largest_eigenpair(&vec![2.0; n], &vec![-1.0; n - 1]);
        let angle = std::f64::consts::PI / (n + 1) as f64;
        let exact = 2.0 + 2.0 * angle.cos();
        assert!((value - exact).abs() < 1e-13);
        let entry = (2.0 / (n + 1) as f64).sqrt() * (n as f64 * angle * n as f64).sin();
        assert!((last.abs() - entry.abs()).abs() < 1e-6, "{last} {entry}");
    }
}
