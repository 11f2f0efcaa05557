//! The baseline of x86-64: eight doubles or sixteen floats in four registers of SSE2, which every x86-64 has.
//!
//! All operations give the bits of [`F64x8`](super::F64x8) and [`F32x16`](super::floats_array::F32x16). With arrays, the compiler
//! would have to find the vectors in eight or sixteen separate operations, which takes much of the time of a build.

use std::arch::x86_64::*;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::floats::{FLOATS, FloatLanes};
use super::numbers::{LANES, Lanes, Real, Row, Vector};

/// Eight doubles.
#[derive(Clone, Copy)]
pub struct Sse2x8(__m128d, __m128d, __m128d, __m128d);

/// Sixteen floats, the first eight of one chunk.
#[derive(Clone, Copy)]
pub(crate) struct Sse2x16(__m128, __m128, __m128, __m128);

/// Applies a function to the four registers of one or two vectors.
macro_rules! each {
    ($f:expr, $a:ident) => {
        // SAFETY: every x86-64 has SSE2; so below.
        unsafe { Self($f($a.0), $f($a.1), $f($a.2), $f($a.3)) }
    };
    ($f:expr, $a:ident, $b:ident) => {
        // SAFETY: as above.
        unsafe {
            Self(
                $f($a.0, $b.0),
                $f($a.1, $b.1),
                $f($a.2, $b.2),
                $f($a.3, $b.3),
            )
        }
    };
}

/// Implements what doubles and floats have in common.
macro_rules! vector_of_four {
    ($lanes:ident, $number:ty, $mask:ty, $width:literal, $table:ident, $operations:tt) => {
        vector_of_four!(@arithmetic $lanes $operations);

        impl Vector for $lanes {
            type Mask = $mask;
            const EPSILON: f64 = <$number>::EPSILON as f64;
            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                self * factor + addend
            }
            vector_of_four!(@vector $operations $mask, $width, $table);
        }
    };
    (@arithmetic $lanes:ident {
        $add:ident $sub:ident $mul:ident $div:ident $xor:ident $set:ident $sqrt:ident
        $max:ident $min:ident $and:ident $greater:ident $bits:ident
    }) => {
        vector_of_four!(@operator $lanes Add add $add);
        vector_of_four!(@operator $lanes Sub sub $sub);
        vector_of_four!(@operator $lanes Mul mul $mul);
        vector_of_four!(@operator $lanes Div div $div);

        impl Neg for $lanes {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                let sign = Self::splat(-0.0);
                each!($xor, self, sign)
            }
        }

        impl Real for $lanes {
            #[inline(always)]
            fn splat(value: f64) -> Self {
                // SAFETY: see each.
                let all = unsafe { $set(value as _) };
                Self(all, all, all, all)
            }
            #[inline(always)]
            fn sqrt(self) -> Self {
                each!($sqrt, self)
            }
        }
    };
    (@operator $lanes:ident $trait:ident $method:ident $operation:ident) => {
        impl $trait for $lanes {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                each!($operation, self, other)
            }
        }
    };
    (@vector {
        $add:ident $sub:ident $mul:ident $div:ident $xor:ident $set:ident $sqrt:ident
        $max:ident $min:ident $and:ident $greater:ident $bits:ident
    } $mask:ty, $width:literal, $table:ident) => {
        #[inline(always)]
        fn max(self, other: Self) -> Self {
            each!($max, self, other)
        }
        #[inline(always)]
        fn min(self, other: Self) -> Self {
            each!($min, self, other)
        }
        #[inline(always)]
        fn masked(self, mask: $mask) -> Self {
            const LAST: usize = (1 << $width) - 1;
            let mask = usize::from(mask);
            let kept = Self(
                $table(mask & LAST),
                $table(mask >> $width & LAST),
                $table(mask >> (2 * $width) & LAST),
                $table(mask >> (3 * $width) & LAST),
            );
            each!($and, self, kept)
        }
        #[inline(always)]
        fn greater(self, other: Self) -> $mask {
            let over: Self = each!($greater, self, other);
            // SAFETY: see each.
            let (low, high) = unsafe {
                (
                    $bits(over.0) | $bits(over.1) << $width,
                    $bits(over.2) | $bits(over.3) << $width,
                )
            };
            (low | high << (2 * $width)) as $mask
        }
    };
}

