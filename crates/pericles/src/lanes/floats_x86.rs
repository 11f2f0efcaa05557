//! Sixteen floats in registers of the vector extensions of x86-64. The rules of [`super::doubles_x86`] apply here
//! too.

use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::floats::{FLOATS, FloatLanes};
use super::numbers::{LANES, Real, Vector};

/// Sixteen floats in one 512-bit register.
#[derive(Clone, Copy)]
pub(crate) struct Avx512x16(__m512);

/// Sixteen floats in two 256-bit registers, one for each chunk.
#[derive(Clone, Copy)]
pub(crate) struct Avx2x16(__m256, __m256);

macro_rules! arithmetic {
    ($trait:ident, $method:ident, $wide:ident, $half:ident) => {
        impl $trait for Avx512x16 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: used in functions compiled for AVX-512 only.
                Self(unsafe { $wide(self.0, other.0) })
            }
        }

        impl $trait for Avx2x16 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: used in functions compiled for AVX2 only.
                unsafe { Self($half(self.0, other.0), $half(self.1, other.1)) }
            }
        }
    };
}
arithmetic!(Add, add, _mm512_add_ps, _mm256_add_ps);
arithmetic!(Sub, sub, _mm512_sub_ps, _mm256_sub_ps);
arithmetic!(Mul, mul, _mm512_mul_ps, _mm256_mul_ps);
arithmetic!(Div, div, _mm512_div_ps, _mm256_div_ps);

impl Neg for Avx512x16 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: used in functions compiled for AVX-512 (DQ) only.
        Self(unsafe { _mm512_xor_ps(self.0, _mm512_set1_ps(-0.0)) })
    }
}

impl Neg for Avx2x16 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: used in functions compiled for AVX2 only.
        unsafe {
            let sign = _mm256_set1_ps(-0.0);
            Self(_mm256_xor_ps(self.0, sign), _mm256_xor_ps(self.1, sign))
        }
    }
}

impl Real for Avx512x16 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::broadcast(value as f32)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: used in functions compiled for AVX-512 only.
        Self(unsafe { _mm512_sqrt_ps(self.0) })
    }
}

impl Real for Avx2x16 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::broadcast(value as f32)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: used in functions compiled for AVX2 only.
        unsafe { Self(_mm256_sqrt_ps(self.0), _mm256_sqrt_ps(self.1)) }
    }
}

impl Vector for Avx512x16 {
    type Mask = u16;
    const EPSILON: f64 = f32::EPSILON as f64;
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: used in functions compiled for AVX-512 only; so below.
        Self(unsafe { _mm512_fmadd_ps(self.0, factor.0, addend.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see mul_add.
        Self(unsafe { _mm512_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see mul_add.
        Self(unsafe { _mm512_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn masked(self, mask: u16) -> Self {
        // SAFETY: see mul_add.
        Self(unsafe { _mm512_maskz_mov_ps(mask, self.0) })
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u16 {
        // SAFETY: see mul_add.
        unsafe { _mm512_cmp_ps_mask::<_CMP_GT_OQ>(self.0, other.0) }
    }
}

impl FloatLanes for Avx512x16 {
    #[inline(always)]
    fn broadcast(number: f32) -> Self {
        // SAFETY: used in functions compiled for AVX-512 only.
        Self(unsafe { _mm512_set1_ps(number) })
    }
    #[inline(always)]
    fn load_two(numbers: &[f32], at: [usize; 2]) -> Self {
        let (low, high) = (&numbers[at[0]..][..LANES], &numbers[at[1]..][..LANES]);
        // SAFETY: both slices hold eight numbers.
        unsafe {
            let low = _mm512_castps256_ps512(_mm256_loadu_ps(low.as_ptr()));
            Self(_mm512_insertf32x8::<1>(low, _mm256_loadu_ps(high.as_ptr())))
        }
    }
    #[inline(always)]
    fn to_floats(self) -> [f32; FLOATS] {
        let mut numbers = [0.0; FLOATS];
        // SAFETY: the array holds sixteen numbers.
        unsafe { _mm512_storeu_ps(numbers.as_mut_ptr(), self.0) };
        numbers
    }
}

/// Eight signed bytes per byte, all bits of one set where the byte has a bit; widened to words when used.
static BYTES: [[i8; LANES]; 256] = {
    let mut table = [[0; LANES]; 256];
    let mut bits = 0;
    while bits < 256 {
        let mut k = 0;
        while k < LANES {
            if bits >> k & 1 == 1 {
                table[bits][k] = -1;
            }
            k += 1;
        }
        bits += 1;
    }
    table
};

/// Returns the register with the lanes of a byte; the others are zero.
#[inline(always)]
fn kept(numbers: __m256, byte: u8) -> __m256 {
    let words = &BYTES[usize::from(byte)];
    // SAFETY: eight bytes are loaded; used in functions compiled for AVX2 only.
    unsafe {
        let words = _mm256_cvtepi8_epi32(_mm_loadl_epi64(words.as_ptr().cast()));
        _mm256_and_ps(numbers, _mm256_castsi256_ps(words))
    }
}

impl Vector for Avx2x16 {
    type Mask = u16;
    const EPSILON: f64 = f32::EPSILON as f64;
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: used in functions compiled for AVX2 with FMA only; so below.
        unsafe {
            Self(
                _mm256_fmadd_ps(self.0, factor.0, addend.0),
                _mm256_fmadd_ps(self.1, factor.1, addend.1),
            )
        }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see mul_add.
        unsafe {
            Self(
                _mm256_max_ps(self.0, other.0),
                _mm256_max_ps(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see mul_add.
        unsafe {
            Self(
                _mm256_min_ps(self.0, other.0),
                _mm256_min_ps(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn masked(self, mask: u16) -> Self {
        Self(
            kept(self.0, mask as u8),
            kept(self.1, (mask >> LANES) as u8),
        )
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u16 {
        // SAFETY: see mul_add.
        unsafe {
            let low = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(self.0, other.0));
            let high = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(self.1, other.1));
            (low | high << LANES) as u16
        }
    }
}

impl FloatLanes for Avx2x16 {
    #[inline(always)]
    fn broadcast(number: f32) -> Self {
        // SAFETY: used in functions compiled for AVX2 only.
        unsafe { Self(_mm256_set1_ps(number), _mm256_set1_ps(number)) }
    }
    #[inline(always)]
    fn load_two(numbers: &[f32], at: [usize; 2]) -> Self {
        let (low, high) = (&numbers[at[0]..][..LANES], &numbers[at[1]..][..LANES]);
        // SAFETY: both slices hold eight numbers.
        unsafe {
            Self(
                _mm256_loadu_ps(low.as_ptr()),
                _mm256_loadu_ps(high.as_ptr()),
            )
        }
    }
    #[inline(always)]
    fn to_floats(self) -> [f32; FLOATS] {
        let mut numbers = [0.0; FLOATS];
        // SAFETY: the array holds sixteen numbers.
        unsafe {
            _mm256_storeu_ps(numbers.as_mut_ptr(), self.0);
            _mm256_storeu_ps(numbers.as_mut_ptr().add(LANES), self.1);
        }
        numbers
    }
}
