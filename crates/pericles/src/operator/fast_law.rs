//! Pair laws in vectorised loops: the forces of [`PairForce`] without roots and divisions where possible.

use super::StencilLaw;
use super::polynomials::{PHI, REACH};
use crate::lanes::Vector;
use crate::material::{
    Approximated, BondStretch, CubicBond, CubicFactor, CubicSofteningBond, GreenBond, LinearBond,
    PairForce,
};

/// Constant data of the bonds in the lanes of a vector.
#[derive(Debug, Clone, Copy)]
pub struct FixedBond<T, const D: usize> {
    /// ξ, m.
    pub xi: [T; D],
    /// 1/|ξ|², m⁻².
    pub inverse_square: T,
    /// c α κ V, N/m³.
    pub stiffness: T,
    /// c α κ V/|ξ|, N/m⁴.
    pub factor: T,
}

impl<T: Vector, const D: usize> FixedBond<T, D> {
    /// Returns the bond with the stress-free length (1 + τ)|ξ| and its relative displacement η − τ ξ.
    #[inline(always)]
    pub(super) fn expanded(self, stretch: T, eta: [T; D]) -> (Self, [T; D]) {
        let one = T::splat(1.0);
        let scale = one + stretch;
        let inverse = one / scale;
        let (mut xi, mut pulled) = (self.xi, eta);
        for c in 0..D {
            xi[c] = scale * self.xi[c];
            pulled[c] = eta[c] - stretch * self.xi[c];
        }
        // The factor, stiffness over length, is unchanged.
        let bond = Self {
            xi,
            inverse_square: self.inverse_square * (inverse * inverse),
            stiffness: self.stiffness * scale,
            factor: self.factor,
        };
        (bond, pulled)
    }
}

/// The vectorised form of a pair law.
///
/// With the measure m of [`PairForce::stretch_measure`] and the strain t = m/|ξ|², a bond is over-stretched
/// if t > threshold(s₀), and its force can be written as a function of t times a direction. The default
/// methods use [`PairForce`].
pub trait VectorLaw: PairForce {
    /// The law in the data of stencils, if back ends that evaluate stencils themselves have it.
    const STENCIL: Option<StencilLaw> = None;

    /// Largest |t| for which [`VectorLaw::add_force`] is exact to round-off.
    const REACH: f64 = f64::INFINITY;

    /// Returns the strain t of the bonds; bitwise identical from both ends.
    #[inline(always)]
    fn strain<T: Vector, const D: usize>(bond: &FixedBond<T, D>, eta: [T; D]) -> T {
        Self::stretch_measure(bond.xi, eta).0 * bond.inverse_square
    }

    /// Adds the force of the bonds selected by `mask` to `sum`. `t` is their strain, zero for other bonds.
    #[inline(always)]
    fn add_force<T: Vector, const D: usize>(
        bond: &FixedBond<T, D>,
        eta: [T; D],
        _t: T,
        mask: T::Mask,
        sum: &mut [T; D],
    ) {
        let force = Self::force(bond.xi, eta);
        for c in 0..D {
            sum[c] = sum[c] + (bond.stiffness * force[c]).masked(mask);
        }
    }

    /// Returns the derivative of the force in the direction d, at any strain.
    #[inline(always)]
    fn tangent_force<T: Vector, const D: usize>(
        bond: &FixedBond<T, D>,
        eta: [T; D],
        d: [T; D],
    ) -> [T; D] {
        let mut force = Self::tangent(bond.xi, eta, d);
        for c in 0..D {
            force[c] = bond.stiffness * force[c];
        }
        force
    }
}

impl VectorLaw for GreenBond {}

impl VectorLaw for CubicSofteningBond {}

impl<L: CubicBond, T: CubicFactor> VectorLaw for Approximated<L, T> {}

/// Rounding error above which the polynomial of degree four is sufficient: its relative error is below 2e-9.
const SHORT_PHI: f64 = 1e-8;

impl VectorLaw for BondStretch {
    const STENCIL: Option<StencilLaw> = Some(StencilLaw::BondStretch);

    const REACH: f64 = REACH;

