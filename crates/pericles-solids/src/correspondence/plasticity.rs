//! J2 plasticity at finite strain with logarithmic strains, and its elastic law.
//!
//! The deformation gradient is F = Fₑ Fₚ. The history variables are Cₚ⁻¹ = (FₚᵀFₚ)⁻¹ and the accumulated
//! plastic strain α. With the trial state bₑ = F Cₚ⁻¹ Fᵀ = Σ b_a n_a ⊗ n_a and the logarithmic strains ε_a =
//! ½ ln b_a, the Kirchhoff stress is τ = K tr(ε) I + 2 G dev ε. The return mapping in principal axes is that
//! of small strain (Simo, Comput. Methods Appl. Mech. Eng. 99, 1992): isotropic, volume-preserving and exact
//! for any rotation.

use super::law::Moduli;
use crate::solid::YieldScale;
use crate::tensor::{
    Matrix, combination, determinant, inverse, matrix, principal_axes, product, symmetric,
    transpose,
};

use pericles::{PericlesError, Result, positive};

/// Von Mises plasticity with linear isotropic hardening: yield at the Kirchhoff stress σ_y + H α, with the
/// accumulated plastic strain α.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plasticity {
    /// σ_y, Pa.
    pub yield_stress: f64,
    /// H, Pa; zero for perfect plasticity.
    pub hardening: f64,
}

/// Plastic history of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct History {
    /// Cₚ⁻¹: xx, yy, zz, xy, yz, xz.
    pub plastic: [f64; 6],
    /// Accumulated plastic strain α = ∫ √(2/3) |dₚ| dt.
    pub accumulated: f64,
    /// Transverse stretch of the plane or the bar at the end of the last step, the initial guess of the next step.
    pub across: f64,
    /// Energy density of the control of zero-energy modes at the end of the last step for the elastic material, J/m³.
    pub control: f64,
    /// Factor of the control of zero-energy modes at the end of the last step, which only decreases.
    pub ratio: f64,
}

impl Default for History {
    /// Returns the history before any plastic flow.
    fn default() -> Self {
        Self {
            plastic: [1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
            accumulated: 0.0,
            across: 1.0,
            control: 0.0,
            ratio: 1.0,
        }
    }
}

/// Row and column of the components of a symmetric tensor.
const PLACES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)];

impl History {
    /// Numbers stored per point.
    pub(super) const KEPT: usize = 10;

    pub(super) fn of(kept: &[f64]) -> Self {
        Self {
            plastic: std::array::from_fn(|k| kept[k]),
            accumulated: kept[6],
            across: kept[7],
            control: kept[8],
            ratio: kept[9],
        }
    }

    pub(super) fn keep(&self, kept: &mut [f64]) {
        kept[..6].copy_from_slice(&self.plastic);
        kept[6] = self.accumulated;
        kept[7] = self.across;
        kept[8] = self.control;
        kept[9] = self.ratio;
    }

    fn inverse_plastic(&self) -> Matrix<3> {
        let mut full = [[0.0; 3]; 3];
        for (&(a, b), value) in PLACES.iter().zip(self.plastic) {
            full[a][b] = value;
            full[b][a] = value;
        }
        full
    }
}

impl Plasticity {
    /// Returns the plasticity of a point whose constants are multiplied by factors.
    pub(super) fn scaled(&self, scale: YieldScale) -> Self {
        Self {
            yield_stress: scale.stress * self.yield_stress,
            hardening: scale.hardening * self.hardening,
        }
    }

    /// Returns an error if a constant is out of range.
    ///
    /// # Errors
    /// A yield stress that is not positive; a hardening modulus below zero.
    pub fn check(&self) -> Result<()> {
        positive("the yield stress", self.yield_stress)?;
        if self.hardening >= 0.0 && self.hardening.is_finite() {
            return Ok(());
        }
        Err(PericlesError::OutOfRange {
            quantity: "the hardening modulus",
            value: self.hardening,
            allowed: "0 or a positive number; softening plasticity is not supported because the model has no length scale for it",
        })
    }

    /// Returns the plastic work per volume ∫ (σ_y + H α) dα over an increment of α, J/m³.
    fn work(&self, accumulated: f64, increment: f64) -> f64 {
        increment * (self.yield_stress + self.hardening * (accumulated + 0.5 * increment))
    }
}

/// Result of the return mapping in principal axes of the trial state.
pub(super) struct Returned {
    /// b_a of the trial state.
    squares: [f64; 3],
    /// n_a as columns.
    axes: Matrix<3>,
    /// Principal Kirchhoff stresses, Pa.
    tau: [f64; 3],
    /// Elastic logarithmic strains after the return.
    elastic: [f64; 3],
    /// ∂τ_a/∂ε_b of the trial strains, Pa.
    moduli: Matrix<3>,
    /// 2 G times the remaining fraction of the trial deviator, Pa.
    secant: f64,
    /// Increment of α.
    pub increment: f64,
}

