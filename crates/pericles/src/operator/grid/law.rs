//! Pair laws on a lattice: the same forces as [`PairForce`], without roots and divisions.

use crate::material::{BondStretch, LinearBond, PairForce};
use crate::operator::lanes::Lanes;

/// One bond of the stencil, with everything the loops need of it.
#[derive(Debug, Clone, Copy)]
pub struct Offset<const D: usize> {
    /// From a node's place in a padded array to that of its neighbour.
    pub shift: isize,
    /// ξ, m.
    pub xi: [f64; D],
    /// 2ξ, m.
    pub twice_xi: [f64; D],
    /// 1/|ξ|², m⁻².
    pub inverse_square: f64,
    /// c α κ V, N/m³.
    pub stiffness: f64,
    /// c α κ V/|ξ|, N/m⁴.
    pub factor: f64,
}

/// The fast form of a pair force on offsets known beforehand.
///
/// With the measure m of [`PairForce::stretch_measure`], t = m/|ξ|² decides all: the bond is over-stretched if t > threshold(s₀), and
/// its force is a function of t times a direction.
pub trait GridLaw: PairForce {
    /// The largest |t| for which [`GridLaw::add_force`] holds to round-off.
    const REACH: f64;

    /// t of eight bonds of the same offset; the same bits but for signs seen from the other end.
    fn strain<T: Lanes, const D: usize>(offset: &Offset<D>, eta: [T; D]) -> T;

    /// Adds the force of bonds with strain t to `sum`; nothing where t = 0.
    fn add_force<T: Lanes, const D: usize>(offset: &Offset<D>, eta: [T; D], t: T, sum: &mut [T; D]);
}

/// Coefficients of φ(t)/t = 1/((1+t) + √(1+t)), ascending: the polynomial through its values at the seven Chebyshev nodes of
/// |t| ≤ 0.02, computed with 50 digits; relative error below 8e-15 there.
const PHI: [f64; 7] = [
    0.5,
    -0.3750000000013755,
    0.3125000000012991,
    -0.27343747249067285,
    0.2460937240188067,
    -0.22572346562446355,
    0.20960254454644783,
];

impl GridLaw for BondStretch {
    const REACH: f64 = 0.02;

    /// t = η·(2ξ+η)/|ξ|².
    #[inline(always)]
    fn strain<T: Lanes, const D: usize>(offset: &Offset<D>, eta: [T; D]) -> T {
        let mut growth = eta[0] * (T::splat(offset.twice_xi[0]) + eta[0]);
        for c in 1..D {
            growth = eta[c].mul_add(T::splat(offset.twice_xi[c]) + eta[c], growth);
        }
        growth * T::splat(offset.inverse_square)
    }

    /// (c α κ V/|ξ|) φ(t) (ξ+η), with φ(t) = 1 − (1+t)^(−1/2) = 1 − |ξ|/|ξ+η|.
    #[inline(always)]
    fn add_force<T: Lanes, const D: usize>(
        offset: &Offset<D>,
        eta: [T; D],
        t: T,
        sum: &mut [T; D],
    ) {
        let mut phi = T::splat(PHI[6]);
        for k in (0..6).rev() {
            phi = phi.mul_add(t, T::splat(PHI[k]));
        }
        let pull = t * T::splat(offset.factor) * phi;
        for c in 0..D {
            sum[c] = pull.mul_add(T::splat(offset.xi[c]) + eta[c], sum[c]);
        }
    }
}

impl GridLaw for LinearBond {
    const REACH: f64 = f64::INFINITY;

    /// t = ξ·η/|ξ|².
    #[inline(always)]
    fn strain<T: Lanes, const D: usize>(offset: &Offset<D>, eta: [T; D]) -> T {
        let mut along = eta[0] * T::splat(offset.xi[0]);
        for c in 1..D {
            along = eta[c].mul_add(T::splat(offset.xi[c]), along);
        }
        along * T::splat(offset.inverse_square)
    }

    /// (c α κ V/|ξ|) t ξ.
    #[inline(always)]
    fn add_force<T: Lanes, const D: usize>(
        offset: &Offset<D>,
        _eta: [T; D],
        t: T,
        sum: &mut [T; D],
    ) {
        let pull = t * T::splat(offset.factor);
        for c in 0..D {
            sum[c] = pull.mul_add(T::splat(offset.xi[c]), sum[c]);
        }
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
