//! Pair forces that are polynomials of the relative displacement.

use super::pair_force::PairForce;
use crate::lanes::{Real, dot, vector};

/// (|ζ|² − |ξ|²)/(2|ξ|³) ζ with ζ = ξ+η: proportional to the Green strain of the bond and invariant under
/// rigid motions, with the linearisation of [`LinearBond`](super::LinearBond). In 1D it is the cubic
/// polynomial (2ξ²η + 3ξη² + η³)/(2|ξ|³).
///
/// Softens in compression and is unstable beyond a stretch of −0.42. Source: Coclite et al., Appl. Numer.
/// Math. 155 (2020), equation 58, with ζ in place of the printed η, which would make the initial stiffness
/// negative.
#[derive(Debug, Clone, Copy, Default)]
pub struct GreenBond;

/// (|η| − |ξ|)²/|ξ|³ η: equation 57 of the same paper as printed, for bars. It has the linearisation of the
/// other laws and softens in tension and compression, to zero force at |η| = |ξ|. The objective form, with ζ
/// in place of η, has no linear part.
#[derive(Debug, Clone, Copy, Default)]
pub struct CubicSofteningBond;

/// |ζ|² − |ξ|² = η·(2ξ+η)
#[inline(always)]
fn growth<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
    dot(eta, vector(|c| xi[c] + xi[c] + eta[c]))
}

/// |ξ|³
#[inline(always)]
fn cube<T: Real, const D: usize>(xi: [T; D]) -> T {
    let square = dot(xi, xi);
    square * square.sqrt()
}

impl PairForce for GreenBond {
    const LINEAR: bool = false;

    #[inline(always)]
    fn force<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D] {
        let factor = T::splat(0.5) * growth(xi, eta) / cube(xi);
        vector(|c| factor * (xi[c] + eta[c]))
    }

    #[inline(always)]
    fn energy<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
        let q = growth(xi, eta);
        T::splat(0.125) * q * q / cube(xi)
    }

    #[inline(always)]
    fn tangent<T: Real, const D: usize>(xi: [T; D], eta: [T; D], d: [T; D]) -> [T; D] {
        let zeta: [T; D] = vector(|c| xi[c] + eta[c]);
        let inverse = T::splat(1.0) / cube(xi);
        let across = T::splat(0.5) * growth(xi, eta) * inverse;
        let along = dot(zeta, d) * inverse;
        vector(|c| across * d[c] + along * zeta[c])
    }

    #[inline(always)]
    fn stretch_measure<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> (T, T) {
        (growth(xi, eta), dot(xi, xi))
    }

    fn threshold(stretch: f64) -> f64 {
        stretch * (2.0 + stretch)
    }
}

impl PairForce for CubicSofteningBond {
    const LINEAR: bool = false;

    #[inline(always)]
    fn force<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D] {
        let gap = dot(eta, eta).sqrt() - dot(xi, xi).sqrt();
        let factor = gap * gap / cube(xi);
        vector(|c| factor * eta[c])
    }

    #[inline(always)]
    fn energy<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
        let (r, square) = (dot(xi, xi).sqrt(), dot(eta, eta));
        let e = square.sqrt();
        let sum = T::splat(0.5) * r * r - T::splat(2.0 / 3.0) * r * e + T::splat(0.25) * square;
        square * sum / cube(xi)
    }

    #[inline(always)]
    fn tangent<T: Real, const D: usize>(xi: [T; D], eta: [T; D], d: [T; D]) -> [T; D] {
        let e = dot(eta, eta).sqrt();
        let gap = e - dot(xi, xi).sqrt();
        let inverse = T::splat(1.0) / cube(xi);
        let across = gap * gap * inverse;
        // η (η·d)/|η| vanishes at η = 0.
        let unit = T::splat(1.0) / (e + T::splat(f64::MIN_POSITIVE));
        let along = T::splat(2.0) * gap * inverse * (dot(eta, d) * unit);
        vector(|c| across * d[c] + along * eta[c])
    }

    #[inline(always)]
    fn stretch_measure<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> (T, T) {
        (dot(xi, eta), dot(xi, xi))
    }

    fn threshold(stretch: f64) -> f64 {
        stretch
    }

    #[inline(always)]
    fn stretch<T: Real>(t: T) -> T {
        t
    }
}
