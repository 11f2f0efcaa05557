//! Machine limits: rates of arithmetic and memory reads.

use std::hint::black_box;
use std::time::Instant;

use pericles::lanes::{LANES, Lanes, for_each_instruction_set};
use pericles::operator::InstructionSet;
use pericles::operator::prefetch::prefetch;

/// Measures the time of one multiply–add of eight numbers without dependencies, s.
///
/// Twelve independent chains exceed the product of latency and number of pipes of any machine; the fastest of
/// several rounds counts.
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

/// Sums numbers at the full rate of the memory: eight chains of eight, with prefetching. Loops over stored
/// bonds are compared with it.
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
    /// Sums the numbers.
    fn sum_numbers [] <> (numbers: &[f64], sum: &mut f64) = sum_numbers_body on lanes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_summed() {
        let numbers: Vec<f64> = (1..=1000).map(f64::from).collect();
        for set in InstructionSet::available() {
            assert_eq!(read(set, &numbers), 500_500.0);
        }
    }

    #[test]
    fn the_rate_of_every_instruction_set_is_measured() {
        let times: Vec<f64> = InstructionSet::available()
            .into_iter()
            .map(fma_seconds)
            .collect();
        assert!(times.iter().all(|&t| t > 0.0 && t < 1e-6), "{times:?}");
    }
}
