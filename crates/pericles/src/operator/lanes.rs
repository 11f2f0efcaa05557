//! Numbers on which pair forces are written: one `f64`, or eight side by side.
//!
//! A pair law is written once, generic over [`Real`]. With [`F64x8`] the loops over the lanes become vector instructions of the
//! set the surrounding function is compiled for; with `f64` the same text is the naive twin used by tests. No
//! operation is contracted or reassociated, so all instruction sets give the same bits.
//!
//! Kernels whose speed must not depend on how well a compiler finds vectors are written on [`Vector`]: numbers held in whole registers of each set, eight
//! doubles ([`Lanes`]) or sixteen floats. Only [`Vector::mul_add`] may round differently from set to set.

use std::ops::{Add, Div, Index, IndexMut, Mul, Neg, Sub};
use std::sync::atomic::{AtomicU8, Ordering};

use crate::family::LANES;

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

/// Eight numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(align(64))]
pub struct F64x8(pub [f64; LANES]);

impl F64x8 {
    /// Number by number.
    #[inline(always)]
    pub fn from_fn(mut number: impl FnMut(usize) -> f64) -> Self {
        let mut lanes = [0.0; LANES];
        for k in 0..LANES {
            lanes[k] = number(k);
        }
        Self(lanes)
    }

    /// The lanes whose bit is set in `mask`; zero in the others, whatever they hold.
    #[inline(always)]
    pub fn masked(self, mask: u8) -> Self {
        Self::from_fn(|k| if mask >> k & 1 == 1 { self.0[k] } else { 0.0 })
    }

    /// One bit per lane: self > other. NaN compares false.
    #[inline(always)]
    pub fn greater(self, other: Self) -> u8 {
        let mut mask = 0;
        for k in 0..LANES {
            mask |= u8::from(self.0[k] > other.0[k]) << k;
        }
        mask
    }

    /// The sum of the lanes, in a fixed order.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        let a = self.0;
        ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]))
    }
}

macro_rules! lanewise {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for F64x8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::from_fn(|k| self.0[k] $op other.0[k])
            }
        }
    };
}
lanewise!(Add, add, +);
lanewise!(Sub, sub, -);
lanewise!(Mul, mul, *);
lanewise!(Div, div, /);

impl Neg for F64x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::from_fn(|k| -self.0[k])
    }
}

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
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::from_fn(|k| {
            if self.0[k] > other.0[k] {
                self.0[k]
            } else {
                other.0[k]
            }
        })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::from_fn(|k| {
            if self.0[k] < other.0[k] {
                self.0[k]
            } else {
                other.0[k]
            }
        })
    }
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

/// The instruction set of the vector loops, in ascending order of what it holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// What every machine of the architecture has.
    Baseline,
    /// AVX2 with FMA.
    Avx2,
    /// AVX-512 (F, VL, DQ, BW).
    Avx512,
}

/// The largest set that operators of this process choose by themselves.
static MOST: AtomicU8 = AtomicU8::new(InstructionSet::Avx512 as u8);

impl InstructionSet {
    const ALL: [Self; 3] = [Self::Baseline, Self::Avx2, Self::Avx512];

    /// The set that new operators use: the best one of this machine, or less after [`Self::limit_process`].
    pub fn detect() -> Self {
        let allowed = Self::ALL[usize::from(MOST.load(Ordering::Relaxed))];
        Self::of_machine().min(allowed)
    }

    /// Limits the operators that this process makes from now on to a set, for tests and comparisons. Returns whether the machine has the set; nothing
    /// changes if it does not.
    ///
    /// Libraries for dense matrices and Fourier transforms choose their instructions themselves.
    #[must_use]
    pub fn limit_process(self) -> bool {
        let runs = self <= Self::of_machine();
        if runs {
            MOST.store(self as u8, Ordering::Relaxed);
        }
        runs
    }

    fn of_machine() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512vl")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512bw")
            {
                return Self::Avx512;
            }
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                return Self::Avx2;
            }
        }
        Self::Baseline
    }

    /// All sets that operators of this process may use, the best one last.
    pub fn available() -> Vec<Self> {
        let best = Self::detect();
        Self::ALL.into_iter().filter(|set| *set <= best).collect()
    }

    /// The set of a name as [`Self::name`] writes it.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|set| set.name() == name)
    }

    /// As written in run.json.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }
}

