//! Elastic laws at finite strain: energy density, first Piola–Kirchhoff stress and its derivative.

use super::stiffness::Stiffness;
use crate::tensor::{
    Matrix, combination, contraction, determinant, inverse, product, trace, transpose, unit,
};

/// Isotropic hyperelastic law ψ(F) with the deformation gradient F, J = det F, and the first Piola–Kirchhoff
/// stress P = ∂ψ/∂F. All laws agree with linear elasticity at small strain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ElasticLaw {
    /// St Venant–Kirchhoff: S = λ tr(E) I + 2 G E with E = ½ (FᵀF − I), P = F S; S = C : E of an anisotropic solid. For
    /// small strains and any rotation; the law softens in compression and does not resist J → 0.
    #[default]
    StVenantKirchhoff,
    /// Neo-Hookean: ψ = ½ G (tr FᵀF − 3) − G ln J + ½ λ (ln J)².
    NeoHooke,
    /// Neo-Hookean with volumetric–isochoric split: ψ = ½ G (J^(−2/3) tr FᵀF − 3) + (K/8) (J² + J⁻² − 2).
    NeoHookeSplit,
    /// Hencky: ψ = ½ K (tr ε)² + G |dev ε|² with the logarithmic strain ε = ½ ln FFᵀ. Elastic law of
    /// materials with [`Plasticity`](super::Plasticity).
    Hencky,
}

/// Lamé constant λ, shear modulus G and bulk modulus K of a solid, Pa; of an anisotropic one those of Voigt's average.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moduli {
    /// λ
    pub lame: f64,
    /// G
    pub shear: f64,
    /// K
    pub bulk: f64,
    /// The stiffness of an anisotropic solid, whose law is [`ElasticLaw::StVenantKirchhoff`].
    pub stiffness: Option<Stiffness>,
}

impl Moduli {
    /// Returns the moduli for the bulk modulus K and the shear modulus G, Pa.
    pub fn new(bulk: f64, shear: f64) -> Self {
        Self {
            lame: bulk - 2.0 / 3.0 * shear,
            shear,
            bulk,
            stiffness: None,
        }
    }

    /// Returns the moduli of an anisotropic solid.
    pub fn anisotropic(stiffness: Stiffness) -> Self {
        let [bulk, shear] = stiffness.average();
        Self {
            stiffness: Some(stiffness),
            ..Self::new(bulk, shear)
        }
    }

    /// Returns the moduli of the isotropic solid, of an anisotropic one those of Voigt's average.
    #[must_use]
    pub fn isotropic(self) -> Self {
        Self {
            stiffness: None,
            ..self
        }
    }
}

/// Returns ψ (J/m³) and P (Pa) of a law other than [`ElasticLaw::Hencky`], which is computed from principal
/// strains. NaN for J ≤ 0.
pub(super) fn stress(law: ElasticLaw, moduli: &Moduli, f: &Matrix<3>) -> (f64, Matrix<3>) {
    let Moduli {
        lame, shear, bulk, ..
    } = *moduli;
    let j = determinant(f);
    if j.is_nan() || j <= 0.0 {
        return (f64::NAN, [[f64::NAN; 3]; 3]);
    }
    if law == ElasticLaw::StVenantKirchhoff {
        let strain = green_strain(f);
        let second = second_stress(moduli, &strain);
        return (0.5 * contraction(&second, &strain), product(f, &second));
    }
    // Computed from H = F − I to avoid cancellation at small strains.
    let h = combination(1.0, f, -1.0, &unit());
    let growth = volume_change(&h);
    let log = growth.ln_1p();
    // ½ (tr FᵀF − 3)
    let stretch = trace(&h) + 0.5 * contraction(&h, &h);
    let inverse = transpose(&inverse(f, j));
    if law == ElasticLaw::NeoHookeSplit {
        let less = (-2.0 / 3.0 * log).exp_m1();
        let scale = 1.0 + less;
        let invariant = 2.0 * stretch + 3.0;
        // J − 1/J, whose square is J² + J⁻² − 2.
        let swelling = growth * (2.0 + growth) / j;
        let energy =
            0.5 * shear * (less * invariant + 2.0 * stretch) + 0.125 * bulk * swelling * swelling;
        let pressure = 0.25 * bulk * swelling * (j + 1.0 / j);
        let along = pressure - shear * scale * invariant / 3.0;
        return (energy, combination(shear * scale, f, along, &inverse));
    }
    let energy = shear * (stretch - log) + 0.5 * lame * log * log;
    (energy, combination(shear, f, lame * log - shear, &inverse))
}

/// Returns J − 1 for F = I + H, the sum of the invariants of H.
fn volume_change(h: &Matrix<3>) -> f64 {
    let trace = trace(h);
    let second = 0.5 * (trace * trace - contraction(h, &transpose(h)));
    trace + second + determinant(h)
}

/// Returns the derivative of P in a direction dF.
pub(super) fn stress_change(
    law: ElasticLaw,
    moduli: &Moduli,
    f: &Matrix<3>,
    df: &Matrix<3>,
) -> Matrix<3> {
    let Moduli {
        lame, shear, bulk, ..
    } = *moduli;
    if law == ElasticLaw::StVenantKirchhoff {
        let second = second_stress(moduli, &green_strain(f));
        let half = product(&transpose(f), df);
        let strain = combination(0.5, &half, 0.5, &transpose(&half));
        let change = second_stress(moduli, &strain);
        return combination(1.0, &product(df, &second), 1.0, &product(f, &change));
    }
    let j = determinant(f);
    let straight = inverse(f, j);
    let inverse = transpose(&straight);
    // dF⁻ᵀ = −F⁻ᵀ dFᵀ F⁻ᵀ, and dJ/J = tr F⁻¹dF.
    let bent = product(&product(&inverse, &transpose(df)), &inverse);
    let growth = trace(&product(&straight, df));
    if law == ElasticLaw::NeoHookeSplit {
        let scale = shear * j.powf(-2.0 / 3.0);
        let (square, invariant) = (j * j, contraction(f, f));
        let pressure = 0.25 * bulk * (square - 1.0 / square);
        let along = pressure - scale * invariant / 3.0;
        let scale_change = -2.0 / 3.0 * growth * scale;
        let along_change = 0.5 * bulk * (square + 1.0 / square) * growth
            - (scale_change * invariant + 2.0 * scale * contraction(f, df)) / 3.0;
        let first = combination(scale, df, scale_change, f);
        let second = combination(along_change, &inverse, -along, &bent);
        return combination(1.0, &first, 1.0, &second);
    }
    let along = lame * j.ln() - shear;
    let second = combination(lame * growth, &inverse, -along, &bent);
    combination(shear, df, 1.0, &second)
}

/// Returns E = ½ (FᵀF − I) = ½ (H + Hᵀ + HᵀH) with H = F − I, which avoids cancellation at small strain.
fn green_strain(f: &Matrix<3>) -> Matrix<3> {
    let h = combination(1.0, f, -1.0, &unit());
    let square = product(&transpose(&h), &h);
    let sum = combination(1.0, &h, 1.0, &transpose(&h));
    combination(0.5, &sum, 0.5, &square)
}

/// Returns λ tr(E) I + 2 G E, or C : E of an anisotropic solid.
fn second_stress(moduli: &Moduli, strain: &Matrix<3>) -> Matrix<3> {
    if let Some(stiffness) = &moduli.stiffness {
        return stiffness.stress(strain);
    }
    let pressure = moduli.lame * trace(strain);
    combination(pressure, &unit(), 2.0 * moduli.shear, strain)
}
