//! What a pair force is.

use crate::lanes::{Real, dot, vector};

/// The pair force of a bond with reference vector ξ, relative displacement η and unit stiffness k = c α(|ξ|).
///
/// Written once for one bond or eight side by side (see [`Real`]); inlined into the operators' loops. Mark the functions `#[inline(always)]`: what is not inlined there is several times slower.
pub trait PairForce: Copy + Default + Send + Sync + 'static {
    /// Whether the force is linear in η.
    const LINEAR: bool;

    /// The force on the point the bond starts from: s n.
    fn force<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D];

    /// The energy ½ s² |ξ|, whose gradient in η is the force.
    fn energy<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T;

    /// The derivative of the force in the direction d.
    fn tangent<T: Real, const D: usize>(xi: [T; D], eta: [T; D], d: [T; D]) -> [T; D];

    /// A pair (m, r²) such that the bond is stretched beyond s if m > threshold(s) r². No root, and the same bits seen from either end.
    ///
    /// Unless a law says otherwise, bonds break by their elongation: m = |ξ+η|² − |ξ|², r = |ξ|, threshold(s) = (1 + s)² − 1.
    #[inline(always)]
    fn stretch_measure<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> (T, T) {
        (dot(eta, vector(|c| xi[c] + xi[c] + eta[c])), dot(xi, xi))
    }

    /// See [`PairForce::stretch_measure`].
    fn threshold(stretch: f64) -> f64 {
        stretch * (2.0 + stretch)
    }
}
