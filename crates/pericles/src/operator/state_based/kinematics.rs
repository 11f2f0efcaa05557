//! Kinematics of bonds: stretches and directions as functions of displacements.

use crate::lanes::{Vector, dot};
use crate::material::{BondStretch, LinearBond, PairForce};
use crate::operator::StencilLaw;
use crate::operator::polynomials::{PHI, PSI, REACH};

/// The kinematics of a bond of length r = |ξ| in the loops of state-based materials, as a function of a
/// scalar strain t.
///
/// With the stretch ψ = e/r, the direction y and the pull p + ψ s of both force states (p from the
/// dilatations, ψ s from the bond), a bond contributes
///
/// * ω r² ψ to the weighted extension Σ ω r e of its point,
/// * ω F y with F = (p + ψ s) r/|y| to the force,
///
/// where ω is the influence function times the partial volume of the neighbour. For
/// |t| ≤ [`Kinematics::REACH`] no roots or divisions are needed.
pub trait Kinematics: Copy + Default + Send + Sync + 'static {
    /// Pair force with the stretch measure of the failure criterion.
    type Measure: PairForce;
    /// The kinematics in the data of stencils.
    const STENCIL: StencilLaw;
    /// Whether stretches are linear in the displacement and directions fixed.
    const LINEAR: bool;
    /// Largest |t| for which [`Kinematics::stretch`] and [`Kinematics::pull`] are exact to round-off.
    const REACH: f64;

    /// Returns the strain t of the bonds; bitwise identical from both ends.
    fn strain<T: Vector, const D: usize>(xi: [T; D], eta: [T; D], inverse_square: T) -> T;

    /// Returns ψ for |t| ≤ REACH.
    fn stretch<T: Vector>(t: T) -> T;

    /// Returns ψ for any t.
    fn exact_stretch<T: Vector>(t: T) -> T;

    /// Returns F for |t| ≤ REACH.
    fn pull<T: Vector>(t: T, p: T, s: T) -> T;

    /// Returns F for any t.
    fn exact_pull<T: Vector>(t: T, p: T, s: T) -> T;

    /// Returns the direction of the force, not normalised.
    fn direction<T: Vector, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D];

    /// Returns r/|y| for any t.
    fn contraction<T: Vector>(t: T) -> T;

    /// Returns the change of F for changes `stretch` of ψ and `change` of p, for any t.
    fn pull_change<T: Vector>(t: T, p: T, s: T, stretch: T, change: T) -> T;
}

/// Finite displacements: e = |ξ + η| − |ξ|, forces along y = ξ + η. t = η·(2ξ + η)/|ξ|² avoids cancellation
/// at small strains, and ψ = √(1 + t) − 1.
#[derive(Debug, Clone, Copy, Default)]
pub struct FiniteStrain;

/// Small displacements: e = ξ·η/|ξ|, forces along y = ξ, the linearisation of [`FiniteStrain`] about the
/// reference state. t = ψ = ξ·η/|ξ|².
#[derive(Debug, Clone, Copy, Default)]
pub struct SmallStrain;

/// Returns t times the polynomial.
#[inline(always)]
fn polynomial<T: Vector>(coefficients: &[f64; 7], t: T) -> T {
    let mut value = T::splat(coefficients[6]);
    for k in (0..6).rev() {
        value = value.mul_add(t, T::splat(coefficients[k]));
    }
    t * value
}

/// Returns η·(2ξ + η).
#[inline(always)]
fn growth<T: Vector, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
    let mut growth = eta[0] * (xi[0] + (xi[0] + eta[0]));
    for c in 1..D {
        growth = eta[c].mul_add(xi[c] + (xi[c] + eta[c]), growth);
    }
    growth
}

impl Kinematics for FiniteStrain {
    type Measure = BondStretch;
    const STENCIL: StencilLaw = StencilLaw::BondStretch;
    const LINEAR: bool = false;
    const REACH: f64 = REACH;

    #[inline(always)]
    fn strain<T: Vector, const D: usize>(xi: [T; D], eta: [T; D], inverse_square: T) -> T {
        growth(xi, eta) * inverse_square
    }

    #[inline(always)]
    fn stretch<T: Vector>(t: T) -> T {
        polynomial(&PSI, t)
    }

    #[inline(always)]
    fn exact_stretch<T: Vector>(t: T) -> T {
        let one = T::splat(1.0);
        t / (one + (one + t).sqrt())
    }

