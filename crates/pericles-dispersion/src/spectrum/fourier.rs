//! Discrete Fourier transforms on cubes of points.

use std::sync::Arc;

use pericles_waves::fourier::{Complex64, ComplexPlan, complex_plans};

/// Forward and inverse transforms of arrays of n^dimension numbers, x fastest.
pub struct CubeTransform {
    nodes: usize,
    dimension: usize,
    forward: ComplexPlan,
    inverse: ComplexPlan,
    turned: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

impl CubeTransform {
    /// Creates the plans for cubes with `nodes` points along each axis.
    pub fn new(nodes: usize, dimension: usize) -> Self {
        let [forward, inverse] = complex_plans(nodes);
        let scratch = forward
            .get_inplace_scratch_len()
            .max(inverse.get_inplace_scratch_len());
        let zero = Complex64::new(0.0, 0.0);
        Self {
            nodes,
            dimension,
            forward,
            inverse,
            turned: vec![zero; nodes.pow(dimension as u32)],
            scratch: vec![zero; scratch],
        }
    }

    /// Forward transform Σ_x v(x) exp(−2πi m·x/n), in place.
    pub fn forward(&mut self, values: &mut [Complex64]) {
        let plan = Arc::clone(&self.forward);
        self.transform(values, &plan);
    }

    /// Inverse transform n^−d Σ_m v(m) exp(2πi m·x/n), in place.
    pub fn inverse(&mut self, values: &mut [Complex64]) {
        let plan = Arc::clone(&self.inverse);
        self.transform(values, &plan);
        let factor = 1.0 / values.len() as f64;
        values.iter_mut().for_each(|value| *value *= factor);
    }

    /// Transforms the fastest axis and makes it the slowest, once per axis, which restores the original order.
    fn transform(&mut self, values: &mut [Complex64], plan: &ComplexPlan) {
        let (n, lines) = (self.nodes, values.len() / self.nodes);
        for _ in 0..self.dimension {
            plan.process_with_scratch(values, &mut self.scratch);
            if self.dimension > 1 {
                for line in 0..lines {
                    for x in 0..n {
                        self.turned[line + lines * x] = values[x + n * line];
                    }
                }
                values.copy_from_slice(&self.turned);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::noise::noise;

    #[test]
    fn transforms_equal_direct_sums_and_are_inverse() {
        for dimension in 1..=3usize {
            let n = 6usize;
            let points = n.pow(dimension as u32);
            let start: Vec<Complex64> = noise(2 * points, 1)
                .chunks(2)
                .map(|z| Complex64::new(z[0], z[1]))
                .collect();
            let mut values = start.clone();
            let mut transform = CubeTransform::new(n, dimension);
            transform.forward(&mut values);
            let coordinates = |i: usize| [i % n, i / n % n, i / n / n];
            let m = 17 % points;
            let sum: Complex64 = (0..points)
                .map(|i| {
                    let (a, b) = (coordinates(i), coordinates(m));
                    let turns: usize = (0..3).map(|c| a[c] * b[c]).sum();
                    let angle = -std::f64::consts::TAU * turns as f64 / n as f64;
                    start[i] * Complex64::from_polar(1.0, angle)
                })
                .sum();
            assert!((sum - values[m]).norm() < 1e-12);
            transform.inverse(&mut values);
            let worst = values.iter().zip(&start).map(|(a, b)| (a - b).norm());
            assert!(worst.fold(0.0, f64::max) < 1e-14);
        }
    }
}