vector_of_four!(Sse2x8, f64, u8, 2, pair_of_words, {
    _mm_add_pd _mm_sub_pd _mm_mul_pd _mm_div_pd _mm_xor_pd _mm_set1_pd _mm_sqrt_pd
    _mm_max_pd _mm_min_pd _mm_and_pd _mm_cmpgt_pd _mm_movemask_pd
});
vector_of_four!(Sse2x16, f32, u16, 4, four_words, {
    _mm_add_ps _mm_sub_ps _mm_mul_ps _mm_div_ps _mm_xor_ps _mm_set1_ps _mm_sqrt_ps
    _mm_max_ps _mm_min_ps _mm_and_ps _mm_cmpgt_ps _mm_movemask_ps
});

/// Four words for each number below sixteen, all bits of a word set where the number has a bit.
static FOUR_WORDS: [[u32; 4]; 16] = {
    let mut table = [[0; 4]; 16];
    let mut bits = 0;
    while bits < 16 {
        let mut k = 0;
        while k < 4 {
            if bits >> k & 1 == 1 {
                table[bits][k] = u32::MAX;
            }
            k += 1;
        }
        bits += 1;
    }
    table
};

/// Returns two words of 64 bits that are set where the number has a bit.
#[inline(always)]
fn pair_of_words(bits: usize) -> __m128d {
    // A word of 64 bits is two of 32 bits.
    const OF_PAIR: [usize; 4] = [0b0000, 0b0011, 0b1100, 0b1111];
    // SAFETY: every x86-64 has SSE2.
    unsafe { _mm_castps_pd(four_words(OF_PAIR[bits])) }
}

/// Returns four words of 32 bits that are set where the number has a bit.
#[inline(always)]
fn four_words(bits: usize) -> __m128 {
    let words = &FOUR_WORDS[bits];
    // SAFETY: four words are loaded.
    unsafe { _mm_loadu_ps(words.as_ptr().cast()) }
}

/// Returns two floats as doubles.
#[inline(always)]
fn two_doubles(numbers: &[f32], at: usize) -> __m128d {
    // SAFETY: every x86-64 has SSE2.
    unsafe { _mm_set_pd(f64::from(numbers[at + 1]), f64::from(numbers[at])) }
}

impl Lanes for Sse2x8 {
    #[inline(always)]
    fn load(numbers: &[f64], at: usize) -> Self {
        let first = numbers[at..at + LANES].as_ptr();
        // SAFETY: the slice holds eight numbers.
        unsafe {
            Self(
                _mm_loadu_pd(first),
                _mm_loadu_pd(first.add(2)),
                _mm_loadu_pd(first.add(4)),
                _mm_loadu_pd(first.add(6)),
            )
        }
    }
    #[inline(always)]
    fn load_floats(numbers: &[f32], at: usize) -> Self {
        let numbers = &numbers[at..at + LANES];
        Self(
            two_doubles(numbers, 0),
            two_doubles(numbers, 2),
            two_doubles(numbers, 4),
            two_doubles(numbers, 6),
        )
    }
    #[inline(always)]
    unsafe fn gather(rows: &[Row], indices: [usize; LANES]) -> [Self; 4] {
        // SAFETY: the indices are in range, as the caller has promised; a row holds four numbers and is aligned to their size.
        unsafe {
            let a = turned(rows, indices[0], indices[1]);
            let b = turned(rows, indices[2], indices[3]);
            let c = turned(rows, indices[4], indices[5]);
            let d = turned(rows, indices[6], indices[7]);
            [
                Self(a[0], b[0], c[0], d[0]),
                Self(a[1], b[1], c[1], d[1]),
                Self(a[2], b[2], c[2], d[2]),
                Self(a[3], b[3], c[3], d[3]),
            ]
        }
    }
    #[inline(always)]
    fn inverse_root(self) -> Self {
        Self::splat(1.0) / self.sqrt()
    }
    #[inline(always)]
    fn to_array(self) -> [f64; LANES] {
        let mut numbers = [0.0; LANES];
        let first = numbers.as_mut_ptr();
        // SAFETY: the array holds eight numbers.
        unsafe {
            _mm_storeu_pd(first, self.0);
            _mm_storeu_pd(first.add(2), self.1);
            _mm_storeu_pd(first.add(4), self.2);
            _mm_storeu_pd(first.add(6), self.3);
        }
        numbers
    }
}

/// Transposes two rows: register c contains number c of each.
///
/// # Safety
/// The indices are below `rows.len()`.
#[inline(always)]
unsafe fn turned(rows: &[Row], a: usize, b: usize) -> [__m128d; 4] {
    // SAFETY: a row holds four numbers and is aligned to their size.
    unsafe {
        let (a, b) = (
            rows.get_unchecked(a).0.as_ptr(),
            rows.get_unchecked(b).0.as_ptr(),
        );
        let (a_low, a_high) = (_mm_load_pd(a), _mm_load_pd(a.add(2)));
        let (b_low, b_high) = (_mm_load_pd(b), _mm_load_pd(b.add(2)));
        [
            _mm_unpacklo_pd(a_low, b_low),
            _mm_unpackhi_pd(a_low, b_low),
            _mm_unpacklo_pd(a_high, b_high),
            _mm_unpackhi_pd(a_high, b_high),
        ]
    }
}