/// Computes the return mapping from the trial state of F; without `plasticity` returns the trial state.
pub(super) fn returned(
    moduli: &Moduli,
    plasticity: Option<&Plasticity>,
    f: &Matrix<3>,
    history: &History,
) -> Returned {
    let trial = product(&product(f, &history.inverse_plastic()), &transpose(f));
    let (squares, axes) = principal_axes(&trial);
    let strain = squares.map(|b| 0.5 * b.ln());
    let mean = strain.iter().sum::<f64>() / 3.0;
    let shear = 2.0 * moduli.shear;
    let deviator = strain.map(|e| shear * (e - mean));
    let size = deviator.iter().map(|s| s * s).sum::<f64>().sqrt();
    let root = (2.0f64 / 3.0).sqrt();
    let mut result = Returned {
        squares,
        axes,
        tau: deviator.map(|s| s + 3.0 * moduli.bulk * mean),
        elastic: strain,
        moduli: matrix(|a, b| moduli.bulk - shear / 3.0 + if a == b { shear } else { 0.0 }),
        secant: shear,
        increment: 0.0,
    };
    let Some(plasticity) = plasticity else {
        return result;
    };
    let limit = plasticity.yield_stress + plasticity.hardening * history.accumulated;
    let excess = size - root * limit;
    if excess.is_nan() || excess <= 1e-12 * root * limit {
        return result;
    }
    let flow = excess / (shear + 2.0 / 3.0 * plasticity.hardening);
    let direction = deviator.map(|s| s / size);
    let left = 1.0 - shear * flow / size;
    let turned = shear / (shear + 2.0 / 3.0 * plasticity.hardening) - (1.0 - left);
    for a in 0..3 {
        result.tau[a] -= shear * flow * direction[a];
        result.elastic[a] -= flow * direction[a];
    }
    result.moduli = matrix(|a, b| {
        let unit = if a == b { 1.0 } else { 0.0 };
        moduli.bulk + shear * left * (unit - 1.0 / 3.0)
            - shear * turned * direction[a] * direction[b]
    });
    result.secant = shear * left;
    result.increment = root * flow;
    result
}

impl Returned {
    /// Returns the elastic energy density, J/m³.
    pub fn energy(&self, moduli: &Moduli) -> f64 {
        let sum: f64 = self.elastic.iter().sum();
        let deviator = self.elastic.map(|e| (e - sum / 3.0).powi(2));
        0.5 * moduli.bulk * sum * sum + moduli.shear * deviator.iter().sum::<f64>()
    }

    /// Returns τ, Pa.
    pub fn kirchhoff(&self) -> Matrix<3> {
        self.in_space(self.tau)
    }

    /// Returns P = τ F⁻ᵀ, Pa.
    pub fn first_stress(&self, f: &Matrix<3>) -> Matrix<3> {
        let back = inverse(f, determinant(f));
        product(&self.kirchhoff(), &transpose(&back))
    }

    /// Returns dP = dτ F⁻ᵀ − τ F⁻ᵀ dFᵀ F⁻ᵀ for a change dF. The change of the trial state is
    /// dbₑ = dF F⁻¹ bₑ + (…)ᵀ, and in principal axes dτ_aa = Σ_b ∂τ_a/∂ε_b db_bb/(2 b_b) and
    /// dτ_ab = (τ_a − τ_b)/(b_a − b_b) db_ab.
    pub fn stress_change(&self, f: &Matrix<3>, df: &Matrix<3>) -> Matrix<3> {
        let back = inverse(f, determinant(f));
        let rate = product(df, &back);
        // In principal axes.
        let turned = product(&product(&transpose(&self.axes), &rate), &self.axes);
        let b = &self.squares;
        let change = matrix::<3>(|i, j| turned[i][j] * b[j] + turned[j][i] * b[i]);
        let own = matrix::<3>(|i, j| match i == j {
            true => (0..3)
                .map(|k| self.moduli[i][k] * change[k][k] / (2.0 * b[k]))
                .sum(),
            false => self.quotient(i, j) * change[i][j],
        });
        let own = product(&product(&self.axes, &own), &transpose(&self.axes));
        let tau = self.kirchhoff();
        let whole = combination(1.0, &own, -1.0, &product(&tau, &transpose(&rate)));
        product(&whole, &transpose(&back))
    }

    /// Returns (τ_a − τ_b)/(b_a − b_b), where τ_a − τ_b is the secant times ε_a − ε_b = ½ ln(b_a/b_b).
    fn quotient(&self, a: usize, b: usize) -> f64 {
        let excess = self.squares[a] / self.squares[b] - 1.0;
        let slope = if excess == 0.0 {
            1.0
        } else {
            excess.ln_1p() / excess
        };
        0.5 * self.secant * slope / self.squares[b]
    }

    /// Returns the history after the step and the plastic work per volume, J/m³.
    pub fn advanced(
        &self,
        plasticity: &Plasticity,
        f: &Matrix<3>,
        history: &History,
    ) -> (History, f64) {
        let across = f[2][2];
        if self.increment == 0.0 {
            return (History { across, ..*history }, 0.0);
        }
        let elastic = self.in_space(self.elastic.map(|e| (2.0 * e).exp()));
        let back = inverse(f, determinant(f));
        let plastic = symmetric(&product(&product(&back, &elastic), &transpose(&back)));
        let next = History {
            plastic: PLACES.map(|(a, b)| plastic[a][b]),
            accumulated: history.accumulated + self.increment,
            across,
            control: history.control,
            ratio: history.ratio,
        };
        (next, plasticity.work(history.accumulated, self.increment))
    }

    fn in_space(&self, principal: [f64; 3]) -> Matrix<3> {
        matrix(|i, j| {
            (0..3)
                .map(|a| principal[a] * self.axes[i][a] * self.axes[j][a])
                .sum()
        })
    }
}
