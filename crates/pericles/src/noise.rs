//! Pseudo-random numbers that are the same on every machine.

/// Numbers in (−1, 1) (SplitMix64).
pub(crate) fn noise(len: usize, seed: u64) -> Vec<f64> {
    let mut seed = seed;
    (0..len)
        .map(|_| {
            seed = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = seed;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        })
        .collect()
}
