//! Sixteen floats in a vector: half the memory and twice the bonds per instruction, with seven digits.
//!
//! They belong to two independent chunks of eight, so that loops over single chunks process two at a time.

use super::numbers::{LANES, Vector};

/// Count of numbers in two chunks.
pub const FLOATS: usize = 2 * LANES;

/// Sixteen floats of two chunks.
pub trait FloatLanes: Vector<Mask = u16> {
    /// The same number in every lane.
    fn broadcast(number: f32) -> Self;
    /// Loads eight numbers each from two positions.
    ///
    /// # Panics
    /// If the slice ends before.
    fn load_two(numbers: &[f32], at: [usize; 2]) -> Self;
    /// Returns the numbers in order.
    fn to_floats(self) -> [f32; FLOATS];
}
