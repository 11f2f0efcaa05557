//! Cholesky factorisation of symmetric positive definite band matrices.

use super::{SolveLimits, Solved, Work, add_scaled};
use crate::error::{PericlesError, Result};

/// The factor L of A = L Lᵀ for a symmetric positive definite A with A_ij = 0 for |i − j| > `reach`; a full matrix
/// has the reach n − 1.
///
/// Storage: n (reach + 1) numbers. Cost: n reach² multiplications for the factor, 2 n reach for each solution. Rows
/// are stored in full length, so that both loops of a solution access contiguous memory.
#[derive(Debug, Clone)]
pub struct BandedCholesky {
    unknowns: usize,
    reach: usize,
    /// Row i of L: columns i − reach … i, zero before the first column.
    rows: Vec<f64>,
}

/// Number of independent partial sums: a single sum would wait for each addition.
const STRANDS: usize = 8;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (a.chunks_exact(STRANDS), b.chunks_exact(STRANDS));
    let rest: f64 = a
        .remainder()
        .iter()
        .zip(b.remainder())
        .map(|(a, b)| a * b)
        .sum();
    let mut sums = [0.0; STRANDS];
    for (a, b) in a.zip(b) {
        for k in 0..STRANDS {
            sums[k] += a[k] * b[k];
        }
    }
    sums.iter().sum::<f64>() + rest
}

impl BandedCholesky {
    /// Factorises a matrix given by its products `apply(x, out)`. Its entries are obtained from 2 reach + 1
    /// products, because columns farther apart than that share no rows.
    ///
    /// # Errors
    /// [`PericlesError::NotConverged`] if the matrix is not positive definite.
    pub fn new(
        apply: &mut dyn FnMut(&[f64], &mut [f64]),
        unknowns: usize,
        reach: usize,
    ) -> Result<Self> {
        let reach = reach.min(unknowns.saturating_sub(1));
        let width = reach + 1;
        let mut matrix = Self {
            unknowns,
            reach,
            rows: vec![0.0; unknowns * width],
        };
        let apart = (2 * reach + 1).min(unknowns);
        let (mut units, mut product) = (vec![0.0; unknowns], vec![0.0; unknowns]);
        for first in 0..apart {
            let columns = || (first..unknowns).step_by(apart);
            columns().for_each(|j| units[j] = 1.0);
            apply(&units, &mut product);
            for j in columns() {
                units[j] = 0.0;
                for i in j..(j + width).min(unknowns) {
                    matrix.rows[i * width + reach + j - i] = product[i];
                }
            }
        }
        matrix.factorise()?;
        Ok(matrix)
    }

    /// Range in row i of the columns from `from` to before the diagonal.
    fn before_diagonal(&self, i: usize, from: usize) -> std::ops::Range<usize> {
        let start = i * (self.reach + 1) + self.reach;
        start + from - i..start
    }

    fn first_column(&self, i: usize) -> usize {
        i.saturating_sub(self.reach)
    }