    /// t = η·(2ξ+η)/|ξ|².
    #[inline(always)]
    fn strain<T: Vector, const D: usize>(bond: &FixedBond<T, D>, eta: [T; D]) -> T {
        let xi = bond.xi;
        let mut growth = eta[0] * (xi[0] + (xi[0] + eta[0]));
        for c in 1..D {
            growth = eta[c].mul_add(xi[c] + (xi[c] + eta[c]), growth);
        }
        growth * bond.inverse_square
    }

    /// (c α κ V/|ξ|) φ(t) (ξ+η), with φ(t) = 1 − (1+t)^(−1/2) = 1 − |ξ|/|ξ+η|.
    #[inline(always)]
    fn add_force<T: Vector, const D: usize>(
        bond: &FixedBond<T, D>,
        eta: [T; D],
        t: T,
        _mask: T::Mask,
        sum: &mut [T; D],
    ) {
        let degree = if T::EPSILON > SHORT_PHI { 4 } else { 6 };
        let mut phi = T::splat(PHI[degree]);
        for k in (0..degree).rev() {
            phi = phi.mul_add(t, T::splat(PHI[k]));
        }
        let pull = t * bond.factor * phi;
        for c in 0..D {
            sum[c] = pull.mul_add(bond.xi[c] + eta[c], sum[c]);
        }
    }

    /// (c α κ V/|ξ|) ((1 − r) d + r³ ((ξ+η)·d)/|ξ|² (ξ+η)), with r = (1+t)^(−1/2).
    #[inline(always)]
    fn tangent_force<T: Vector, const D: usize>(
        bond: &FixedBond<T, D>,
        eta: [T; D],
        d: [T; D],
    ) -> [T; D] {
        let (zero, one) = (T::splat(0.0), T::splat(1.0));
        let t = Self::strain(bond, eta);
        // At rest, where the highest frequency is computed, neither root nor division is needed; r is one in
        // both cases, bitwise.
        let moved = [t.greater(zero), (-t).greater(zero)];
        let r = if moved == [T::Mask::default(); 2] {
            one
        } else {
            one / (one + t).sqrt()
        };
        let mut y = eta;
        let mut along = zero;
        for c in 0..D {
            y[c] = bond.xi[c] + eta[c];
            along = y[c].mul_add(d[c], along);
        }
        let turn = bond.factor * (one - r);
        let pull = bond.factor * (r * r * r) * (along * bond.inverse_square);
        let mut force = d;
        for c in 0..D {
            force[c] = pull.mul_add(y[c], turn * d[c]);
        }
        force
    }
}

impl VectorLaw for LinearBond {
    const STENCIL: Option<StencilLaw> = Some(StencilLaw::Linear);

    /// t = ξ·η/|ξ|².
    #[inline(always)]
    fn strain<T: Vector, const D: usize>(bond: &FixedBond<T, D>, eta: [T; D]) -> T {
        let mut along = eta[0] * bond.xi[0];
        for c in 1..D {
            along = eta[c].mul_add(bond.xi[c], along);
        }
        along * bond.inverse_square
    }

    /// (c α κ V/|ξ|) t ξ.
    #[inline(always)]
    fn add_force<T: Vector, const D: usize>(
        bond: &FixedBond<T, D>,
        _eta: [T; D],
        t: T,
        _mask: T::Mask,
        sum: &mut [T; D],
    ) {
        let pull = t * bond.factor;
        for c in 0..D {
            sum[c] = pull.mul_add(bond.xi[c], sum[c]);
        }
    }

    /// (c α κ V/|ξ|) (ξ·d)/|ξ|² ξ.
    #[inline(always)]
    fn tangent_force<T: Vector, const D: usize>(
        bond: &FixedBond<T, D>,
        _eta: [T; D],
        d: [T; D],
    ) -> [T; D] {
        let pull = Self::strain(bond, d) * bond.factor;
        let mut force = d;
        for c in 0..D {
            force[c] = pull * bond.xi[c];
        }
        force
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_polynomial_is_exact_to_round_off() {
        for k in -1000..=1000 {
            let t = 0.02 * f64::from(k) / 1000.0;
            let exact = 1.0 / ((1.0 + t) + (1.0 + t).sqrt());
            let phi = PHI.iter().rev().fold(0.0, |sum, a| sum * t + a);
            assert!((phi / exact - 1.0).abs() < 9e-15, "{t}: {phi} {exact}");
        }
    }
}
