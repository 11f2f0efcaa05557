//! Conjugate gradients with a preconditioner, on the free entries of a body.

use pericles::domain::Domain;
use pericles::{Interrupt, Result};

use crate::chunks::for_each_chunk;
use crate::sparse::add_multiple;

/// A linear problem A d = r on the free entries of vectors that also have held entries.
///
/// Products give all rows: those of held entries are the change of the reactions, so that the accuracy asked for can be measured by the reactions of the solution itself.
pub trait LinearProblem {
    /// `out` = A x on all entries, for an x that is zero on held ones.
    fn multiply_into(&mut self, x: &[f64], out: &mut [f64]);

    /// `out` = an approximation of A⁻¹ r on free entries, zero on held ones.
    fn precondition_into(&mut self, residual: &[f64], out: &mut [f64]);
}

/// Why conjugate gradients ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The residual meets the tolerance.
    Reached,
    /// Too many products.
    Exhausted,
    /// A direction without positive curvature was met: the tangent is not positive definite (Steihaug 1983).
    Indefinite,
}

/// What conjugate gradients did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution {
    /// Products with the matrix.
    pub products: u64,
    /// Norm of the last residual on free entries.
    pub residual: f64,
    /// Why they ended.
    pub end: End,
}

/// Vectors of conjugate gradients, made once.
#[derive(Debug, Clone)]
pub struct KrylovWork {
    direction: Vec<f64>,
    product: Vec<f64>,
    preconditioned: Vec<f64>,
}

impl KrylovWork {
    /// For vectors with so many entries.
    pub fn new(entries: usize) -> Self {
        let zeros = || vec![0.0; entries];
        Self {
            direction: zeros(),
            product: zeros(),
            preconditioned: zeros(),
        }
    }
}

/// When conjugate gradients are to end.
pub struct Goal<'a> {
    /// The residual's norm is at most this …
    pub absolute: f64,
    /// … or at most this part of `acting` and of the norm of the held entries of the residual, which are the reactions.
    pub relative: f64,
    /// Norm of the loads, or the largest reaction known.
    pub acting: f64,
    /// The most products.
    pub products: u64,
    /// Polled before every product.
    pub interrupt: Interrupt<'a>,
}

/// Solves A d = r from d = 0. `residual` holds r on free entries and minus the reactions at d = 0 on held ones, and both at the solution in the end. `free` is 1 on free entries and 0 on held ones.
///
/// # Errors
/// If it is interrupted.
pub fn conjugate_gradients(
    problem: &mut dyn LinearProblem,
    (domain, free): (&Domain, &[f64]),
    residual: &mut [f64],
    solution: &mut [f64],
    goal: &Goal<'_>,
    work: &mut KrylovWork,
) -> Result<Solution> {
    let KrylovWork {
        direction,
        product,
        preconditioned,
    } = work;
    let n = residual.len();
    solution.fill(0.0);
    let mut products = 0;
    let mut along = 0.0;
    loop {
        let norm = domain
            .sum(n, |k| free[k] * residual[k] * residual[k])
            .sqrt();
        let reactions = || domain.sum(n, |k| (1.0 - free[k]) * residual[k] * residual[k]);
        let ended = |end| Solution {
            products,
            residual: norm,
            end,
        };
        if norm <= goal.absolute
            || norm <= goal.relative * goal.acting
            || norm <= goal.relative * reactions().sqrt()
        {
            return Ok(ended(End::Reached));
        }
        if products == goal.products || !norm.is_finite() {
            return Ok(ended(End::Exhausted));
        }
        goal.interrupt.poll()?;
        problem.precondition_into(residual, preconditioned);
        let next = domain.dot(residual, preconditioned);
        if products == 0 {
            direction.copy_from_slice(preconditioned);
        } else {
            let ratio = next / along;
            add_to_multiple(direction, ratio, preconditioned);
        }
        along = next;
        problem.multiply_into(direction, product);
        products += 1;
        let curvature = domain.dot(direction, product);
        if curvature.is_nan() || curvature <= 0.0 {
            if products == 1 {
                // Nothing better is known than the preconditioned residual.
                solution.copy_from_slice(direction);
            }
            return Ok(Solution {
                products,
                residual: norm,
                end: End::Indefinite,
            });
        }
        let length = along / curvature;
        add_multiple(solution, length, direction);
        add_multiple(residual, -length, product);
    }
}

/// y = x + factor y
fn add_to_multiple(y: &mut [f64], factor: f64, x: &[f64]) {
    for_each_chunk(y, &|first, chunk| {
        let length = chunk.len();
        for (y, x) in chunk.iter_mut().zip(&x[first..first + length]) {
            *y = x + factor * *y;
        }
    });
}
