//! Preconditioned conjugate gradients on the free entries of a body.

use pericles::domain::Domain;
use pericles::parallel::for_each_chunk;
use pericles::{Interrupt, Result};

use crate::sparse::add_multiple;

/// Linear problem A d = r on the free entries of vectors that also have constrained entries.
///
/// Products include all rows. Rows of constrained entries are the change of the reactions, so that the
/// required accuracy can be relative to the reactions of the solution.
pub trait LinearProblem {
    /// Computes `out` = A x on all entries, for an x that is zero on constrained entries.
    fn multiply_into(&mut self, x: &[f64], out: &mut [f64]);

    /// Computes `out`, an approximation of A⁻¹ r on free entries, zero on constrained entries.
    fn precondition_into(&mut self, residual: &[f64], out: &mut [f64]);
}

/// Reason why the iteration ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// The residual is below the tolerance.
    Reached,
    /// The largest number of products was reached.
    Exhausted,
    /// A direction without positive curvature was found: the tangent is not positive definite (Steihaug 1983).
    Indefinite,
}

/// Result of conjugate gradients.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solution {
    /// Number of products with the matrix.
    pub products: u64,
    /// Norm of the final residual on free entries.
    pub residual: f64,
    /// Norm of the first residual on free entries.
    pub first: f64,
    /// Reason why the iteration ended.
    pub end: End,
}

/// Work vectors of conjugate gradients.
#[derive(Debug, Clone)]
pub struct KrylovWork {
    direction: Vec<f64>,
    product: Vec<f64>,
    preconditioned: Vec<f64>,
}

impl KrylovWork {
    /// Creates work vectors of this length.
    pub fn new(entries: usize) -> Self {
        let zeros = || vec![0.0; entries];
        Self {
            direction: zeros(),
            product: zeros(),
            preconditioned: zeros(),
        }
    }
}

/// Termination criteria of conjugate gradients.
pub struct Goal<'a> {
    /// Absolute tolerance of the norm of the residual.
    pub absolute: f64,
    /// Alternative tolerance relative to `acting` and to the norm of the reactions, the constrained entries
    /// of the residual.
    pub relative: f64,
    /// Norm of the loads or of the largest known reactions.
    pub acting: f64,
    /// Largest number of products.
    pub products: u64,
    /// Interrupt, queried before every product.
    pub interrupt: Interrupt<'a>,
}

/// Solves A d = r from d = 0. On input, `residual` is r on free entries and minus the reactions at d = 0 on
/// constrained entries; on output, both are those of the solution. `free` is 1 on free entries and 0 on
/// constrained entries.
///
/// # Errors
/// Interruption.
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
    let mut first = None;
    loop {
        let norm = domain
            .sum(n, |k| free[k] * residual[k] * residual[k])
            .sqrt();
        let first = *first.get_or_insert(norm);
        let reactions = || domain.sum(n, |k| (1.0 - free[k]) * residual[k] * residual[k]);
        let ended = |end| Solution {
            products,
            residual: norm,
            first,
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
                // The preconditioned residual is the best available approximation.
                solution.copy_from_slice(direction);
            }
            return Ok(Solution {
                products,
                residual: norm,
                first,
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
