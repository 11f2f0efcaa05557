//! Eight doubles as an array, for every instruction set.

use super::lanewise::lanewise;
use super::numbers::{LANES, Lanes, Real, Row, Vector, vector};

/// Eight doubles.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct F64x8(pub [f64; LANES]);

impl F64x8 {
    /// Makes the lanes from a function of their index.
    #[inline(always)]
    pub fn from_fn(mut number: impl FnMut(usize) -> f64) -> Self {
        let mut lanes = [0.0; LANES];
        for k in 0..LANES {
            lanes[k] = number(k);
        }
        Self(lanes)
    }

    /// Returns the lanes whose bit is set in `mask`, and zero in the others, even if they are NaN.
    #[inline(always)]
    pub fn masked(self, mask: u8) -> Self {
        Self::from_fn(|k| if mask >> k & 1 == 1 { self.0[k] } else { 0.0 })
    }

    /// Returns one bit per lane: self > other. NaN compares false.
    #[inline(always)]
    pub fn greater(self, other: Self) -> u8 {
        let mut mask = 0;
        for k in 0..LANES {
            mask |= u8::from(self.0[k] > other.0[k]) << k;
        }
        mask
    }

    /// Returns the sum of the lanes, in a fixed order.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let a = self.0;
        ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]))
    }
}

lanewise!(F64x8);

impl Real for F64x8 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value; LANES])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::from_fn(|k| self.0[k].sqrt())
    }
}

impl Vector for F64x8 {
    type Mask = u8;
    const EPSILON: f64 = f64::EPSILON;
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    lanewise!(max and min);
    #[inline(always)]
    fn masked(self, mask: u8) -> Self {
        F64x8::masked(self, mask)
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u8 {
        F64x8::greater(self, other)
    }
}

impl Lanes for F64x8 {
    #[inline(always)]
    fn load(numbers: &[f64], at: usize) -> Self {
        let numbers = &numbers[at..at + LANES];
        Self::from_fn(|k| numbers[k])
    }
    #[inline(always)]
    fn load_floats(numbers: &[f32], at: usize) -> Self {
        let numbers = &numbers[at..at + LANES];
        Self::from_fn(|k| f64::from(numbers[k]))
    }
    #[inline(always)]
    unsafe fn gather(rows: &[Row], indices: [usize; LANES]) -> [Self; 4] {
        vector(|c| Self::from_fn(|k| rows[indices[k]][c]))
    }
    #[inline(always)]
    fn inverse_root(self) -> Self {
        Self::splat(1.0) / self.sqrt()
    }
    #[inline(always)]
    fn to_array(self) -> [f64; LANES] {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masked_lanes_and_comparisons() {
        let numbers = F64x8([1.0, f64::NAN, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
        assert_eq!(numbers.masked(0b1000_0101).sum(), 12.0);
        assert_eq!(numbers.greater(F64x8::splat(4.5)), 0b1111_0000);
    }
}
