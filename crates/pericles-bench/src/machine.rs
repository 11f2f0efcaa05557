//! What the machine can do: the rates of arithmetic and of reading that steps are set against.

use std::hint::black_box;
use std::time::Instant;

use pericles::lanes::{LANES, Lanes, for_each_instruction_set};
use pericles::operator::InstructionSet;
use pericles::operator::prefetch::prefetch;

/// Seconds that one multiply–add of eight numbers takes where none waits for another.
///
/// Measured on twelve independent chains, more than any machine's latency times its pipes, the fastest of some rounds.
pub fn fma_seconds(set: InstructionSet) -> f64 {
    const REPEATS: usize = 20_000;
    let mut best = f64::INFINITY;
    for _ in 0..5 {
        let mut chains = [1.0; CHAINS];
        let begin = Instant::now();
        multiply_add(set, black_box(REPEATS), black_box(0.999_999), &mut chains);
        best = best.min(begin.elapsed().as_secs_f64());
        black_box(chains);
    }
    best / (REPEATS * CHAINS) as f64
}

const CHAINS: usize = 12;

#[inline(always)]
fn multiply_add_body<T: Lanes>(repeats: usize, factor: f64, chains: &mut [f64; CHAINS]) {
    let factor = T::splat(factor);
    let mut sums = [T::splat(0.0); CHAINS];
    for k in 0..CHAINS {
        sums[k] = T::splat(chains[k] + k as f64);
    }
    for _ in 0..repeats {
        for k in 0..CHAINS {
            sums[k] = sums[k].mul_add(factor, factor);
        }
    }
    for k in 0..CHAINS {
        chains[k] = sums[k].to_array()[0];
    }
}

for_each_instruction_set! {
    /// Runs the chains.
    fn multiply_add [] <> (
        repeats: usize,
        factor: f64,
        chains: &mut [f64; CHAINS],
    ) = multiply_add_body on lanes
}

/// The sum of numbers, read as fast as the memory gives them: eight chains of eight, and lines asked for ahead. Loops over stored bonds are set against it.
pub fn read(set: InstructionSet, numbers: &[f64]) -> f64 {
    let mut sum = 0.0;
    sum_numbers(set, numbers, &mut sum);
    sum
}

#[inline(always)]
fn sum_numbers_body<T: Lanes>(numbers: &[f64], sum: &mut f64) {
    const AHEAD: usize = 4 * ROW;
    let mut sums = [T::splat(0.0); ROW / LANES];
    for (row, part) in numbers.chunks_exact(ROW).enumerate() {
        for k in 0..ROW / LANES {
            prefetch(numbers, row * ROW + AHEAD + k * LANES);
            sums[k] = sums[k] + T::load(part, k * LANES);
        }
    }
    for k in 0..ROW / LANES {
        for number in sums[k].to_array() {
            *sum += number;
        }
    }
    for number in numbers.chunks_exact(ROW).remainder() {
        *sum += number;
    }
}

/// Numbers in a row of [`read`].
const ROW: usize = 64;

for_each_instruction_set! {
    /// Adds the numbers up.
    fn sum_numbers [] <> (numbers: &[f64], sum: &mut f64) = sum_numbers_body on lanes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_read() {
        let numbers: Vec<f64> = (1..=1000).map(f64::from).collect();
        for set in InstructionSet::available() {
            assert_eq!(read(set, &numbers), 500_500.0);
        }
    }

    #[test]
    fn the_rate_of_every_set_is_measured() {
        let times: Vec<f64> = InstructionSet::available()
            .into_iter()
            .map(fma_seconds)
            .collect();
        assert!(times.iter().all(|&t| t > 0.0 && t < 1e-6), "{times:?}");
    }
}
