//! Control of zero-energy modes.

use super::classical::ClassicalSolid;
use crate::tensor::{Matrix, combination, product, trace};

/// Penalty on deformations that the deformation gradient does not represent. With z = Y − F ξ of each bond,
/// it adds ½ Σ w z·Z z to the energy density and w Z z to the force state.
///
/// Without it, zero-energy modes exist: a checkerboard deformation has no energy, and short waves are too slow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stabilisation {
    /// Z = tr(C : K⁻¹)/D I with the elasticity tensor C: equal to [`Stabilisation::Wan`] in the interior of a
    /// lattice, and objective everywhere.
    #[default]
    Isotropic,
    /// Z = C : K⁻¹ (Wan, Chen, Chu & Liu, Acta Mech. Sin. 35, 2019). Not isotropic near surfaces and at
    /// irregular points, where it violates the balance of angular momentum at large rotations.
    Wan,
    /// Z = (c/δ) (V_δ/Σ w b V) I with the volume V_δ within the horizon δ of an interior point and the bond
    /// constant c of a bond-based material with the same dilatation modulus (Silling, Comput. Methods Appl.
    /// Mech. Eng. 322, 2017, with unit factor). Waves with lengths of a few horizons are too fast.
    Silling,
    /// Z = 0.
    None,
}

/// Z of a point, Pa/m² per weighted volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control<const D: usize> {
    /// A multiple of the unit tensor.
    Scalar(f64),
    /// A symmetric tensor.
    Tensor(Matrix<D>),
}

impl Stabilisation {
    /// Returns Z for the inverse shape tensor of a point; `spring` is c/δ V_δ/Σ w b V.
    pub(super) fn control<const D: usize>(
        self,
        solid: &ClassicalSolid,
        inverse: &Matrix<D>,
        spring: f64,
    ) -> Control<D> {
        match self {
            Self::Isotropic => Control::Scalar(trace(&solid.linear_stress(inverse)) / D as f64),
            Self::Wan => Control::Tensor(solid.linear_stress(inverse)),
            Self::Silling => Control::Scalar(spring),
            Self::None => Control::Scalar(0.0),
        }
    }

    /// Returns whether Z is a tensor.
    pub(super) fn is_tensor(self) -> bool {
        self == Self::Wan
    }
}

/// Returns c V_δ/δ of bonds f = c s with constant influence function and dilatation modulus κ (Pa), N/m⁴. The
/// constant c is 2 κ/(A δ²) in a bar, 12 κ/(π h δ³) in the plane and 18 κ/(π δ⁴) in space; the volume V_δ
/// within the horizon is 2 A δ, π h δ² and 4 π δ³/3, so that the section A and the thickness h cancel.
pub(super) fn spring_of_horizon(dimension: usize, kappa: f64, horizon: f64) -> f64 {
    let factor = match dimension {
        1 => 4.0,
        2 => 12.0,
        _ => 24.0,
    };
    factor * kappa / horizon.powi(2)
}

impl<const D: usize> Control<D> {
    /// No control, Z = 0.
    pub const NONE: Self = Self::Scalar(0.0);

    /// Returns Z A.
    pub fn times(&self, a: &Matrix<D>) -> Matrix<D> {
        match self {
            Self::Scalar(z) => combination(*z, a, 0.0, a),
            Self::Tensor(z) => product(z, a),
        }
    }

    /// Returns a multiple of Z.
    pub fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Scalar(z) => Self::Scalar(factor * z),
            Self::Tensor(z) => Self::Tensor(z.map(|row| row.map(|entry| factor * entry))),
        }
    }

    /// Returns Z : A for a symmetric tensor A.
    pub fn contraction(&self, a: &Matrix<D>) -> f64 {
        trace(&self.times(a))
    }

    /// Returns the largest eigenvalue of Z.
    pub fn largest(&self) -> f64 {
        match self {
            Self::Scalar(z) => *z,
            Self::Tensor(z) => {
                let (values, _) = crate::tensor::principal_axes(z);
                values.into_iter().fold(0.0, f64::max)
            }
        }
    }
}