/// Compiles one inlined function for every instruction set and chooses among the copies at run time.
///
/// Written `= body on lanes`, the function's first generic argument is the set's own type of eight doubles (see [`Lanes`](crate::operator::lanes::Lanes)); `on floats` (inside the engine), of sixteen
/// floats. The function made takes the [`InstructionSet`](crate::operator::InstructionSet) first: one of [`InstructionSet::available`](crate::operator::InstructionSet::available), for any other has undefined results.
#[macro_export]
macro_rules! for_each_instruction_set {
    ($(#[$doc:meta])* $visibility:vis fn $name:ident [$($generics:tt)*] <$($argument:ident),*> ($($parameter:ident : $type:ty),* $(,)?) = $body:ident) => {
        $crate::for_each_instruction_set! {
            @compile [$body::<$($argument),*>] [$body::<$($argument),*>] [$body::<$($argument),*>]
            $(#[$doc])* $visibility fn $name [$($generics)*] <$($argument),*> ($($parameter : $type),*)
        }
    };
    ($(#[$doc:meta])* $visibility:vis fn $name:ident [$($generics:tt)*] <$($argument:ident),*> ($($parameter:ident : $type:ty),* $(,)?) = $body:ident on lanes) => {
        $crate::for_each_instruction_set! {
            @compile
            [$body::<$crate::operator::lanes::F64x8, $($argument),*>]
            [$body::<$crate::operator::lanes_x86::Avx2x8, $($argument),*>]
            [$body::<$crate::operator::lanes_x86::Avx512x8, $($argument),*>]
            $(#[$doc])* $visibility fn $name [$($generics)*] <$($argument),*> ($($parameter : $type),*)
        }
    };
    ($(#[$doc:meta])* $visibility:vis fn $name:ident [$($generics:tt)*] <$($argument:ident),*> ($($parameter:ident : $type:ty),* $(,)?) = $body:ident on floats) => {
        $crate::for_each_instruction_set! {
            @compile
            [$body::<$crate::operator::floats::F32x16, $($argument),*>]
            [$body::<$crate::operator::floats_x86::Avx2x16, $($argument),*>]
            [$body::<$crate::operator::floats_x86::Avx512x16, $($argument),*>]
            $(#[$doc])* $visibility fn $name [$($generics)*] <$($argument),*> ($($parameter : $type),*)
        }
    };
    (@compile [$($baseline:tt)*] [$($avx2:tt)*] [$($avx512:tt)*]
     $(#[$doc:meta])* $visibility:vis fn $name:ident [$($generics:tt)*] <$($argument:ident),*> ($($parameter:ident : $type:ty),*)) => {
        $(#[$doc])*
        #[allow(clippy::too_many_arguments)]
        $visibility fn $name<$($generics)*>(set: $crate::operator::InstructionSet, $($parameter: $type),*) {
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,fma")]
                fn avx512<$($generics)*>($($parameter: $type),*) {
                    $($avx512)*($($parameter),*)
                }
                #[target_feature(enable = "avx2,fma")]
                fn avx2<$($generics)*>($($parameter: $type),*) {
                    $($avx2)*($($parameter),*)
                }
                match set {
                    // SAFETY: InstructionSet::detect found these features on this machine.
                    $crate::operator::InstructionSet::Avx512 => return unsafe { avx512::<$($argument),*>($($parameter),*) },
                    // SAFETY: as above.
                    $crate::operator::InstructionSet::Avx2 => return unsafe { avx2::<$($argument),*>($($parameter),*) },
                    $crate::operator::InstructionSet::Baseline => {}
                }
            }
            let _ = set;
            $($baseline)*($($parameter),*)
        }
    };
}
pub use for_each_instruction_set;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks() {
        let numbers = F64x8([1.0, f64::NAN, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
        assert_eq!(numbers.masked(0b1000_0101).sum(), 12.0);
        assert_eq!(numbers.greater(F64x8::splat(4.5)), 0b1111_0000);
    }
}
