//! Sixteen floats as an array, for every instruction set.

use super::floats::{FLOATS, FloatLanes};
use super::lanewise::lanewise;
use super::numbers::{LANES, Real, Vector};

/// Sixteen floats.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct F32x16([f32; FLOATS]);

impl F32x16 {
    #[inline(always)]
    fn from_fn(mut number: impl FnMut(usize) -> f32) -> Self {
        let mut lanes = [0.0; FLOATS];
        for k in 0..FLOATS {
            lanes[k] = number(k);
        }
        Self(lanes)
    }
}

lanewise!(F32x16);

impl Real for F32x16 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([value as f32; FLOATS])
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::from_fn(|k| self.0[k].sqrt())
    }
}

impl Vector for F32x16 {
    type Mask = u16;
    const EPSILON: f64 = f32::EPSILON as f64;
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }
    lanewise!(max and min);
    #[inline(always)]
    fn masked(self, mask: u16) -> Self {
        Self::from_fn(|k| if mask >> k & 1 == 1 { self.0[k] } else { 0.0 })
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u16 {
        let mut mask = 0;
        for k in 0..FLOATS {
            mask |= u16::from(self.0[k] > other.0[k]) << k;
        }
        mask
    }
}

impl FloatLanes for F32x16 {
    #[inline(always)]
    fn broadcast(number: f32) -> Self {
        Self([number; FLOATS])
    }
    #[inline(always)]
    fn load_two(numbers: &[f32], at: [usize; 2]) -> Self {
        let (low, high) = (&numbers[at[0]..][..LANES], &numbers[at[1]..][..LANES]);
        Self::from_fn(|k| if k < LANES { low[k] } else { high[k - LANES] })
    }
    #[inline(always)]
    fn to_floats(self) -> [f32; FLOATS] {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masked_lanes_and_comparisons() {
        let numbers = F32x16::from_fn(|k| if k == 1 { f32::NAN } else { k as f32 });
        let kept = numbers.masked(0b1000_0000_0000_1001).to_floats();
        assert_eq!(kept.iter().sum::<f32>(), 18.0);
        assert_eq!(numbers.greater(F32x16::splat(4.5)), 0b1111_1111_1110_0000);
    }

    #[test]
    fn chunks_are_loaded_from_two_positions() {
        let numbers: Vec<f32> = (0..40).map(|k| k as f32).collect();
        let found = F32x16::load_two(&numbers, [3, 30]).to_floats();
        assert_eq!(
            (found[0], found[7], found[8], found[15]),
            (3.0, 10.0, 30.0, 37.0)
        );
    }
}