impl FloatLanes for Sse2x16 {
    #[inline(always)]
    fn broadcast(number: f32) -> Self {
        // SAFETY: every x86-64 has SSE2.
        let all = unsafe { _mm_set1_ps(number) };
        Self(all, all, all, all)
    }
    #[inline(always)]
    fn load_two(numbers: &[f32], at: [usize; 2]) -> Self {
        let low = numbers[at[0]..][..LANES].as_ptr();
        let high = numbers[at[1]..][..LANES].as_ptr();
        // SAFETY: both slices hold eight numbers.
        unsafe {
            Self(
                _mm_loadu_ps(low),
                _mm_loadu_ps(low.add(4)),
                _mm_loadu_ps(high),
                _mm_loadu_ps(high.add(4)),
            )
        }
    }
    #[inline(always)]
    fn to_floats(self) -> [f32; FLOATS] {
        let mut numbers = [0.0; FLOATS];
        let first = numbers.as_mut_ptr();
        // SAFETY: the array holds sixteen numbers.
        unsafe {
            _mm_storeu_ps(first, self.0);
            _mm_storeu_ps(first.add(4), self.1);
            _mm_storeu_ps(first.add(8), self.2);
            _mm_storeu_ps(first.add(12), self.3);
        }
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::super::F64x8;
    use super::super::floats_array::F32x16;
    use super::*;

    const NUMBERS: [f64; 10] = [
        1.5,
        -2.0,
        0.0,
        -0.0,
        f64::NAN,
        3.25,
        f64::INFINITY,
        7.0,
        1e-9,
        4.0,
    ];

    /// Returns the bits of the results of all operations; NaN has no defined sign.
    fn of_doubles<T: Lanes>() -> Vec<u64> {
        let (a, b) = (T::load(&NUMBERS, 0), T::load(&NUMBERS, 2));
        let mut rows = vec![Row::default(); 10];
        for (k, row) in rows.iter_mut().enumerate() {
            row.0 = [NUMBERS[k], k as f64, -1.0 / k as f64, 0.5];
        }
        // SAFETY: there are ten rows.
        let gathered = unsafe { T::gather(&rows, [9, 0, 3, 7, 2, 8, 1, 5]) };
        let floats = NUMBERS.map(|number| number as f32);
        let mut all = vec![
            a + b,
            a - b,
            a * b,
            a / b,
            -a,
            a.sqrt(),
            a.max(b),
            b.max(a),
            a.min(b),
        ];
        all.extend([
            a.mul_add(b, a),
            a.inverse_root(),
            T::splat(2.5),
            T::load_floats(&floats, 1),
        ]);
        all.extend(gathered);
        all.extend((0..=255).map(|mask| a.masked(mask)));
        let numbers = all.iter().flat_map(|vector| vector.to_array());
        let defined = |number: f64| if number.is_nan() { f64::NAN } else { number };
        let mut bits: Vec<u64> = numbers.map(|number| defined(number).to_bits()).collect();
        bits.push(u64::from(a.greater(b)));
        bits.push(u64::from(b.greater(a)));
        bits
    }

    fn of_floats<T: FloatLanes>() -> Vec<u32> {
        let numbers: Vec<f32> = NUMBERS
            .iter()
            .chain(&NUMBERS)
            .map(|number| *number as f32)
            .collect();
        let (a, b) = (
            T::load_two(&numbers, [0, 9]),
            T::load_two(&numbers, [2, 12]),
        );
        let mut all = vec![
            a + b,
            a - b,
            a * b,
            a / b,
            -a,
            a.sqrt(),
            a.max(b),
            b.max(a),
            a.min(b),
        ];
        all.extend([a.mul_add(b, a), T::splat(0.1), T::broadcast(0.3)]);
        all.extend((0..16).map(|k| a.masked(0x9 << k)));
        let numbers = all.iter().flat_map(|vector| vector.to_floats());
        let defined = |number: f32| if number.is_nan() { f32::NAN } else { number };
        let mut bits: Vec<u32> = numbers.map(|number| defined(number).to_bits()).collect();
        bits.push(u32::from(a.greater(b)));
        bits
    }

    #[test]
    fn registers_give_the_bits_of_arrays() {
        assert_eq!(of_doubles::<Sse2x8>(), of_doubles::<F64x8>());
        assert_eq!(of_floats::<Sse2x16>(), of_floats::<F32x16>());
    }
}
