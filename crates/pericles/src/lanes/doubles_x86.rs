//! Eight doubles in registers of the vector extensions of x86-64.
//!
//! These types may only be used in functions compiled for their instruction set. `for_each_instruction_set` ensures
//! this: only it names them, and it calls such a function only after [`super::InstructionSet::detect`] has found
//! the set.
//!
//! This file and the loops that use these types contain no closures or iterator adapters: compilers inline them at
//! their discretion, and a copy that is called uses baseline instructions and passes all registers through memory.
//! `.ci/inlined.sh` searches for such calls.

use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::numbers::{LANES, Lanes, Real, Row, Vector};

/// Eight doubles in one 512-bit register.
#[derive(Clone, Copy)]
pub struct Avx512x8(__m512d);

/// Eight doubles in two 256-bit registers.
#[derive(Clone, Copy)]
pub struct Avx2x8(__m256d, __m256d);

macro_rules! arithmetic {
    ($trait:ident, $method:ident, $wide:ident, $half:ident) => {
        impl $trait for Avx512x8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: used in functions compiled for AVX-512 only.
                Self(unsafe { $wide(self.0, other.0) })
            }
        }

        impl $trait for Avx2x8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: used in functions compiled for AVX2 only.
                unsafe { Self($half(self.0, other.0), $half(self.1, other.1)) }
            }
        }
    };
}
arithmetic!(Add, add, _mm512_add_pd, _mm256_add_pd);
arithmetic!(Sub, sub, _mm512_sub_pd, _mm256_sub_pd);
arithmetic!(Mul, mul, _mm512_mul_pd, _mm256_mul_pd);
arithmetic!(Div, div, _mm512_div_pd, _mm256_div_pd);

impl Neg for Avx512x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: used in functions compiled for AVX-512 (DQ) only.
        Self(unsafe { _mm512_xor_pd(self.0, _mm512_set1_pd(-0.0)) })
    }
}

impl Neg for Avx2x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: used in functions compiled for AVX2 only.
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            Self(_mm256_xor_pd(self.0, sign), _mm256_xor_pd(self.1, sign))
        }
    }
}

impl Real for Avx512x8 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: used in functions compiled for AVX-512 only.
        Self(unsafe { _mm512_set1_pd(value) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: as above.
        Self(unsafe { _mm512_sqrt_pd(self.0) })
    }
}

impl Real for Avx2x8 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        // SAFETY: used in functions compiled for AVX2 only.
        unsafe { Self(_mm256_set1_pd(value), _mm256_set1_pd(value)) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: as above.
        unsafe { Self(_mm256_sqrt_pd(self.0), _mm256_sqrt_pd(self.1)) }
    }
}

/// Loads the four numbers of a row.
///
/// # Safety
/// The index is below `rows.len()`, and the caller is compiled for AVX2.
#[inline(always)]
unsafe fn four(rows: &[Row], index: usize) -> __m256d {
    // SAFETY: a row holds four numbers and is aligned to their size.
    unsafe { _mm256_load_pd(rows.get_unchecked(index).0.as_ptr()) }
}

/// Loads two rows into one register.
///
/// # Safety
/// The indices are below `rows.len()`, and the caller is compiled for AVX-512.
#[inline(always)]
unsafe fn pair(rows: &[Row], a: usize, b: usize) -> __m512d {
    // SAFETY: as the caller has promised.
    unsafe { _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(four(rows, a)), four(rows, b)) }
}

/// Transposes four rows: register c contains number c of each row.
///
/// # Safety
/// The indices are below `rows.len()`, and the caller is compiled for AVX2.
#[inline(always)]
unsafe fn turned(rows: &[Row], a: usize, b: usize, c: usize, d: usize) -> [__m256d; 4] {
    // SAFETY: as the caller has promised.
    unsafe {
        let (r0, r1, r2, r3) = (four(rows, a), four(rows, b), four(rows, c), four(rows, d));
        let (xz0, y0) = (_mm256_unpacklo_pd(r0, r1), _mm256_unpackhi_pd(r0, r1));
        let (xz2, y2) = (_mm256_unpacklo_pd(r2, r3), _mm256_unpackhi_pd(r2, r3));
        [
            _mm256_permute2f128_pd::<0x20>(xz0, xz2),
            _mm256_permute2f128_pd::<0x20>(y0, y2),
            _mm256_permute2f128_pd::<0x31>(xz0, xz2),
            _mm256_permute2f128_pd::<0x31>(y0, y2),
        ]
    }
}