    fn factorise(&mut self) -> Result<()> {
        let width = self.reach + 1;
        for i in 0..self.unknowns {
            let first = self.first_column(i);
            let (above, row) = self.rows.split_at_mut(i * width);
            // Column j is stored at index reach + j − i.
            let at = |j: usize| self.reach + j - i;
            for j in first..i {
                let other = &above[j * width..(j + 1) * width];
                let both = first.max(j.saturating_sub(self.reach));
                let known = dot(
                    &row[at(both)..at(j)],
                    &other[self.reach + both - j..self.reach],
                );
                row[at(j)] = (row[at(j)] - known) / other[self.reach];
            }
            let own = &row[at(first)..at(i)];
            let square = row[self.reach] - dot(own, own);
            if square.is_nan() || square <= 0.0 {
                return Err(PericlesError::NotConverged {
                    solver: "Cholesky factorisation",
                    iterations: i,
                    residual: square,
                    tolerance: 0.0,
                    cause: "the matrix is not positive definite",
                });
            }
            row[self.reach] = square.sqrt();
        }
        Ok(())
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve(&self, x: &mut [f64]) {
        let diagonal = |i: usize| self.rows[i * (self.reach + 1) + self.reach];
        for i in 0..self.unknowns {
            let first = self.first_column(i);
            let known = dot(&self.rows[self.before_diagonal(i, first)], &x[first..i]);
            x[i] = (x[i] - known) / diagonal(i);
        }
        for i in (0..self.unknowns).rev() {
            let first = self.first_column(i);
            let value = x[i] / diagonal(i);
            x[i] = value;
            add_scaled(
                &mut x[first..i],
                -value,
                &self.rows[self.before_diagonal(i, first)],
            );
        }
    }

    /// Solves A′ x = b, starting from the given `x`, for a matrix A′ close to A given by its products: x ← x + A⁻¹
    /// (b − A′ x) until the residual meets the limits.
    ///
    /// # Errors
    /// [`PericlesError::NotConverged`] if a correction does not halve the residual; `x` is then the best iterate.
    pub fn refine(
        &self,
        apply: &mut dyn FnMut(&[f64], &mut [f64]),
        right: &[f64],
        x: &mut [f64],
        limits: &SolveLimits<'_>,
        work: &mut Work,
    ) -> Result<Solved> {
        let tolerance = limits.tolerance(work.domain.norm(right));
        let Work { domain, krylov, .. } = work;
        let [residual, trial, product] = krylov;
        let mut solved = Solved {
            residual: f64::INFINITY,
            ..Solved::default()
        };
        trial.copy_from_slice(x);
        loop {
            limits.interrupt.poll()?;
            apply(trial, product);
            solved.products += 1;
            for ((r, b), p) in residual.iter_mut().zip(right).zip(&*product) {
                *r = b - p;
            }
            let (before, found) = (solved.residual, domain.norm(residual));
            if found < before {
                x.copy_from_slice(trial);
                solved.residual = found;
            }
            if found.is_finite() && solved.residual <= tolerance {
                return Ok(solved);
            }
            // NaN and infinity end the refinement: an infinite right-hand side has an infinite tolerance.
            if !found.is_finite() || found > 0.5 * before {
                return Err(PericlesError::NotConverged {
                    solver: "iterative refinement",
                    iterations: solved.iterations,
                    residual: solved.residual,
                    tolerance,
                    cause: "rounding",
                });
            }
            self.solve(residual);
            add_scaled(trial, 1.0, residual);
            solved.iterations += 1;
        }
    }

    /// Memory, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.rows[..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A band matrix with decaying entries and a dominant diagonal.
    fn product(x: &[f64], out: &mut [f64], reach: usize, shift: f64) {
        let n = x.len();
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            0 => shift + (i as f64).sin(),
            apart if apart <= reach => -((i + j) as f64).cos() / (1 + apart) as f64,
            _ => 0.0,
        };
        for i in 0..n {
            out[i] = (0..n).map(|j| entry(i, j) * x[j]).sum();
        }
    }

    #[test]
    fn band_and_full_matrices_are_solved_to_round_off() {
        for (n, reach) in [
            (1, 0),
            (2, 1),
            (40, 0),
            (40, 1),
            (41, 7),
            (23, 22),
            (23, 40),
        ] {
            let mut apply = |x: &[f64], out: &mut [f64]| product(x, out, reach, 12.0);
            let exact: Vec<f64> = (0..n).map(|i| (0.7 * i as f64).cos()).collect();
            let mut right = vec![0.0; n];
            apply(&exact, &mut right);
            let factor = BandedCholesky::new(&mut apply, n, reach).unwrap();
            let mut x = right.clone();
            factor.solve(&mut x);
            for (x, exact) in x.iter().zip(&exact) {
                assert!((x - exact).abs() < 1e-14, "{n} {reach}");
            }
        }
    }

    #[test]
    fn refinement_solves_a_nearby_matrix() {
        let (n, reach) = (50, 3);
        let mut near = |x: &[f64], out: &mut [f64]| product(x, out, reach, 6.0 * (1.0 + 1e-7));
        let mut apply = |x: &[f64], out: &mut [f64]| product(x, out, reach, 6.0);
        let factor = BandedCholesky::new(&mut near, n, reach).unwrap();
        let right = vec![1.0; n];
        let mut x = vec![0.0; n];
        let limits = SolveLimits {
            relative: 1e-15,
            ..SolveLimits::default()
        };
        let solved = factor
            .refine(&mut apply, &right, &mut x, &limits, &mut Work::new(n))
            .unwrap();
        assert!(solved.iterations <= 3, "{solved:?}");
    }

    #[test]
    fn an_indefinite_matrix_is_an_error() {
        let mut apply = |x: &[f64], out: &mut [f64]| product(x, out, 2, 0.0);
        let error = BandedCholesky::new(&mut apply, 20, 2).unwrap_err();
        assert!(
            error.to_string().contains("not positive definite"),
            "{error}"
        );
    }

    #[test]
    fn nan_and_infinity_end_the_refinement() {
        let (n, reach) = (12, 2);
        let mut apply = |x: &[f64], out: &mut [f64]| product(x, out, reach, 4.0);
        let factor = BandedCholesky::new(&mut apply, n, reach).unwrap();
        for wrong in [f64::NAN, f64::INFINITY] {
            let mut right = vec![1.0; n];
            right[3] = wrong;
            let mut x = right.clone();
            factor.solve(&mut x);
            let limits = SolveLimits::default();
            let refined = factor.refine(&mut apply, &right, &mut x, &limits, &mut Work::new(n));
            let error = refined.unwrap_err();
            assert!(
                matches!(error, PericlesError::NotConverged { .. }),
                "{error}"
            );
        }
    }
}
