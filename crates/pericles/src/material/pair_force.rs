//! Interface of pair forces.

use crate::lanes::{Real, dot, vector};

/// Pair force of a bond with reference vector ξ, relative displacement η and stiffness k = c α(|ξ|) = 1.
///
/// Each law has one generic implementation for one bond or eight lanes (see [`Real`]), inlined into the loops
/// of the force kernels. Mark its functions `#[inline(always)]`: calls that are not inlined are several times
/// slower.
pub trait PairForce: Copy + Default + Send + Sync + 'static {
    /// Whether the force is linear in η.
    const LINEAR: bool;

    /// Whether the force is s n with the stretch s of [`PairForce::stretch`] and a unit vector n with ds =
    /// n·dη/|ξ|. Only such laws support softening ([`Softening`](super::Softening)).
    const OF_STRETCH: bool = false;

    /// Returns the force s n on the point from which the bond starts.
    fn force<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D];

    /// Returns the energy ½ s² |ξ|, whose gradient in η is the force.
    fn energy<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T;

    /// Returns the derivative of the force in the direction d.
    fn tangent<T: Real, const D: usize>(xi: [T; D], eta: [T; D], d: [T; D]) -> [T; D];

    /// Returns (m, r²) such that the stretch of the bond exceeds s if m > threshold(s) r². The measure needs
    /// no square root and is bitwise the same from both end points.
    ///
    /// The default measures the elongation: m = |ξ+η|² − |ξ|², r = |ξ|, threshold(s) = (1 + s)² − 1.
    #[inline(always)]
    fn stretch_measure<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> (T, T) {
        (dot(eta, vector(|c| xi[c] + xi[c] + eta[c])), dot(xi, xi))
    }

    /// Returns the threshold of [`PairForce::stretch_measure`] for a stretch.
    fn threshold(stretch: f64) -> f64 {
        stretch * (2.0 + stretch)
    }

    /// Returns the stretch s of a bond with m = t r², the inverse of [`PairForce::threshold`]; bitwise the
    /// same from both end points.
    #[inline(always)]
    fn stretch<T: Real>(t: T) -> T {
        let one = T::splat(1.0);
        t / (one + (one + t).sqrt())
    }
}
