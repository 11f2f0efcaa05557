//! Blocks of vectors of unknowns: inner products and linear combinations.
//!
//! Eight vectors are stored side by side, so that a product of a sparse matrix reads the matrix once for all of them, and inner
//! products and combinations of blocks are products of small dense matrices for every entry.
//!
//! Sums are not exact sums over processes: modes are computed for whole bodies only. Entries are added in blocks of a fixed
//! length and order, so that results do not depend on the number of threads.

use pericles::for_each_instruction_set;
use pericles::lanes::{F64x8, InstructionSet, LANES, Lanes, vector};
use pericles::parallel::{BLOCK, Cost, for_each_chunk_of};
use rayon::prelude::*;

/// Eight vectors: entry k has entry k of each of them. Missing vectors are zero.
pub(crate) type Group = Vec<F64x8>;

const ZERO: F64x8 = F64x8([0.0; LANES]);

/// Returns eight vectors of zeros.
pub(crate) fn zeros(entries: usize) -> Group {
    vec![ZERO; entries]
}

/// Copies a vector of a group.
pub(crate) fn copy_from(group: &[F64x8], lane: usize, out: &mut [f64]) {
    for (out, x) in out.iter_mut().zip(group) {
        *out = x.0[lane];
    }
}

/// Sets a vector of a group.
pub(crate) fn copy_to(group: &mut [F64x8], lane: usize, vector: &[f64]) {
    for (x, value) in group.iter_mut().zip(vector) {
        x.0[lane] = *value;
    }
}

/// Returns groups of the vectors with these numbers.
pub(crate) fn selected(groups: &[Group], numbers: &[usize], entries: usize) -> Vec<Group> {
    let group = |numbers: &[usize]| {
        let mut group = zeros(entries);
        for (lane, number) in numbers.iter().enumerate() {
            let from = &groups[number / LANES];
            for (x, value) in group.iter_mut().zip(from) {
                x.0[lane] = value.0[number % LANES];
            }
        }
        group
    };
    numbers.chunks(LANES).map(group).collect()
}

/// Returns Σ_k term(k) for each vector of a group.
pub(crate) fn sums(entries: usize, term: impl Fn(usize) -> F64x8 + Sync) -> F64x8 {
    let of_block = |block: usize| {
        let mut sum = ZERO;
        for k in block * BLOCK..((block + 1) * BLOCK).min(entries) {
            sum = sum + term(k);
        }
        sum
    };
    let blocks = (0..entries.div_ceil(BLOCK)).into_par_iter();
    let blocks: Vec<F64x8> = blocks.with_min_len(8).map(of_block).collect();
    blocks.into_iter().fold(ZERO, |sum, block| sum + block)
}

/// Returns Σ_k w_k a_i,k b_j,k for all pairs of vectors, row by row, of groups for which the result is symmetric.
pub(crate) fn symmetric_products(a: &[Group], b: &[Group], weights: &[f64]) -> Vec<f64> {
    let (n, set) = (LANES * a.len(), InstructionSet::detect());
    let of_block = |block: usize| {
        let entries = block * BLOCK..((block + 1) * BLOCK).min(weights.len());
        let weights = &weights[entries.clone()];
        let mut sums = vec![0.0; n * n];
        for (i, left) in a.iter().enumerate() {
            for (j, right) in b[..=i].iter().enumerate() {
                let mut part = [ZERO; LANES];
                let pair = [&left[entries.clone()], &right[entries.clone()]];
                add_products(set, pair, weights, &mut part);
                for (lane, row) in part.iter().enumerate() {
                    let first = (i * LANES + lane) * n + j * LANES;
                    sums[first..first + LANES].copy_from_slice(&row.0);
                }
            }
        }
        sums
    };
    let blocks: Vec<Vec<f64>> = (0..weights.len().div_ceil(BLOCK))
        .into_par_iter()
        .with_min_len(8)
        .map(of_block)
        .collect();
    let mut total = vec![0.0; n * n];
    for sums in &blocks {
        total.iter_mut().zip(sums).for_each(|(t, s)| *t += s);
    }
    for i in 0..n {
        for j in 0..i {
            total[j * n + i] = total[i * n + j];
        }
    }
    total
}

#[inline(always)]
fn add_products_body<N: Lanes>([a, b]: [&[F64x8]; 2], weights: &[f64], out: &mut [F64x8; LANES]) {
    let (b, weights) = (&b[..a.len()], &weights[..a.len()]);
    let mut sums: [N; LANES] = vector(|lane| N::load(&out[lane].0, 0));
    for k in 0..a.len() {
        let row = N::load(&b[k].0, 0);
        for lane in 0..LANES {
            sums[lane] = sums[lane] + N::splat(weights[k] * a[k].0[lane]) * row;
        }
    }
    for lane in 0..LANES {
        out[lane] = F64x8(sums[lane].to_array());
    }
}

