//! Anderson acceleration of a fixed-point iteration.

use crate::domain::Domain;

/// Anderson acceleration of x ← g(x): g(x) is replaced by the combination of recent images with the smallest
/// residual g − x (Walker & Ni 2011, in differences).
///
/// Memory: 2 · depth + 2 vectors.
#[derive(Debug, Clone)]
pub struct Anderson {
    /// Differences of successive residuals and of successive images; the oldest is overwritten first.
    residuals: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
    last_residual: Vec<f64>,
    last_image: Vec<f64>,
    /// Differences of the scalars that belong to the images.
    scalars: Vec<f64>,
    last_scalar: f64,
    /// Number of images since the last restart.
    seen: usize,
}

/// Pivots below this fraction of the largest one are neglected: their directions add only rounding errors.
const NEGLIGIBLE: f64 = 1e-14;

impl Anderson {
    /// Combines up to `depth` + 1 images of `entries` numbers; the depth is at most 8.
    pub fn new(depth: usize, entries: usize) -> Self {
        let array = || vec![0.0; entries];
        Self {
            residuals: (0..depth).map(|_| array()).collect(),
            images: (0..depth).map(|_| array()).collect(),
            last_residual: array(),
            last_image: array(),
            scalars: vec![0.0; depth],
            last_scalar: 0.0,
            seen: 0,
        }
    }

    /// Discards the history.
    pub fn restart(&mut self) {
        self.seen = 0;
    }

    /// Replaces `image`, which is g(x) for the iterate `x`, by the next iterate. All processes must call it together.
    pub fn next(&mut self, domain: &Domain, x: &[f64], image: &mut [f64]) {
        self.next_with(domain, x, (image, 0.0));
    }

    /// As [`Anderson::next`]; returns the same combination of scalars that belong to the images.
    pub fn next_with(
        &mut self,
        domain: &Domain,
        x: &[f64],
        (image, scalar): (&mut [f64], f64),
    ) -> f64 {
        let depth = self.residuals.len();
        if self.seen > 0 {
            let slot = (self.seen - 1) % depth;
            let (df, dg) = (&mut self.residuals[slot], &mut self.images[slot]);
            for k in 0..x.len() {
                df[k] = (image[k] - x[k]) - self.last_residual[k];
                dg[k] = image[k] - self.last_image[k];
            }
            self.scalars[slot] = scalar - self.last_scalar;
        }
        for k in 0..x.len() {
            self.last_residual[k] = image[k] - x[k];
            self.last_image[k] = image[k];
        }
        self.last_scalar = scalar;
        let known = self.seen.min(depth);
        self.seen += 1;
        let weights = self.weights(domain, known);
        for (weight, difference) in weights.iter().zip(&self.images[..known]) {
            for (image, difference) in image.iter_mut().zip(difference) {
                *image -= weight * difference;
            }
        }
        let changes = weights.iter().zip(&self.scalars[..known]);
        scalar - changes.map(|(weight, change)| weight * change).sum::<f64>()
    }

    /// Returns argmin ‖f − ΔF w‖ by Cholesky factorisation of the normal equations; dependent directions are left
    /// out.
    fn weights(&self, domain: &Domain, known: usize) -> [f64; MOST] {
        let mut matrix = [[0.0; MOST]; MOST];
        let mut right = [0.0; MOST];
        for i in 0..known {
            for j in 0..=i {
                matrix[i][j] = domain.dot(&self.residuals[i], &self.residuals[j]);
            }
            right[i] = domain.dot(&self.residuals[i], &self.last_residual);
        }
        let mut used = [false; MOST];
        for i in 0..known {
            let whole = matrix[i][i];
            for j in (0..i).filter(|&j| used[j]) {
                let sum: f64 = (0..j)
                    .filter(|&k| used[k])
                    .map(|k| matrix[i][k] * matrix[j][k])
                    .sum();
                matrix[i][j] = (matrix[i][j] - sum) / matrix[j][j];
            }
            let sum: f64 = (0..i)
                .filter(|&k| used[k])
                .map(|k| matrix[i][k].powi(2))
                .sum();
            let pivot = whole - sum;
            used[i] = pivot > NEGLIGIBLE * whole;
            matrix[i][i] = pivot.max(0.0).sqrt();
        }
        let mut weights = [0.0; MOST];
        for i in (0..known).filter(|&i| used[i]) {
            let sum: f64 = (0..i)
                .filter(|&k| used[k])
                .map(|k| matrix[i][k] * weights[k])
                .sum();
            weights[i] = (right[i] - sum) / matrix[i][i];
        }
        for i in (0..known).rev().filter(|&i| used[i]) {
            let sum: f64 = (i + 1..known)
                .filter(|&k| used[k])
                .map(|k| matrix[k][i] * weights[k])
                .sum();
            weights[i] = (weights[i] - sum) / matrix[i][i];
        }
        weights
    }
}

/// The largest depth.
const MOST: usize = 8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_map_is_solved_in_as_many_steps_as_it_has_directions() {
        // g(x) = A x + b with three different eigenvalues, two of magnitude above one: the plain iteration
        // diverges.
        let factors = [0.5, -3.0, 1.8];
        let n = 30;
        let g = |x: &[f64]| -> Vec<f64> {
            (0..n)
                .map(|i| factors[i % 3] * x[i] + (i as f64).cos())
                .collect()
        };
        let mut x = vec![0.0; n];
        let mut anderson = Anderson::new(5, n);
        for _ in 0..6 {
            let mut image = g(&x);
            anderson.next(&Domain::alone(n), &x, &mut image);
            x = image;
        }
        for i in 0..n {
            let exact = (i as f64).cos() / (1.0 - factors[i % 3]);
            assert!((x[i] - exact).abs() < 1e-8 * exact.abs().max(1.0), "{i}");
        }
    }
}
