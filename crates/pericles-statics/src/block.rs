//! Inner products and linear combinations of blocks of vectors.
//!
//! Sums are not exact sums over processes: modes are computed for whole bodies only.

use pericles::parallel::for_each_chunk;
use rayon::prelude::*;

/// Entries per block, so that blocks of all vectors remain in the cache.
const BLOCK: usize = 2048;

/// Returns Σ_k w_k a_i,k b_j,k for all pairs, row by row, of vectors for which the result is symmetric.
/// Blocks are added in a fixed order, so that the result does not depend on the number of threads.
pub(crate) fn symmetric_products(a: &[Vec<f64>], b: &[Vec<f64>], weights: &[f64]) -> Vec<f64> {
    let n = a.len();
    let of_block = |block: usize| {
        let entries = block * BLOCK..((block + 1) * BLOCK).min(weights.len());
        let weights = &weights[entries.clone()];
        let mut sums = vec![0.0; n * n];
        let mut weighted = vec![0.0; weights.len()];
        for i in 0..n {
            let row = a[i][entries.clone()].iter().zip(weights);
            weighted
                .iter_mut()
                .zip(row)
                .for_each(|(out, (a, w))| *out = a * w);
            for j in 0..=i {
                sums[i * n + j] = dot(&weighted, &b[j][entries.clone()]);
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

/// Returns a dot product computed with four independent sums.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a_fours, b_fours) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest = a_fours.remainder().iter().zip(b_fours.remainder());
    let rest: f64 = rest.map(|(a, b)| a * b).sum();
    for (a, b) in a_fours.zip(b_fours) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// Returns Σ_k c_k x_k.
pub(crate) fn combination(vectors: &[Vec<f64>], coefficients: &[f64], entries: usize) -> Vec<f64> {
    let mut sum = vec![0.0; entries];
    for_each_chunk(&mut sum, &|first, chunk| {
        let length = chunk.len();
        for (vector, c) in vectors.iter().zip(coefficients) {
            let part = &vector[first..first + length];
            chunk.iter_mut().zip(part).for_each(|(s, x)| *s += c * x);
        }
    });
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn block_products_and_combinations_equal_those_of_single_vectors() {
        let entries = 2 * BLOCK + 7;
        let entry = |k: usize, i: usize| ((3 * k + 1) as f64 * (0.1 + i as f64)).sin();
        let vectors: Vec<Vec<f64>> = (0..3)
            .map(|k| (0..entries).map(|i| entry(k, i)).collect())
            .collect();
        let weights: Vec<f64> = (0..entries).map(|i| 1.0 + (i % 5) as f64).collect();
        let products = symmetric_products(&vectors, &vectors, &weights);
        for i in 0..3 {
            for j in 0..3 {
                let terms = (0..entries).map(|k| weights[k] * vectors[i][k] * vectors[j][k]);
                let exact: f64 = terms.sum();
                assert!((products[i * 3 + j] - exact).abs() < 1e-12 * entries as f64);
            }
        }
        let sum = combination(&vectors[..2], &[2.0, -3.0], entries);
        for k in 0..entries {
            assert_eq!(sum[k], 2.0 * vectors[0][k] + -3.0 * vectors[1][k]);
        }
    }
}
