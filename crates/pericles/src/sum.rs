//! Reproducible sums: the result depends on the terms only, not on their order, the number of threads or the
//! division among processes.
//!
//! Floating-point addition rounds, and the rounding error depends on the order. Here each term is split into
//! integer multiples of fixed units 2^(40 b), with integers b, and the integers are added exactly (Demmel & Nguyen,
//! *Parallel reproducible summation*, IEEE Trans. Comput. 64, 2015; Ahrens, Demmel & Nguyen, ACM TOMS 46, 2020).
//! The three units nearest to the largest term are kept. The neglected rest is below 2⁻⁸⁰ of the largest term per
//! term, so that sums are more accurate than plain ones.

use rayon::prelude::*;

use crate::archive::{Archive, Layout, SavedUnder, Values};
use crate::error::{PericlesError, Result};
use crate::lanes::{InstructionSet, for_each_instruction_set};
use crate::parallel::{BLOCK, Cost};

/// Bits per bin: the unit of bin b is 2^(40 b).
const WIDTH: i32 = 40;
/// Number of bins that are kept.
const KEPT: usize = 3;
/// Number of numbers in archives.
const STORED: usize = 1 + 2 * (KEPT + 3);
/// Number of terms that are split in parallel lanes.
const LANES: usize = 8;
/// Terms in bins beyond ±[`SAFE`] are scaled by 2^(40 · [`SHIFT`]) or its inverse, so that no unit over- or
/// underflows.
const SAFE: i32 = 22;
const SHIFT: i32 = 12;

/// A partial sum. Partial sums can be merged in any order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BinnedSum {
    /// Index b of the highest bin; the lowest possible index while all terms are zero.
    top: i32,
    /// Multiples of 2^(40 (top − k)).
    bins: [i128; KEPT],
    /// Numbers of terms that are +∞, −∞ and NaN.
    special: [i128; 3],
}

impl Default for BinnedSum {
    /// The sum of no terms.
    fn default() -> Self {
        Self {
            top: i32::MIN,
            bins: [0; KEPT],
            special: [0; 3],
        }
    }
}

impl BinnedSum {
    /// Returns Σ term(i) for i < n, computed in parallel.
    pub fn of(n: usize, term: impl Fn(usize) -> f64 + Sync) -> Self {
        Self::of_blocks(n, &|first, terms| {
            for (k, slot) in terms.iter_mut().enumerate() {
                *slot = term(first + k);
            }
        })
    }

    /// Returns the sum of n terms that `fill(first term, terms)` computes block by block.
    fn of_blocks(n: usize, fill: &(dyn Fn(usize, &mut [f64]) + Sync)) -> Self {
        let set = InstructionSet::detect();
        // The exact sum of a term takes about as long as two bonds.
        let blocks = n.div_ceil(BLOCK);
        let blocks_per_task = Cost::bonds(2 * n as u64).parts_per_task(blocks);
        (0..blocks)
            .into_par_iter()
            .with_min_len(blocks_per_task)
            .map(|block| {
                let first = block * BLOCK;
                let mut terms = [0.0; BLOCK];
                fill(first, &mut terms[..BLOCK.min(n - first)]);
                Self::of_block(set, &mut terms)
            })
            .reduce(Self::default, Self::merged)
    }

    /// Returns the sum of one block of terms, padded with zeros.
    fn of_block(set: InstructionSet, terms: &mut [f64; BLOCK]) -> Self {
        let mut sum = Self::default();
        let mut largest = Largest::default();
        largest_of(set, terms, &mut largest);
        if largest.special {
            for term in terms.iter_mut().filter(|term| !term.is_finite()) {
                let kind = if term.is_nan() {
                    2
                } else {
                    usize::from(*term < 0.0)
                };
                sum.special[kind] += 1;
                *term = 0.0;
            }
            largest = Largest::default();
            largest_of(set, terms, &mut largest);
        }
        if largest.magnitude == 0.0 {
            return sum;
        }
        sum.top = bin_of(largest.magnitude);
        let shift = if sum.top < -SAFE {
            SHIFT
        } else if sum.top > SAFE {
            -SHIFT
        } else {
            0
        };
        if shift != 0 {
            let factor = power_of_two(WIDTH * shift);
            terms.iter_mut().for_each(|term| *term *= factor);
        }
        let units = std::array::from_fn(|k| power_of_two(WIDTH * (sum.top + shift - k as i32)));
        let mut cut = [[0.0; LANES]; KEPT];
        cut_into(set, terms, &units, &mut cut);
        for ((bin, lanes), unit) in sum.bins.iter_mut().zip(&cut).zip(units) {
            // All are multiples of the unit and below 2^53 units: the sum of the lanes and the quotient are exact.
            *bin = (lanes.iter().sum::<f64>() / unit) as i128;
        }
        sum
    }

