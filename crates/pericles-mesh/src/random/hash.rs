//! Counter-based random numbers.

/// Finalisation of SplitMix64 (Steele, Lea and Flood 2014).
fn mixed(mut x: u64) -> u64 {
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Returns a random integer for a seed and three numbers.
pub(super) fn bits(seed: u64, a: u64, b: u64, c: u64) -> u64 {
    const STEP: u64 = 0x9e37_79b9_7f4a_7c15;
    [a, b, c].into_iter().fold(mixed(seed ^ STEP), |state, x| {
        mixed(state.wrapping_add(STEP) ^ mixed(x.wrapping_add(STEP)))
    })
}

/// Returns a random number in [0, 1) for a seed and three numbers.
pub(super) fn uniform(seed: u64, a: u64, b: u64, c: u64) -> f64 {
    (bits(seed, a, b, c) >> 11) as f64 / (1u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::uniform;

    #[test]
    fn numbers_are_uniform_and_uncorrelated_with_their_neighbours() {
        // Mean 1/2 and correlation 0 with standard errors 1/√(12 n) and 1/(12 √n); tolerance of five standard
        // errors.
        let n = 100_000u64;
        for shift in [[1, 0, 0], [0, 1, 0], [0, 0, 1]] {
            let number =
                |k: u64, s: u64| uniform(7, k + s * shift[0], 3 + s * shift[1], 1 + s * shift[2]);
            let mean = (0..n).map(|k| number(k, 0)).sum::<f64>() / n as f64;
            let pairs = (0..n).map(|k| (number(k, 0) - 0.5) * (number(k, 1) - 0.5));
            let correlation = pairs.sum::<f64>() / n as f64;
            let root = (n as f64).sqrt();
            assert!((mean - 0.5).abs() < 5.0 / (12f64.sqrt() * root), "{mean}");
            assert!(correlation.abs() < 5.0 / (12.0 * root), "{correlation}");
        }
        assert_ne!(uniform(1, 2, 3, 4), uniform(2, 2, 3, 4));
    }
}