for_each_instruction_set! {
    /// Adds Σ_k w_k a_k b_kᵀ, one row for each vector of the first group.
    fn add_products [] <> (
        pair: [&[F64x8]; 2],
        weights: &[f64],
        out: &mut [F64x8; LANES],
    ) = add_products_body on lanes
}

/// Returns groups of the vectors Σ_k c_k x_k, one for each row of coefficients.
pub(crate) fn combinations(
    vectors: &[Group],
    coefficients: &[&[f64]],
    entries: usize,
) -> Vec<Group> {
    let set = InstructionSet::detect();
    let group = |rows: &[&[f64]]| {
        let of_vector = |k: usize| F64x8::from_fn(|lane| rows.get(lane).map_or(0.0, |row| row[k]));
        let factors: Vec<F64x8> = (0..LANES * vectors.len()).map(of_vector).collect();
        let mut sum = zeros(entries);
        let cost = Cost::bonds((LANES * vectors.len() * entries) as u64);
        for_each_chunk_of(&mut sum, cost, &|first, chunk| {
            for (group, factors) in vectors.iter().zip(factors.chunks_exact(LANES)) {
                let x = &group[first..first + chunk.len()];
                add_combination(set, x, factors, chunk);
            }
        });
        sum
    };
    coefficients.chunks(LANES).map(group).collect()
}

#[inline(always)]
fn add_combination_body<N: Lanes>(x: &[F64x8], factors: &[F64x8], out: &mut [F64x8]) {
    let x = &x[..out.len()];
    let factor: [N; LANES] = vector(|lane| N::load(&factors[lane].0, 0));
    for k in 0..out.len() {
        // Two independent sums, which a processor adds in parallel.
        let mut sums = [N::load(&out[k].0, 0), N::splat(0.0)];
        for lane in 0..LANES {
            sums[lane % 2] = sums[lane % 2] + N::splat(x[k].0[lane]) * factor[lane];
        }
        out[k] = F64x8((sums[0] + sums[1]).to_array());
    }
}

for_each_instruction_set! {
    /// Adds the vectors of a group, each with the factors of its combinations.
    fn add_combination [] <> (
        x: &[F64x8],
        factors: &[F64x8],
        out: &mut [F64x8],
    ) = add_combination_body on lanes
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENTRIES: usize = 2 * BLOCK + 7;

    fn entry(k: usize, i: usize) -> f64 {
        ((3 * k + 1) as f64 * (0.1 + i as f64)).sin()
    }

    /// Eleven vectors.
    fn groups() -> Vec<Group> {
        let lane = |k: usize, i: usize| if k < 11 { entry(k, i) } else { 0.0 };
        let group = |g: usize| {
            let row = |i: usize| F64x8::from_fn(|l| lane(g * LANES + l, i));
            (0..ENTRIES).map(row).collect()
        };
        (0..2).map(group).collect()
    }

    #[test]
    fn products_of_groups_equal_those_of_single_vectors() {
        let weights: Vec<f64> = (0..ENTRIES).map(|i| 1.0 + (i % 5) as f64).collect();
        let products = symmetric_products(&groups(), &groups(), &weights);
        for i in 0..11 {
            for j in 0..11 {
                let terms = (0..ENTRIES).map(|k| weights[k] * entry(i, k) * entry(j, k));
                let exact: f64 = terms.sum();
                assert!((products[i * 16 + j] - exact).abs() < 1e-12 * ENTRIES as f64);
            }
        }
        assert_eq!(products[11 * 16 + 11], 0.0);
    }

    #[test]
    fn combinations_and_selections_equal_those_of_single_vectors() {
        let mut coefficients = vec![0.0; 16];
        (coefficients[0], coefficients[9]) = (2.0, -3.0);
        let sums = combinations(&groups(), &[&coefficients], ENTRIES);
        let chosen = selected(&groups(), &[10, 2], ENTRIES);
        let (mut sum, mut second) = (vec![0.0; ENTRIES], vec![0.0; ENTRIES]);
        copy_from(&sums[0], 0, &mut sum);
        copy_from(&chosen[0], 1, &mut second);
        for k in 0..ENTRIES {
            assert!((sum[k] - (2.0 * entry(0, k) - 3.0 * entry(9, k))).abs() < 1e-14);
            assert_eq!((second[k], chosen[0][k].0[0]), (entry(2, k), entry(10, k)));
        }
    }
}