    /// Returns the sum of the terms of both.
    pub fn merged(mut self, mut other: Self) -> Self {
        let top = self.top.max(other.top);
        self.lower(top);
        other.lower(top);
        for (bin, more) in self.bins.iter_mut().zip(other.bins) {
            *bin += more;
        }
        for (count, more) in self.special.iter_mut().zip(other.special) {
            *count += more;
        }
        self
    }

    /// Adds a term.
    pub fn add(&mut self, term: f64) {
        let mut terms = [0.0; BLOCK];
        terms[0] = term;
        *self = self.merged(Self::of_block(InstructionSet::Baseline, &mut terms));
    }

    /// Index of the highest bin.
    pub(crate) fn top(&self) -> i32 {
        self.top
    }

    /// Returns the integers of the sum for a highest bin `top` at or above its own; integers of several sums with
    /// the same `top` may be added.
    pub(crate) fn integers(mut self, top: i32) -> [i128; KEPT + 3] {
        self.lower(top);
        let mut integers = [0; KEPT + 3];
        integers[..KEPT].copy_from_slice(&self.bins);
        integers[KEPT..].copy_from_slice(&self.special);
        integers
    }

    /// Makes a sum from such integers.
    pub(crate) fn of_integers(top: i32, integers: [i128; KEPT + 3]) -> Self {
        Self {
            top,
            bins: std::array::from_fn(|k| integers[k]),
            special: std::array::from_fn(|k| integers[KEPT + k]),
        }
    }

    /// Raises the highest bin; bins below the lowest kept one are dropped.
    fn lower(&mut self, top: i32) {
        let steps = top.saturating_sub(self.top).min(KEPT as i32) as usize;
        self.bins.rotate_right(steps);
        self.bins[..steps].fill(0);
        self.top = top;
    }

    /// Returns the sum, rounded.
    pub fn value(&self) -> f64 {
        match self.special {
            [0, 0, 0] => {}
            [_, 0, 0] => return f64::INFINITY,
            [0, _, 0] => return f64::NEG_INFINITY,
            _ => return f64::NAN,
        }
        if self.top == i32::MIN {
            return 0.0;
        }
        let [high, middle, low] = self.bins;
        // In units of the middle bin: fewer than 2^127 units for up to 2^47 terms.
        let upper = (high << WIDTH) + middle;
        let lower = low as f64 * power_of_two(-WIDTH);
        scaled(upper as f64 + lower, WIDTH * (self.top - 1))
    }
}

/// Stored as the index of the highest bin followed by the integers, each in two halves.
impl BinnedSum {
    /// Returns the stored numbers.
    pub(crate) fn stored(&self) -> Vec<u64> {
        let halves = |integer: i128| [integer as u64, (integer >> 64) as u64];
        let mut numbers = vec![i64::from(self.top) as u64];
        numbers.extend(self.integers(self.top).into_iter().flat_map(halves));
        numbers
    }

    /// Returns the sum from its stored numbers; `None` if they do not form a sum.
    pub(crate) fn of_stored(numbers: &[u64]) -> Option<Self> {
        /// Far larger than the integers of any run and far below overflow.
        const MOST: u128 = 1 << 100;
        if numbers.len() != STORED {
            return None;
        }
        let integer = |k: usize| {
            let [low, high] = [numbers[1 + 2 * k], numbers[2 + 2 * k]];
            i128::from(high as i64) << 64 | i128::from(low)
        };
        let integers: [i128; KEPT + 3] = std::array::from_fn(integer);
        let top = i32::try_from(numbers[0] as i64).ok()?;
        let bins = bin_of(f64::MIN_POSITIVE * f64::EPSILON)..=bin_of(f64::MAX);
        let valid = (top == i32::MIN || bins.contains(&top))
            && integers.iter().all(|k| k.unsigned_abs() < MOST);
        valid.then(|| Self::of_integers(top, integers))
    }
}

