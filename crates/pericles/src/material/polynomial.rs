//! Pair forces that are polynomials of the relative displacement.

use super::pair_force::PairForce;
use crate::lanes::{Real, dot, vector};

/// (|ζ|² − |ξ|²)/(2|ξ|³) ζ with ζ = ξ+η: proportional to the bond's Green strain and indifferent to rigid motions; its linearisation is
/// [`LinearBond`](super::LinearBond)'s. In one dimension a cubic, (2ξ²η + 3ξη² + η³)/(2|ξ|³).
///
/// Softens in compression and is unstable there beyond a stretch of −0.42. Source: Coclite et al., Appl. Numer. Math. 155 (2020), equation 58, with ζ where η is
/// printed: as printed the stiffness at rest is negative.
#[derive(Debug, Clone, Copy, Default)]
pub struct GreenBond;

/// (|η| − |ξ|)²/|ξ|³ η: equation 57 of the same paper as it is printed, for bars. Its linearisation is that of the other laws; it softens in tension and compression alike, to
/// nothing at |η| = |ξ|. (With ζ for η, the objective form, the linearisation would vanish.)
#[derive(Debug, Clone, Copy, Default)]
pub struct LiteralBond;

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

impl PairForce for LiteralBond {
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
        // η (η·d)/|η| is nothing where η is.
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
}
