//! Number types of the stencil loops: doubles, one chunk at a time, or floats, two chunks at a time.
//!
//! Displacements in floats are relative to one point and in units of the spacing. Bond vectors are then small
//! integers, which floats represent exactly, and neither large rigid displacements nor small bodies cost
//! digits or range.

use crate::lanes::LANES;
#[cfg(target_arch = "x86_64")]
use crate::lanes::floats_x86::{Avx2x16, Avx512x16};
use crate::lanes::{Baseline8, Baseline16, FloatLanes};
use crate::lanes::{Lanes, Vector};

/// Number type in memory.
pub(in crate::operator) trait GridNumber:
    Copy + Default + Send + Sync + Into<f64>
{
    /// Converts a displacement in m; floats store the difference from `origin` in units of length.
    fn of(displacement: f64, origin: f64, per_unit: f64) -> Self;
    /// Converts a number of the stencil.
    fn rounded(value: f64) -> Self;
    /// Loads eight numbers as doubles.
    fn load<T: Lanes>(numbers: &[Self], at: usize) -> T;
}

impl GridNumber for f64 {
    #[inline(always)]
    fn of(displacement: f64, _origin: f64, _per_unit: f64) -> Self {
        displacement
    }
    #[inline(always)]
    fn rounded(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn load<T: Lanes>(numbers: &[Self], at: usize) -> T {
        T::load(numbers, at)
    }
}

impl GridNumber for f32 {
    #[inline(always)]
    fn of(displacement: f64, origin: f64, per_unit: f64) -> Self {
        ((displacement - origin) * per_unit) as f32
    }
    #[inline(always)]
    fn rounded(value: f64) -> Self {
        value as f32
    }
    #[inline(always)]
    fn load<T: Lanes>(numbers: &[Self], at: usize) -> T {
        T::load_floats(numbers, at)
    }
}

/// Lanes of one or two chunks.
pub(super) trait ChunkLanes: Vector {
    /// Number type in memory.
    type Number: GridNumber;
    /// Doubles of the same instruction set, for data that must not be rounded twice.
    type Wide: Lanes;
    /// Places of the first nodes of the chunks.
    type Places: Copy;
    /// Existing bonds of the chunks, one byte per chunk and offset.
    type Bonds<'a>: Copy;
    /// Number of chunks computed together.
    const CHUNKS: usize;
    /// Error of the strain of a bond under a rotation of order one.
    const STRAIN_ERROR: f64;

