//! Traits of scalar and vector numbers in the inner loops.

use std::ops::{Add, Div, Index, IndexMut, Mul, Neg, Sub};

/// Number of lanes: bonds and points are stored and computed in groups of eight.
pub const LANES: usize = 8;

/// Four numbers of a point that one load reads; aligned, so that no row crosses a cache line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C, align(32))]
pub struct Row(pub [f64; 4]);

impl Index<usize> for Row {
    type Output = f64;
    #[inline(always)]
    fn index(&self, c: usize) -> &f64 {
        &self.0[c]
    }
}

impl IndexMut<usize> for Row {
    #[inline(always)]
    fn index_mut(&mut self, c: usize) -> &mut f64 {
        &mut self.0[c]
    }
}

/// Arithmetic of the inner loops.
pub trait Real:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The same number in every lane.
    fn splat(value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
}

impl Real for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
}

/// A vector of numbers in whole registers of an instruction set.
pub trait Vector: Real {
    /// One bit per lane.
    type Mask: Copy + Default + PartialEq;
    /// Relative rounding error of one number.
    const EPSILON: f64;
    /// self · factor + addend, rounded once where the set has a fused instruction.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// Larger number of each pair; `other` if one of them is NaN.
    fn max(self, other: Self) -> Self;
    /// Smaller number of each pair; `other` if one of them is NaN.
    fn min(self, other: Self) -> Self;
    /// Returns the lanes whose bit is set in `mask`, and zero in the others, even if they are NaN.
    fn masked(self, mask: Self::Mask) -> Self;
    /// Returns one bit per lane: self > other. NaN compares false.
    fn greater(self, other: Self) -> Self::Mask;
}

/// A vector of eight doubles.
pub trait Lanes: Vector<Mask = u8> {
    /// Loads eight numbers starting at `numbers[at]`.
    ///
    /// # Panics
    /// If the slice ends before.
    fn load(numbers: &[f64], at: usize) -> Self;
    /// Loads eight floats starting at `numbers[at]` and converts them to doubles.
    ///
    /// # Panics
    /// If the slice ends before.
    fn load_floats(numbers: &[f32], at: usize) -> Self;
    /// Gathers eight rows and transposes them: entry c of the result contains number c of each row.
    ///
    /// # Safety
    /// Every index is below `rows.len()`.
    unsafe fn gather(rows: &[Row], indices: [usize; LANES]) -> [Self; 4];
    /// Returns 1/√self to round-off.
    fn inverse_root(self) -> Self;
    /// Returns the numbers in order.
    fn to_array(self) -> [f64; LANES];
}

/// Returns the vector whose component c is `component(c)`.
///
/// `std::array::from_fn` is not always inlined, and a copy that is called uses baseline instructions.
#[inline(always)]
pub fn vector<T: Real, const D: usize>(mut component: impl FnMut(usize) -> T) -> [T; D] {
    let mut vector = [T::splat(0.0); D];
    for c in 0..D {
        vector[c] = component(c);
    }
    vector
}

/// Σ a_c b_c.
#[inline(always)]
pub fn dot<T: Real, const D: usize>(a: [T; D], b: [T; D]) -> T {
    let mut sum = a[0] * b[0];
    for c in 1..D {
        sum = sum + a[c] * b[c];
    }
    sum
}
