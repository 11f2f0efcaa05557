//! Control of zero-energy modes.

use super::solid::Solid;
use super::tensor::{Matrix, apply, combination, product, trace};

/// The penalty on what the deformation gradient does not represent: with z = Y − F ξ of each bond, the energy density ½ Σ w z·Z z is added, and w Z z to the force state.
///
/// Without it deformations exist that change no deformation gradient: the checkerboard costs no energy, and short waves travel too slowly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Stabilisation {
    /// Z = tr(C : K⁻¹)/D I with the elasticity tensor C: equal to [`Stabilisation::Wan`] within a lattice, and objective everywhere.
    #[default]
    Isotropic,
    /// Z = C : K⁻¹ (Wan, Chen, Chu & Liu, Acta Mech. Sin. 35, 2019): not isotropic near surfaces and at irregular points, where it violates the balance of angular momentum at large rotations.
    Wan,
    /// Z = (c/δ) (V_δ/Σ w b V) I with the volume V_δ within the horizon δ of an interior point and the constant c of bond-based bonds of the same modulus of dilatation (Silling, Comput. Methods Appl. Mech. Eng. 322, 2017, with unit factor): stiffens waves of a few horizons.
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
    /// Z for the inverse shape tensor of a point; `spring` is c/δ V_δ/Σ w b V.
    pub(super) fn control<const D: usize>(
        self,
        solid: &Solid,
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

    /// Whether Z is a tensor.
    pub(super) fn is_tensor(self) -> bool {
        self == Self::Wan
    }
}

/// c V_δ/δ of bonds f = c s of a constant influence function with the modulus of dilatation κ (Pa), N/m⁴. The constant c is 2 κ/(A δ²) in a bar, 12 κ/(π h δ³) in the plane and 18 κ/(π δ⁴) in space; the volume V_δ within
/// the horizon is 2 A δ, π h δ² and 4 π δ³/3, so that the section A or thickness h drops out.
pub(super) fn spring_of_horizon(dimension: usize, kappa: f64, horizon: f64) -> f64 {
    let factor = match dimension {
        1 => 4.0,
        2 => 12.0,
        _ => 24.0,
    };
    factor * kappa / horizon.powi(2)
}

impl<const D: usize> Control<D> {
    /// Nothing.
    pub const NONE: Self = Self::Scalar(0.0);

    /// Z x.
    #[inline(always)]
    pub fn apply(&self, x: &[f64; D]) -> [f64; D] {
        match self {
            Self::Scalar(z) => x.map(|x| z * x),
            Self::Tensor(z) => apply(z, x),
        }
    }

    /// Z A.
    pub fn times(&self, a: &Matrix<D>) -> Matrix<D> {
        match self {
            Self::Scalar(z) => combination(*z, a, 0.0, a),
            Self::Tensor(z) => product(z, a),
        }
    }

    /// Z : A of a symmetric tensor A.
    pub fn contraction(&self, a: &Matrix<D>) -> f64 {
        trace(&self.times(a))
    }

    /// The largest eigenvalue of Z, or a bound of it.
    pub fn largest(&self) -> f64 {
        match self {
            Self::Scalar(z) => *z,
            Self::Tensor(z) => {
                let (values, _) = super::tensor::principal_axes(z);
                values.into_iter().fold(0.0, f64::max)
            }
        }
    }
}
