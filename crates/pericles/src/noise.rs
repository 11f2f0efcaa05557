//! Pseudo-random numbers that are equal on every machine.

use crate::domain::Domain;

/// The SplitMix64 generator (Steele, Lea & Flood 2014): 64 bits of state, any seed.
#[derive(Debug, Clone)]
pub struct SplitMix64 {
    state: u64,
}

impl SplitMix64 {
    const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

    /// Makes the generator for a random seed.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// Makes the generator for a random seed and skips `count` numbers.
    pub fn after(seed: u64, count: u64) -> Self {
        Self::new(seed.wrapping_add(count.wrapping_mul(Self::STEP)))
    }

    /// Returns the next number, uniform in [−1, 1).
    pub fn signed(&mut self) -> f64 {
        self.state = self.state.wrapping_add(Self::STEP);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Returns `count` vectors uniformly distributed in the ball (disc, interval) of a radius, by rejection from the
/// enclosing cube.
///
/// ```
/// let vectors = pericles::noise::uniform_in_ball(3, 0.1, 7, 1000);
/// assert!(vectors.iter().all(|v| v.iter().map(|x| x * x).sum::<f64>() <= 0.01));
/// ```
pub fn uniform_in_ball(dimension: usize, radius: f64, seed: u64, count: usize) -> Vec<[f64; 3]> {
    let mut generator = SplitMix64::new(seed);
    let mut draw = || {
        loop {
            let mut vector = [0.0; 3];
            for component in vector.iter_mut().take(dimension) {
                *component = generator.signed();
            }
            if vector.iter().map(|x| x * x).sum::<f64>() <= 1.0 {
                return vector.map(|x| radius * x);
            }
        }
    };
    (0..count).map(|_| draw()).collect()
}

/// Returns a vector of numbers in (−1, 1) on the points of a process, component-major; equal to what [`noise`]
/// gives for a single process.
pub fn noise_on(domain: &Domain, components: usize, seed: u64) -> Vec<f64> {
    let all = domain.count(domain.owned_points() as u64);
    let number = |c: u64, i: usize| {
        let entry = c * all + domain.number(i) as u64;
        SplitMix64::after(seed, entry).signed()
    };
    (0..components as u64)
        .flat_map(|c| (0..domain.owned_points()).map(move |i| number(c, i)))
        .collect()
}

/// Returns `len` numbers in (−1, 1) (SplitMix64).
pub fn noise(len: usize, seed: u64) -> Vec<f64> {
    let mut generator = SplitMix64::new(seed);
    (0..len).map(|_| generator.signed()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_on_points_equals_the_sequence() {
        assert_eq!(noise_on(&Domain::alone(7), 3, 5), noise(21, 5));
    }

    #[test]
    fn vectors_fill_the_ball_uniformly() {
        let n = 20_000;
        let vectors = uniform_in_ball(3, 2.0, 1, n);
        // The fraction within half the radius is 1/8, and the mean square is 3/5 of the radius squared.
        let squares: Vec<f64> = vectors
            .iter()
            .map(|v| v.iter().map(|x| x * x).sum())
            .collect();
        let inner = squares.iter().filter(|&&s| s < 1.0).count() as f64 / n as f64;
        let mean = squares.iter().sum::<f64>() / n as f64;
        assert!((inner - 0.125).abs() < 0.007, "{inner}");
        assert!((mean - 2.4).abs() < 0.02, "{mean}");
    }
}
