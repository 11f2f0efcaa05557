//! Shape tensors K = Σ w ξ ⊗ ξ.

use pericles::lanes::F64x8;

use super::family::Family;
use crate::tensor::{Matrix, determinant, in_body, in_space, inverse, principal_axes, trace};

/// Largest condition number of a shape tensor; beyond it, the bonds of a point are considered not to span the space.
pub const LARGEST_CONDITION: f64 = 1e6;

/// The shape tensor of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ShapeTensor<const D: usize> {
    pub tensor: Matrix<D>,
    /// Number of bonds.
    pub bonds: usize,
}

impl<const D: usize> ShapeTensor<D> {
    /// Returns the tensor of the intact bonds of a point.
    pub fn of(family: &Family<'_, D>) -> Self {
        let mut sums = [[F64x8([0.0; 8]); D]; D];
        for batch in 0..family.batches() {
            let bond = family.bond::<F64x8>(batch);
            for a in 0..D {
                for b in 0..D {
                    sums[a][b] = sums[a][b] + bond.weight * bond.xi[a] * bond.xi[b];
                }
            }
        }
        Self {
            tensor: sums.map(|row| row.map(F64x8::sum)),
            bonds: family.count(),
        }
    }

    /// Returns the condition number, the ratio of the largest and the smallest principal value.
    pub fn condition(&self) -> f64 {
        let (values, _) = principal_axes(&self.tensor);
        let largest = values.into_iter().fold(0.0, f64::max);
        let least = values.into_iter().fold(f64::INFINITY, f64::min);
        match least > 0.0 {
            true => largest / least,
            false => f64::INFINITY,
        }
    }

    /// Returns whether the bonds determine a deformation gradient: more than D bonds with sufficiently
    /// different directions.
    pub fn is_regular(&self) -> bool {
        self.bonds > D && self.condition() <= LARGEST_CONDITION
    }

    /// Returns K⁻¹; `None` if the bonds do not determine a deformation gradient.
    pub fn inverse(&self) -> Option<Matrix<D>> {
        self.is_regular().then(|| inverse_of(&self.tensor))
    }
}

/// Returns the inverse of a positive definite tensor.
pub(crate) fn inverse_of<const D: usize>(tensor: &Matrix<D>) -> Matrix<D> {
    // The entries of missing axes are the mean, so that the determinant has the scale of the tensor.
    let full = in_space(tensor, trace(tensor) / D as f64);
    in_body(&inverse(&full, determinant(&full)))
}
