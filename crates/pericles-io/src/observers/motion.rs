//! Displaced positions of places in a body.

use pericles::space::{Point, PointCloud};

/// A matrix, by rows.
pub(super) type Matrix = [[f64; 3]; 3];

/// The motion of a body for a picture: the neighbourhood of a point moves with its displacement and, if it is known, with
/// the displacement gradient there.
#[derive(Debug)]
pub(super) struct Motion<'a> {
    pub(super) cloud: &'a PointCloud,
    /// Displacement, component-major, m.
    pub(super) displacement: &'a [f64],
    /// Magnification of displacements.
    pub(super) scale: f64,
    /// Displacement gradient at each point; empty if it is not known.
    pub(super) gradients: Vec<Matrix>,
}

impl<'a> Motion<'a> {
    /// Creates the motion without gradients.
    pub(super) fn new(cloud: &'a PointCloud, displacement: &'a [f64], scale: f64) -> Self {
        Self {
            cloud,
            displacement,
            scale,
            gradients: Vec::new(),
        }
    }

    /// Returns the displacement of a point, m.
    pub(super) fn of_point(&self, point: usize) -> Point {
        let n = self.cloud.len();
        std::array::from_fn(|c| match c < self.cloud.dimension() {
            true => self.displacement[c * n + point],
            false => 0.0,
        })
    }

    /// Returns the displaced position of a place that moves with a point.
    pub(super) fn place(&self, place: Point, point: usize) -> Point {
        let mut moved = self.of_point(point);
        if let Some(gradient) = self.gradients.get(point) {
            let centre = self.cloud.point(point);
            for (moved, row) in moved.iter_mut().zip(gradient) {
                let parts = (0..3).map(|c| row[c] * (place[c] - centre[c]));
                *moved += parts.sum::<f64>();
            }
        }
        std::array::from_fn(|c| place[c] + self.scale * moved[c])
    }
}

/// Sums of a least-squares fit of a displacement gradient.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct GradientFit {
    across: Matrix,
    moved: Matrix,
}

impl GradientFit {
    /// Adds a neighbour at a relative position with a relative displacement.
    pub(super) fn add(&mut self, arm: Point, moved: Point) {
        let square: f64 = arm.iter().map(|x| x * x).sum();
        for row in 0..3 {
            for column in 0..3 {
                self.across[row][column] += arm[row] * arm[column] / square;
                self.moved[row][column] += moved[row] * arm[column] / square;
            }
        }
    }

    /// Returns the gradient; zero in directions in which there is no neighbour.
    pub(super) fn gradient(&self) -> Matrix {
        /// Regularisation relative to the trace: a relative error of pictures.
        const SMALL: f64 = 1e-6;
        let trace: f64 = (0..3).map(|k| self.across[k][k]).sum();
        if trace <= 0.0 {
            return Matrix::default();
        }
        let mut a = self.across;
        for (k, row) in a.iter_mut().enumerate() {
            row[k] += SMALL * trace;
        }
        let minor = |i: usize, j: usize| {
            let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
            a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1]
        };
        let determinant: f64 = (0..3).map(|k| a[0][k] * minor(0, k)).sum();
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                let parts = (0..3).map(|k| self.moved[row][k] * minor(column, k));
                parts.sum::<f64>() / determinant
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_of_affine_motions_are_exact() {
        let gradient = [[0.1, -2.0, 0.3], [0.4, 0.5, -0.6], [0.7, 0.8, 3.0]];
        let moved = |arm: Point| -> Point {
            std::array::from_fn(|row| (0..3).map(|k| gradient[row][k] * arm[k]).sum())
        };
        let mut fit = GradientFit::default();
        for arm in [
            [1.0, 0.1, 0.0],
            [-0.2, 2.0, 0.3],
            [0.0, 0.4, 1.5],
            [1.0, 1.0, 1.0],
        ] {
            fit.add(arm, moved(arm));
        }
        for (found, row) in fit.gradient().iter().zip(gradient) {
            assert!(
                found.iter().zip(row).all(|(a, b)| (a - b).abs() < 1e-4),
                "{found:?}"
            );
        }
        // A single neighbour determines the gradient along its direction only.
        let mut fit = GradientFit::default();
        assert_eq!(fit.gradient(), Matrix::default());
        fit.add([2.0, 0.0, 0.0], [0.2, 0.4, 0.0]);
        let found = fit.gradient();
        assert!((found[0][0] - 0.1).abs() < 1e-6 && (found[1][0] - 0.2).abs() < 1e-6);
        assert!(found.iter().all(|row| row[1].abs() + row[2].abs() < 1e-12));
    }
}
