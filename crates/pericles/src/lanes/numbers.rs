//! What numbers side by side can do: traits of the hot loops.

use std::ops::{Add, Div, Index, IndexMut, Mul, Neg, Sub};

/// Numbers in a group: bonds and points are stored and computed in groups of eight.
pub const LANES: usize = 8;

/// Four numbers of a point, which one load reads: aligned, so that no row lies across two lines of a cache.
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

/// Arithmetic of the hot loops.
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

/// Numbers side by side, in whole registers of an instruction set.
pub trait Vector: Real {
    /// One bit per lane.
    type Mask: Copy + Default + PartialEq;
    /// Relative rounding error of one number.
    const EPSILON: f64;
    /// self · factor + addend, rounded once where the set has such an instruction.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// The larger of each pair; `other` if one of them is no number.
    fn max(self, other: Self) -> Self;
    /// The smaller of each pair; `other` if one of them is no number.
    fn min(self, other: Self) -> Self;
    /// The lanes whose bit is set in `mask`; zero in the others, whatever they hold.
    fn masked(self, mask: Self::Mask) -> Self;
    /// One bit per lane: self > other. NaN compares false.
    fn greater(self, other: Self) -> Self::Mask;
}

/// Eight doubles side by side.
pub trait Lanes: Vector<Mask = u8> {
    /// The eight numbers from `numbers[at]` on.
    ///
    /// # Panics
    /// If the slice ends before.
    fn load(numbers: &[f64], at: usize) -> Self;
    /// The same of floats.
    ///
    /// # Panics
    /// If the slice ends before.
    fn load_floats(numbers: &[f32], at: usize) -> Self;
    /// The numbers of eight rows, number by number.
    ///
    /// # Safety
    /// Every index is below `rows.len()`.
    unsafe fn gather(rows: &[Row], indices: [usize; LANES]) -> [Self; 4];
    /// 1/√self to round-off.
    fn inverse_root(self) -> Self;
    /// The numbers, in order.
    fn to_array(self) -> [f64; LANES];
}

/// The vector whose component c is `component(c)`.
///
/// `std::array::from_fn` would do, but is not always inlined, and a copy that is not takes the instruction set of the baseline.
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