/// The terms of this process; see [`Layout::Sum`].
impl SavedUnder for BinnedSum {
    fn save_under(&self, name: &str, archive: &mut Archive) {
        archive.put_as(name, Values::U64(self.stored()), Layout::Sum);
    }

    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()> {
        let numbers = archive.exactly::<u64>(name, STORED)?;
        *self = Self::of_stored(numbers).ok_or_else(|| PericlesError::BadArchive {
            reason: format!("{name} is not a valid sum"),
        })?;
        Ok(())
    }
}

/// Returns the maximum norm max |xᵢ|, zero for no numbers; NaN entries are ignored.
pub fn max_norm<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> f64 {
    let sizes = numbers.into_iter().map(|x| x.abs());
    sizes.fold(0.0, f64::max)
}

/// Returns Σ term(i) for i < n, computed in parallel on this process.
pub fn sum(n: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    BinnedSum::of(n, term).value()
}

/// Returns the lowest bin b whose terms are at most half a unit of bin b + 1, so that they do not contribute to
/// that bin.
fn bin_of(magnitude: f64) -> i32 {
    // ⌈(exponent + 2 − WIDTH)/WIDTH⌉
    (exponent_of(magnitude) + 1).div_euclid(WIDTH)
}

/// Returns ⌊log₂ x⌋ of a positive finite number.
fn exponent_of(x: f64) -> i32 {
    const SUBNORMAL: i32 = -1022;
    let biased = (x.to_bits() >> 52) as i32;
    if biased > 0 {
        biased - 1023
    } else {
        SUBNORMAL - 52 + (63 - x.to_bits().leading_zeros() as i32)
    }
}

/// Returns 2^exponent as a normal number.
fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent + 1023) as u64) << 52)
}

/// Returns x · 2^exponent, in steps that neither over- nor underflow before the end.
fn scaled(mut x: f64, mut exponent: i32) -> f64 {
    const STEP: i32 = 900;
    while exponent.abs() > STEP {
        let step = STEP * exponent.signum();
        x *= power_of_two(step);
        exponent -= step;
    }
    x * power_of_two(exponent)
}

/// Largest magnitude of the finite terms, and whether there are infinite or NaN terms.
#[derive(Debug, Clone, Copy, Default)]
struct Largest {
    magnitude: f64,
    special: bool,
}

#[inline(always)]
fn largest_body(terms: &[f64; BLOCK], largest: &mut Largest) {
    let mut magnitudes = [0.0f64; LANES];
    let mut zeros = [0.0f64; LANES];
    for group in terms.chunks_exact(LANES) {
        for k in 0..LANES {
            let magnitude = group[k].abs();
            magnitudes[k] = if magnitude > magnitudes[k] {
                magnitude
            } else {
                magnitudes[k]
            };
            // NaN for infinite and NaN terms.
            zeros[k] += group[k] * 0.0;
        }
    }
    largest.magnitude = magnitudes.iter().fold(0.0, |a, b| a.max(*b));
    largest.special = zeros.iter().any(|zero| zero.is_nan());
}

#[inline(always)]
fn cut_body(terms: &[f64; BLOCK], units: &[f64; KEPT], sums: &mut [[f64; LANES]; KEPT]) {
    // Adding and subtracting 1.5 · 2^52 units rounds x to a multiple of the unit, ties to even.
    let mut round = [0.0; KEPT];
    for k in 0..KEPT {
        round[k] = 1.5 * power_of_two(52) * units[k];
    }
    let mut cut = [[0.0; LANES]; KEPT];
    for group in terms.chunks_exact(LANES) {
        for lane in 0..LANES {
            let mut rest = group[lane];
            for k in 0..KEPT {
                let part = (rest + round[k]) - round[k];
                cut[k][lane] += part;
                rest -= part;
            }
        }
    }
    *sums = cut;
}

for_each_instruction_set! {
    /// Finds the largest magnitude.
    fn largest_of [] <> (terms: &[f64; BLOCK], largest: &mut Largest) = largest_body
}