    /// Returns the same number in all lanes.
    fn broadcast(number: Self::Number) -> Self;
    /// Returns the places of the first and last chunk.
    fn places(first: usize, last: usize) -> Self::Places;
    /// Loads the numbers of the nodes at a distance of `shift` places.
    fn at(numbers: &[Self::Number], places: Self::Places, shift: isize) -> Self;
    /// Splits bytes into one or two rows of `offsets` bytes.
    fn bonds(intact: &[u8], offsets: usize) -> Self::Bonds<'_>;
    /// Returns the mask of the bonds of an offset.
    fn present(bonds: Self::Bonds<'_>, offset: usize) -> Self::Mask;
    /// Returns whether the mask is empty.
    fn none(mask: Self::Mask) -> bool;
    /// Returns the union of two masks.
    fn either(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Returns the complement of a mask.
    fn others(mask: Self::Mask) -> Self::Mask;
    /// Returns the bits of a chunk.
    fn of_chunk(mask: Self::Mask, chunk: usize) -> u8;
    /// Returns the numbers of a chunk in order.
    fn numbers(self, chunk: usize) -> [f64; LANES];
}

impl<T: Lanes> ChunkLanes for T {
    type Number = f64;
    type Wide = Self;
    type Places = usize;
    type Bonds<'a> = &'a [u8];
    const CHUNKS: usize = 1;
    const STRAIN_ERROR: f64 = 0.0;

    #[inline(always)]
    fn broadcast(number: f64) -> Self {
        T::splat(number)
    }
    #[inline(always)]
    fn places(first: usize, _last: usize) -> usize {
        first
    }
    #[inline(always)]
    fn at(numbers: &[f64], place: usize, shift: isize) -> Self {
        T::load(numbers, place.wrapping_add_signed(shift))
    }
    #[inline(always)]
    fn bonds(intact: &[u8], offsets: usize) -> &[u8] {
        &intact[..offsets]
    }
    #[inline(always)]
    fn present(bonds: &[u8], offset: usize) -> u8 {
        bonds[offset]
    }
    #[inline(always)]
    fn none(mask: u8) -> bool {
        mask == 0
    }
    #[inline(always)]
    fn either(a: u8, b: u8) -> u8 {
        a | b
    }
    #[inline(always)]
    fn others(mask: u8) -> u8 {
        !mask
    }
    #[inline(always)]
    fn of_chunk(mask: u8, _chunk: usize) -> u8 {
        mask
    }
    #[inline(always)]
    fn numbers(self, _chunk: usize) -> [f64; LANES] {
        self.to_array()
    }
}

/// The bonds of two chunks. A missing second chunk is the first one without bonds.
#[derive(Clone, Copy)]
pub(super) struct TwoRows<'a> {
    low: &'a [u8],
    high: &'a [u8],
    kept: u16,
}

macro_rules! two_chunks {
    ($floats:ident, $doubles:path) => {
        impl ChunkLanes for $floats {
            type Number = f32;
            type Wide = $doubles;
            type Places = [usize; 2];
            type Bonds<'a> = TwoRows<'a>;
            const CHUNKS: usize = 2;
            const STRAIN_ERROR: f64 = 2e-6;

            #[inline(always)]
            fn broadcast(number: f32) -> Self {
                FloatLanes::broadcast(number)
            }
            #[inline(always)]
            fn places(first: usize, last: usize) -> [usize; 2] {
                [first, last]
            }
            #[inline(always)]
            fn at(numbers: &[f32], [low, high]: [usize; 2], shift: isize) -> Self {
                let at = [
                    low.wrapping_add_signed(shift),
                    high.wrapping_add_signed(shift),
                ];
                Self::load_two(numbers, at)
            }
            #[inline(always)]
            fn bonds(intact: &[u8], offsets: usize) -> TwoRows<'_> {
                let two = intact.len() >= 2 * offsets;
                TwoRows {
                    low: &intact[..offsets],
                    high: &intact[if two { offsets } else { 0 }..][..offsets],
                    kept: if two { 0xFF00 } else { 0 },
                }
            }
            #[inline(always)]
            fn present(bonds: TwoRows<'_>, offset: usize) -> u16 {
                let high = u16::from(bonds.high[offset]) << LANES;
                u16::from(bonds.low[offset]) | (high & bonds.kept)
            }
            #[inline(always)]
            fn none(mask: u16) -> bool {
                mask == 0
            }
            #[inline(always)]
            fn either(a: u16, b: u16) -> u16 {
                a | b
            }
            #[inline(always)]
            fn others(mask: u16) -> u16 {
                !mask
            }
            #[inline(always)]
            fn of_chunk(mask: u16, chunk: usize) -> u8 {
                (mask >> (LANES * chunk)) as u8
            }
            #[inline(always)]
            fn numbers(self, chunk: usize) -> [f64; LANES] {
                let floats = self.to_floats();
                let mut numbers = [0.0; LANES];
                for k in 0..LANES {
                    numbers[k] = f64::from(floats[LANES * chunk + k]);
                }
                numbers
            }
        }
    };
}
two_chunks!(Baseline16, Baseline8);
#[cfg(target_arch = "x86_64")]
two_chunks!(Avx2x16, crate::lanes::doubles_x86::Avx2x8);
#[cfg(target_arch = "x86_64")]
two_chunks!(Avx512x16, crate::lanes::doubles_x86::Avx512x8);