    /// (1 − φ) (p + ψ s) = p + φ (s − p) with φ = 1 − r/|y| = ψ/(1 + ψ).
    #[inline(always)]
    fn pull<T: Vector>(t: T, p: T, s: T) -> T {
        polynomial(&PHI, t).mul_add(s - p, p)
    }

    #[inline(always)]
    fn exact_pull<T: Vector>(t: T, p: T, s: T) -> T {
        let square = T::splat(1.0) + t;
        (t / (square + square.sqrt())).mul_add(s - p, p)
    }

    #[inline(always)]
    fn direction<T: Vector, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D] {
        let mut direction = xi;
        for c in 0..D {
            direction[c] = xi[c] + eta[c];
        }
        direction
    }

    #[inline(always)]
    fn contraction<T: Vector>(t: T) -> T {
        let one = T::splat(1.0);
        one / (one + t).sqrt()
    }

    /// With g = r/|y|: dF = g dp + g² dψ (s − p).
    #[inline(always)]
    fn pull_change<T: Vector>(t: T, p: T, s: T, stretch: T, change: T) -> T {
        let g = Self::contraction(t);
        g * (g * stretch).mul_add(s - p, change)
    }
}

impl Kinematics for SmallStrain {
    type Measure = LinearBond;
    const STENCIL: StencilLaw = StencilLaw::Linear;
    const LINEAR: bool = true;
    const REACH: f64 = f64::INFINITY;

    #[inline(always)]
    fn strain<T: Vector, const D: usize>(xi: [T; D], eta: [T; D], inverse_square: T) -> T {
        dot(xi, eta) * inverse_square
    }

    #[inline(always)]
    fn stretch<T: Vector>(t: T) -> T {
        t
    }

    #[inline(always)]
    fn exact_stretch<T: Vector>(t: T) -> T {
        t
    }

    #[inline(always)]
    fn pull<T: Vector>(t: T, p: T, s: T) -> T {
        t.mul_add(s, p)
    }

    #[inline(always)]
    fn exact_pull<T: Vector>(t: T, p: T, s: T) -> T {
        t.mul_add(s, p)
    }

    #[inline(always)]
    fn direction<T: Vector, const D: usize>(xi: [T; D], _eta: [T; D]) -> [T; D] {
        xi
    }

    #[inline(always)]
    fn contraction<T: Vector>(_t: T) -> T {
        T::splat(1.0)
    }

    #[inline(always)]
    fn pull_change<T: Vector>(_t: T, _p: T, s: T, stretch: T, change: T) -> T {
        stretch.mul_add(s, change)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::F64x8;

    fn lanes(x: f64) -> F64x8 {
        F64x8([x; 8])
    }

    #[test]
    fn polynomials_and_exact_forms_agree_to_round_off() {
        for k in -1000..=1000 {
            let t = 0.02 * f64::from(k) / 1000.0;
            let fast = FiniteStrain::stretch(lanes(t)).0[0];
            let exact = FiniteStrain::exact_stretch(lanes(t)).0[0];
            assert!((fast - exact).abs() <= 1e-15 * exact.abs(), "{t}");
            let [p, s] = [0.3, 7.0].map(lanes);
            let fast = FiniteStrain::pull(lanes(t), p, s).0[0];
            let exact = FiniteStrain::exact_pull(lanes(t), p, s).0[0];
            assert!((fast - exact).abs() < 1e-14, "{t}");
        }
    }

    #[test]
    fn pull_change_is_the_derivative_of_the_pull() {
        // t of a stretch ψ is ψ (2 + ψ).
        let pull = |psi: f64, p: f64, s: f64| {
            let t = lanes(psi * (2.0 + psi));
            FiniteStrain::exact_pull(t, lanes(p), lanes(s)).0[0]
        };
        let (psi, p, s, h) = (0.2, 0.7, 3.0, 1e-6);
        let (dpsi, dp) = (0.4, -0.9);
        let at = |sign: f64| pull(psi + sign * h * dpsi, p + sign * h * dp, s);
        let t = lanes(psi * (2.0 + psi));
        let change = FiniteStrain::pull_change(t, lanes(p), lanes(s), lanes(dpsi), lanes(dp)).0[0];
        assert!(((at(1.0) - at(-1.0)) / (2.0 * h) - change).abs() < 1e-9);
        // F = (p + ψ s)/(1 + ψ)
        assert!((pull(psi, p, s) - (p + psi * s) / (1.0 + psi)).abs() < 1e-15);
    }
}
