//! The numbers a lattice body's loops compute in: doubles, one chunk at a time, or floats, two.
//!
//! Floats are displacements in spacings, relative to one point's: bond vectors are then small integers, which floats hold exactly, and
//! neither a far flight nor a tiny body costs digits or range.

use crate::lanes::LANES;
#[cfg(target_arch = "x86_64")]
use crate::lanes::floats_x86::{Avx2x16, Avx512x16};
use crate::lanes::{F32x16, FloatLanes};
use crate::lanes::{Lanes, Vector};

/// What memory holds.
pub(in crate::operator) trait GridNumber:
    Copy + Default + Send + Sync + Into<f64>
{
    /// A displacement in m, of which floats keep the difference from `origin`, in units.
    fn of(displacement: f64, origin: f64, per_unit: f64) -> Self;
    /// A number of the stencil.
    fn rounded(value: f64) -> Self;
    /// Eight of them as doubles.
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

/// Lanes that take one chunk or two.
pub(super) trait ChunkLanes: Vector {
    /// What memory holds.
    type Number: GridNumber;
    /// Doubles of the same instruction set, for what must not be rounded twice.
    type Wide: Lanes;
    /// Places of the chunks' first nodes.
    type Places: Copy;
    /// Which bonds of the chunks are there, a byte per chunk and offset.
    type Bonds<'a>: Copy;
    /// Chunks taken together.
    const CHUNKS: usize;
    /// Relative error that the strain of a bond may have beside a rotation of order one.
    const STRAIN_ERROR: f64;

    /// The same number in every lane.
    fn broadcast(number: Self::Number) -> Self;
    /// The places of the first chunk and of the last one.
    fn places(first: usize, last: usize) -> Self::Places;
    /// The numbers of the nodes `shift` places away.
    fn at(numbers: &[Self::Number], places: Self::Places, shift: isize) -> Self;
    /// The rows of as many bytes as there are offsets, one or two of them.
    fn bonds(intact: &[u8], offsets: usize) -> Self::Bonds<'_>;
    /// The bonds of an offset.
    fn present(bonds: Self::Bonds<'_>, offset: usize) -> Self::Mask;
    /// Whether there are none.
    fn none(mask: Self::Mask) -> bool;
    /// Those in either.
    fn either(a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// The other lanes.
    fn others(mask: Self::Mask) -> Self::Mask;
    /// The bits of a chunk.
    fn of_chunk(mask: Self::Mask, chunk: usize) -> u8;
    /// The numbers of a chunk, in order.
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

/// The bonds of two chunks; the second may be none, and is then the first with no bond kept.
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
two_chunks!(F32x16, crate::lanes::F64x8);
#[cfg(target_arch = "x86_64")]
two_chunks!(Avx2x16, crate::lanes::doubles_x86::Avx2x8);
#[cfg(target_arch = "x86_64")]
two_chunks!(Avx512x16, crate::lanes::doubles_x86::Avx512x8);