/// Returns 1/√x from an estimate y with at least eleven correct bits: y (1 − e)^(−1/2) with e = 1 − x y², as a
/// series whose next term is below round-off.
#[inline(always)]
fn refined<T: Lanes>(x: T, seed: T) -> T {
    let e = (-(x * seed)).mul_add(seed, T::splat(1.0));
    let mut series = T::splat(35.0 / 128.0);
    for coefficient in [5.0 / 16.0, 3.0 / 8.0, 1.0 / 2.0] {
        series = series.mul_add(e, T::splat(coefficient));
    }
    (seed * e).mul_add(series, seed)
}

impl Vector for Avx512x8 {
    type Mask = u8;
    const EPSILON: f64 = f64::EPSILON;
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: used in functions compiled for AVX-512 only; so below.
        Self(unsafe { _mm512_fmadd_pd(self.0, factor.0, addend.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see mul_add.
        Self(unsafe { _mm512_max_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see mul_add.
        Self(unsafe { _mm512_min_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn masked(self, mask: u8) -> Self {
        // SAFETY: see mul_add.
        Self(unsafe { _mm512_maskz_mov_pd(mask, self.0) })
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u8 {
        // SAFETY: see mul_add.
        unsafe { _mm512_cmp_pd_mask::<_CMP_GT_OQ>(self.0, other.0) }
    }
}

impl Lanes for Avx512x8 {
    #[inline(always)]
    fn load(numbers: &[f64], at: usize) -> Self {
        let numbers = &numbers[at..at + LANES];
        // SAFETY: the slice holds eight numbers.
        Self(unsafe { _mm512_loadu_pd(numbers.as_ptr()) })
    }
    #[inline(always)]
    fn load_floats(numbers: &[f32], at: usize) -> Self {
        let numbers = &numbers[at..at + LANES];
        // SAFETY: the slice holds eight numbers.
        Self(unsafe { _mm512_cvtps_pd(_mm256_loadu_ps(numbers.as_ptr())) })
    }
    /// Loads eight rows of four in pairs and transposes them with eleven shuffles: fewer loads than three gathers,
    /// each within a cache line.
    #[inline(always)]
    unsafe fn gather(rows: &[Row], indices: [usize; LANES]) -> [Self; 4] {
        // SAFETY: the indices are in range, as the caller has promised.
        unsafe {
            let r04 = pair(rows, indices[0], indices[4]);
            let r15 = pair(rows, indices[1], indices[5]);
            let r26 = pair(rows, indices[2], indices[6]);
            let r37 = pair(rows, indices[3], indices[7]);
            let (xz0, y0) = (_mm512_unpacklo_pd(r04, r15), _mm512_unpackhi_pd(r04, r15));
            let (xz2, y2) = (_mm512_unpacklo_pd(r26, r37), _mm512_unpackhi_pd(r26, r37));
            let low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
            let high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
            [
                Self(_mm512_permutex2var_pd(xz0, low, xz2)),
                Self(_mm512_permutex2var_pd(y0, low, y2)),
                Self(_mm512_permutex2var_pd(xz0, high, xz2)),
                Self(_mm512_permutex2var_pd(y0, high, y2)),
            ]
        }
    }
    #[inline(always)]
    fn inverse_root(self) -> Self {
        // SAFETY: used in functions compiled for AVX-512 only.
        let seed = Self(unsafe { _mm512_rsqrt14_pd(self.0) });
        refined(self, seed)
    }
    #[inline(always)]
    fn to_array(self) -> [f64; LANES] {
        let mut numbers = [0.0; LANES];
        // SAFETY: the array holds eight numbers.
        unsafe { _mm512_storeu_pd(numbers.as_mut_ptr(), self.0) };
        numbers
    }
}

/// Four words per nibble, all bits of a word set where the nibble has a bit.
static NIBBLES: [[u64; 4]; 16] = {
    let mut table = [[0; 4]; 16];
    let mut bits = 0;
    while bits < 16 {
        let mut k = 0;
        while k < 4 {
            if bits >> k & 1 == 1 {
                table[bits][k] = u64::MAX;
            }
            k += 1;
        }
        bits += 1;
    }
    table
};

/// Returns the half register with the lanes of a nibble; the others are zero.
#[inline(always)]
fn kept(half: __m256d, nibble: u8) -> __m256d {
    let words = &NIBBLES[usize::from(nibble)];
    // SAFETY: four words are loaded; used in functions compiled for AVX2 only.
    unsafe { _mm256_and_pd(half, _mm256_loadu_pd(words.as_ptr().cast())) }
}

impl Vector for Avx2x8 {
    type Mask = u8;
    const EPSILON: f64 = f64::EPSILON;
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        // SAFETY: used in functions compiled for AVX2 with FMA only; so below.
        unsafe {
            Self(
                _mm256_fmadd_pd(self.0, factor.0, addend.0),
                _mm256_fmadd_pd(self.1, factor.1, addend.1),
            )
        }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see mul_add.
        unsafe {
            Self(
                _mm256_max_pd(self.0, other.0),
                _mm256_max_pd(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see mul_add.
        unsafe {
            Self(
                _mm256_min_pd(self.0, other.0),
                _mm256_min_pd(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn masked(self, mask: u8) -> Self {
        Self(kept(self.0, mask & 0xF), kept(self.1, mask >> 4))
    }
    #[inline(always)]
    fn greater(self, other: Self) -> u8 {
        // SAFETY: see mul_add.
        unsafe {
            let low = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(self.0, other.0));
            let high = _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_GT_OQ>(self.1, other.1));
            (low | high << 4) as u8
        }
    }
}

impl Lanes for Avx2x8 {
    #[inline(always)]
    fn load(numbers: &[f64], at: usize) -> Self {
        let numbers = &numbers[at..at + LANES];
        // SAFETY: the slice holds eight numbers.
        unsafe {
            Self(
                _mm256_loadu_pd(numbers.as_ptr()),
                _mm256_loadu_pd(numbers.as_ptr().add(LANES / 2)),
            )
        }
    }
    #[inline(always)]
    fn load_floats(numbers: &[f32], at: usize) -> Self {
        let numbers = &numbers[at..at + LANES];
        // SAFETY: the slice holds eight numbers.
        unsafe {
            Self(
                _mm256_cvtps_pd(_mm_loadu_ps(numbers.as_ptr())),
                _mm256_cvtps_pd(_mm_loadu_ps(numbers.as_ptr().add(LANES / 2))),
            )
        }
    }
    #[inline(always)]
    unsafe fn gather(rows: &[Row], indices: [usize; LANES]) -> [Self; 4] {
        // SAFETY: the indices are in range, as the caller has promised.
        unsafe {
            let low = turned(rows, indices[0], indices[1], indices[2], indices[3]);
            let high = turned(rows, indices[4], indices[5], indices[6], indices[7]);
            [
                Self(low[0], high[0]),
                Self(low[1], high[1]),
                Self(low[2], high[2]),
                Self(low[3], high[3]),
            ]
        }
    }
    #[inline(always)]
    fn inverse_root(self) -> Self {
        // SAFETY: used in functions compiled for AVX2 only.
        let seed = unsafe {
            let half = |x: __m256d| _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(x)));
            Self(half(self.0), half(self.1))
        };
        refined(self, seed)
    }
    #[inline(always)]
    fn to_array(self) -> [f64; LANES] {
        let mut numbers = [0.0; LANES];
        // SAFETY: the array holds eight numbers.
        unsafe {
            _mm256_storeu_pd(numbers.as_mut_ptr(), self.0);
            _mm256_storeu_pd(numbers.as_mut_ptr().add(LANES / 2), self.1);
        }
        numbers
    }
}
