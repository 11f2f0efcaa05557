//! What a pair force is.

use crate::lanes::Real;

/// The pair force of a bond with reference vector ξ, relative displacement η and unit stiffness k = c α(|ξ|).
///
/// Written once for one bond or eight side by side (see [`Real`]); inlined into the operators' loops.
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
    fn stretch_measure<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> (T, T);

    /// See [`PairForce::stretch_measure`].
    fn threshold(stretch: f64) -> f64;
}