for_each_instruction_set! {
    /// Splits all terms into multiples of each unit and adds these, lane by lane.
    fn cut_into [] <> (
        terms: &[f64; BLOCK],
        units: &[f64; KEPT],
        sums: &mut [[f64; LANES]; KEPT],
    ) = cut_body
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of both signs with exponents from `low` to `high`.
    fn numbers(seed: u64, count: usize, [low, high]: [i32; 2]) -> Vec<f64> {
        let mut state = seed;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            state >> 11
        };
        (0..count)
            .map(|_| {
                let mantissa = 1.0 + next() as f64 / power_of_two(53);
                let exponent = low + (next() % (high - low + 1) as u64) as i32;
                let sign = if next() % 2 == 0 { 1.0 } else { -1.0 };
                sign * scaled(mantissa, exponent)
            })
            .collect()
    }

    fn of(terms: &[f64]) -> f64 {
        sum(terms.len(), |i| terms[i])
    }

    #[test]
    fn sums_do_not_depend_on_order_partition_or_instructions() {
        for range in [
            [-3, 3],
            [-60, 60],
            [-1000, 900],
            [-1074, -1000],
            [960, 1000],
        ] {
            let mut terms = numbers(7, 5 * BLOCK + 19, range);
            let expected = of(&terms);
            assert!(expected.is_finite());
            terms.reverse();
            assert_eq!(of(&terms).to_bits(), expected.to_bits(), "{range:?}");
            terms.rotate_left(777);
            for parts in [2, 3, 7, 100] {
                let sums = terms.chunks(terms.len().div_ceil(parts));
                let merged = sums
                    .map(|part| BinnedSum::of(part.len(), |i| part[i]))
                    .fold(BinnedSum::default(), |a, b| b.merged(a));
                assert_eq!(
                    merged.value().to_bits(),
                    expected.to_bits(),
                    "{range:?}, {parts}"
                );
            }
            for set in InstructionSet::available() {
                let blocks = terms.chunks(BLOCK).map(|chunk| {
                    let mut block = [0.0; BLOCK];
                    block[..chunk.len()].copy_from_slice(chunk);
                    BinnedSum::of_block(set, &mut block)
                });
                let merged = blocks.fold(BinnedSum::default(), BinnedSum::merged);
                assert_eq!(
                    merged.value().to_bits(),
                    expected.to_bits(),
                    "{range:?}, {set:?}"
                );
            }
        }
    }

    #[test]
    fn sums_equal_exact_arithmetic_to_the_last_digit() {
        // Integers times 2^-30, which i128 adds exactly.
        let terms: Vec<f64> = numbers(3, 10_000, [-9, 22])
            .iter()
            .map(|x| (x * power_of_two(30)).round() / power_of_two(30))
            .collect();
        let exact: i128 = terms.iter().map(|x| (x * power_of_two(30)) as i128).sum();
        let expected = exact as f64 / power_of_two(30);
        assert_eq!(of(&terms), expected);
        // Large terms cancel and leave the small ones.
        let small = 3.0 * power_of_two(-40);
        let mut cancelling = terms.clone();
        cancelling.extend(terms.iter().map(|x| -x));
        cancelling.push(small);
        assert_eq!(of(&cancelling), small);
    }

    #[test]
    fn sums_of_few_extreme_and_special_terms_are_exact() {
        assert_eq!(of(&[]), 0.0);
        assert_eq!(of(&[0.0, -0.0]), 0.0);
        for x in [
            5e-324,
            -2.5e-310,
            1.0,
            0.1,
            -f64::MAX,
            2f64.powi(39),
            2f64.powi(79),
            f64::MIN_POSITIVE,
        ] {
            assert_eq!(of(&[x]), x, "{x:e}");
            assert_eq!(of(&[x, x, -x]), x, "{x:e}");
        }
        assert_eq!(of(&[f64::MAX, f64::MAX]), f64::INFINITY);
        assert_eq!(of(&[1.0, f64::INFINITY, -3.0]), f64::INFINITY);
        assert_eq!(of(&[1.0, f64::NEG_INFINITY]), f64::NEG_INFINITY);
        assert!(of(&[f64::INFINITY, 1.0, f64::NEG_INFINITY]).is_nan());
        assert!(of(&[f64::NAN, 1.0]).is_nan());
    }

    #[test]
    fn bins_follow_from_exponents() {
        assert_eq!(
            [1.0, 1.5, 0.5, 5e-324, 2.5e-308].map(exponent_of),
            [0, 0, -1, -1074, -1022]
        );
        for magnitude in [
            1.0,
            2f64.powi(38),
            2f64.powi(39) * 0.999,
            2f64.powi(-1),
            2f64.powi(-42),
        ] {
            let bin = bin_of(magnitude);
            assert!(
                magnitude < power_of_two(WIDTH * bin + WIDTH - 1),
                "{magnitude}"
            );
            assert!(
                magnitude >= 0.5 * power_of_two(WIDTH * (bin - 1) + WIDTH - 1),
                "{magnitude}"
            );
        }
    }
}
