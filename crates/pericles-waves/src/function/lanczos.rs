//! Functions of an operator by the Lanczos method.

use nalgebra::{DMatrix, SymmetricEigen};

use super::{MatrixFunction, Product, Term};
use pericles::Interrupt;
use pericles::sum::{max_norm, sum};
use pericles::{PericlesError, Result};

/// Computes g(A) x ≈ ‖x‖ Q g(T) e₁, with T the projection of A on the Krylov space of x with basis Q, orthonormal
/// in the inner product Σ m_i x_i y_i.
///
/// The basis grows until the last coefficients of all terms are below round-off, so no bound of the spectrum is
/// required. Every vector is orthogonalised twice against all others; m vectors are stored. For bounded spectra
/// [`Chebyshev`](super::Chebyshev) needs the same number of products and three vectors.
pub struct Lanczos {
    mass: Vec<f64>,
    basis: Vec<Vec<f64>>,
    products: u64,
}

const MOST: usize = 2000;
const LOOK_EVERY: usize = 8;
/// Size of the last two coefficients, relative to the norm of the vector and the largest coefficient, at which the
/// basis is large enough.
const ENOUGH: f64 = 1e-15;

impl Lanczos {
    /// Creates the engine from the mass of every entry.
    pub fn new(mass: Vec<f64>) -> Self {
        Self {
            mass,
            basis: Vec::new(),
            products: 0,
        }
    }

    /// Number of products with A so far.
    pub fn products(&self) -> u64 {
        self.products
    }

    fn inner(&self, x: &[f64], y: &[f64]) -> f64 {
        sum(x.len(), |k| self.mass[k] * x[k] * y[k])
    }
}

impl MatrixFunction for Lanczos {
    fn add(
        &mut self,
        apply: &mut Product<'_>,
        x: &[f64],
        terms: &mut [Term<'_>],
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let norm = self.inner(x, x).sqrt();
        if norm == 0.0 {
            return Ok(());
        }
        if !norm.is_finite() {
            spoil(terms);
            return Ok(());
        }
        self.basis.clear();
        self.basis.push(x.iter().map(|x| x / norm).collect());
        let (mut diagonal, mut off) = (Vec::new(), Vec::<f64>::new());
        let weights = loop {
            let last = diagonal.len();
            let mut next = vec![0.0; x.len()];
            interrupt.poll()?;
            apply(&self.basis[last], &mut next);
            self.products += 1;
            diagonal.push(self.inner(&next, &self.basis[last]));
            for _ in 0..2 {
                for vector in &self.basis {
                    let part = self.inner(&next, vector);
                    next.iter_mut()
                        .zip(vector)
                        .for_each(|(x, v)| *x -= part * v);
                }
            }
            let size = self.inner(&next, &next).sqrt();
            if !size.is_finite() {
                spoil(terms);
                return Ok(());
            }
            let scale = max_norm(&diagonal);
            let whole = size <= 1e-14 * scale || self.basis.len() == x.len();
            if whole || diagonal.len().is_multiple_of(LOOK_EVERY) {
                let weights = coefficients(&diagonal, &off, terms);
                if whole || weights.iter().all(|w| is_complete(w)) {
                    break weights;
                }
            }
            if diagonal.len() >= MOST {
                return Err(PericlesError::NotConverged {
                    solver: "the Lanczos method for a function of the stiffness",
                    iterations: MOST,
                    residual: size,
                    tolerance: ENOUGH * norm,
                    cause: "the time step is too long for this method; functions = \"chebyshev\" has no limit",
                });
            }
            off.push(size);
            next.iter_mut().for_each(|x| *x /= size);
            self.basis.push(next);
        };
        for (term, weights) in terms.iter_mut().zip(&weights) {
            for (vector, weight) in self.basis.iter().zip(weights) {
                let factor = norm * weight;
                term.out
                    .iter_mut()
                    .zip(vector)
                    .for_each(|(out, v)| *out += factor * v);
            }
        }
        Ok(())
    }
}

/// Sets the results to NaN for a NaN or infinite input, so that the run reports it. The eigenvalue iteration would
/// not terminate for such a matrix.
fn spoil(terms: &mut [Term<'_>]) {
    for term in terms {
        term.out.fill(f64::NAN);
    }
}

/// Coefficients g(T) e₁ of every term.
fn coefficients(diagonal: &[f64], off: &[f64], terms: &[Term<'_>]) -> Vec<Vec<f64>> {
    let m = diagonal.len();
    let matrix = DMatrix::from_fn(m, m, |i, j| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => off[i.min(j)],
        _ => 0.0,
    });
    let SymmetricEigen {
        eigenvalues,
        eigenvectors,
    } = SymmetricEigen::new(matrix);
    terms
        .iter()
        .map(|term| {
            let value: Vec<f64> = eigenvalues
                .iter()
                .map(|square| term.value(*square))
                .collect();
            (0..m)
                .map(|i| {
                    (0..m)
                        .map(|k| eigenvectors[(i, k)] * value[k] * eigenvectors[(0, k)])
                        .sum()
                })
                .collect()
        })
        .collect()
}

fn is_complete(weights: &[f64]) -> bool {
    let largest = max_norm(weights);
    let tail = &weights[weights.len().saturating_sub(2)..];
    weights.len() > 2 && tail.iter().all(|w| w.abs() <= ENOUGH * largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::function::WaveFunction;

    #[test]
    fn nan_input_gives_nan_results() {
        for x in [[1.0, f64::NAN, 0.0], [f64::INFINITY, 0.0, 0.0]] {
            let mut out = [0.0; 3];
            let mut terms = [Term::new(WaveFunction::Cosine, 1.0, &mut out)];
            let mut double = |x: &[f64], y: &mut [f64]| {
                y.iter_mut().zip(x).for_each(|(y, x)| *y = 2.0 * x);
            };
            Lanczos::new(vec![1.0; 3])
                .add(&mut double, &x, &mut terms, Interrupt::never())
                .unwrap();
            assert!(out.iter().all(|x| x.is_nan()), "{out:?}");
        }
    }
}
