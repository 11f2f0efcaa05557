//! Functions of an operator by Chebyshev series.

use rayon::prelude::*;

use super::{MatrixFunction, Product, Term, WaveFunction, bessel_into};
use pericles::Interrupt;
use pericles::Result;
use pericles::parallel::BLOCK;
use pericles::sum::max_norm;

/// Computes g(A) x = Σ′ c_k T_k(Y) x with Y = 2A/λ − 1, for an operator with eigenvalues in [0, λ].
///
/// With a = τ√λ and J the Bessel functions, halved at k = 0:
///
/// | | c_k (−1)^k |
/// |---|---|
/// | cos τW | 2 J_2k(a) |
/// | τ sinc τW | 4 λ^−½ Σ_j J_{2k+2j+1}(a) |
/// | −W sin τW | λ^½ (J_{2k−1} − J_{2k+1})(a) |
/// | (1 − cos τW) W⁻² | 8 λ⁻¹ Σ_j Σ_i J_{2k+2j+2i+2}(a) |
/// | n integrations of cos τW over τ | 2ⁿ⁺¹ λ^(−n/2) Σ … Σ J_{2k+2j+2i+…+n}(a), n sums |
///
/// (all but the slope follow from the first by integration over τ). Coefficients decrease superexponentially
/// beyond k = a/2, where the series is truncated; one series can cover any time. One recurrence serves all terms.
/// Memory: three vectors. Measured error: below 1e-13 up to a = 100.
pub struct Chebyshev {
    bound: f64,
    vectors: [Vec<f64>; 3],
    bessel: Vec<f64>,
    coefficients: Vec<Vec<f64>>,
    products: u64,
}

/// Threshold relative to the largest coefficient below which coefficients are dropped.
const NEGLIGIBLE: f64 = 1e-17;

impl Chebyshev {
    /// Creates the engine for vectors of `entries` numbers and eigenvalues between 0 and `bound` (1/s²), which must
    /// be positive.
    pub fn new(bound: f64, entries: usize) -> Self {
        Self {
            // A bound that is attained must not be exceeded by round-off: outside [−1, 1] the series diverges.
            bound: bound * (1.0 + 1e-12),
            vectors: std::array::from_fn(|_| vec![0.0; entries]),
            bessel: Vec::new(),
            coefficients: Vec::new(),
            products: 0,
        }
    }

    /// Number of products with A so far.
    pub fn products(&self) -> u64 {
        self.products
    }

    /// Degree required for a time τ.
    pub fn degree(&self, tau: f64) -> usize {
        let a = tau.abs() * self.bound.sqrt();
        (0.5 * a + 6.0 * a.cbrt() + 12.0).ceil() as usize
    }

    /// Computes the coefficients `self.coefficients[k]` of term k and returns the largest degree.
    fn prepare(&mut self, terms: &[Term<'_>]) -> usize {
        self.coefficients.resize_with(terms.len(), Vec::new);
        let mut degree = 0;
        for (k, term) in terms.iter().enumerate() {
            let most = self.degree(term.tau);
            self.bessel.resize(2 * most + 40, 0.0);
            bessel_into(term.tau.abs() * self.bound.sqrt(), &mut self.bessel);
            let coefficients = &mut self.coefficients[k];
            coefficients.resize(most + 1, 0.0);
            series(term.function, self.bound, &self.bessel, coefficients);
            coefficients[0] *= 0.5;
            let largest = max_norm(&*coefficients);
            while coefficients.len() > 1
                && coefficients[coefficients.len() - 1].abs() <= NEGLIGIBLE * largest
            {
                coefficients.pop();
            }
            coefficients.iter_mut().for_each(|c| *c *= term.factor);
            degree = degree.max(coefficients.len() - 1);
        }
        degree
    }
}

/// Computes the coefficients before the one of k = 0 is halved; `bessel` extends to orders where J is negligible.
fn series(function: WaveFunction, bound: f64, bessel: &[f64], out: &mut [f64]) {
    let root = bound.sqrt();
    // Sums over higher orders, starting from the smallest values.
    let mut sums = [0.0; 5];
    let integrations = function.integrations();
    let first = bessel.len() - 1 - integrations.unwrap_or(1).max(2);
    for k in (0..=first / 2).rev() {
        let value = match integrations {
            None if k == 0 => -2.0 * root * bessel[1],
            None => root * (bessel[2 * k - 1] - bessel[2 * k + 1]),
            Some(n) => {
                let mut inner = bessel[2 * k + n];
                for sum in &mut sums[..n] {
                    *sum += inner;
                    inner = *sum;
                }
                let factor = match n {
                    0 => 2.0,
                    1 => 4.0 / root,
                    2 => 8.0 / bound,
                    n => 2.0 * (2.0 / root).powi(n as i32),
                };
                factor * inner
            }
        };
        if let Some(coefficient) = out.get_mut(k) {
            *coefficient = if k % 2 == 0 { value } else { -value };
        }
    }
}

impl MatrixFunction for Chebyshev {
    fn add(
        &mut self,
        apply: &mut Product<'_>,
        x: &[f64],
        terms: &mut [Term<'_>],
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let degree = self.prepare(terms);
        let scale = 2.0 / self.bound;
        let [before, here, product] = &mut self.vectors;
        here.copy_from_slice(x);
        accumulate(&self.coefficients, 0, here, terms);
        for k in 1..=degree {
            interrupt.poll()?;
            apply(here, product);
            self.products += 1;
            // T₁ = Y T₀, T_{k+1} = 2 Y T_k − T_{k−1}; the new vector replaces the oldest.
            let (double, oldest) = if k == 1 { (1.0, 0.0) } else { (2.0, 1.0) };
            before
                .par_chunks_mut(BLOCK)
                .zip(here.par_chunks(BLOCK))
                .zip(product.par_chunks(BLOCK))
                .for_each(|((before, here), product)| {
                    for ((before, here), product) in before.iter_mut().zip(here).zip(product) {
                        let turned = scale * product - here;
                        *before = double * turned - oldest * *before;
                    }
                });
            std::mem::swap(before, here);
            accumulate(&self.coefficients, k, here, terms);
        }
        Ok(())
    }
}

/// Adds c_k T_k x to every term of sufficient degree.
fn accumulate(coefficients: &[Vec<f64>], k: usize, vector: &[f64], terms: &mut [Term<'_>]) {
    for (coefficients, term) in coefficients.iter().zip(terms) {
        let Some(&factor) = coefficients.get(k) else {
            continue;
        };
        term.out
            .par_chunks_mut(BLOCK)
            .zip(vector.par_chunks(BLOCK))
            .for_each(|(out, vector)| {
                for (out, x) in out.iter_mut().zip(vector) {
                    *out += factor * x;
                }
            });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_equal_the_functions_for_a_scalar() {
        for a in [0.01f64, 0.2, 6.0, 60.0, 300.0] {
            let tau = 1.7;
            let bound = (a / tau).powi(2);
            let mut engine = Chebyshev::new(bound, 1);
            for part in [0.0, 1e-9, 0.3, 1.0] {
                let square = part * bound;
                let mut apply = |x: &[f64], out: &mut [f64]| out[0] = square * x[0];
                for function in [
                    WaveFunction::Cosine,
                    WaveFunction::Sine,
                    WaveFunction::Slope,
                    WaveFunction::Versine,
                    WaveFunction::Ramp,
                    WaveFunction::Parabola,
                    WaveFunction::Cubic,
                ] {
                    let mut out = [0.0];
                    let terms = &mut [Term::new(function, tau, &mut out)];
                    engine
                        .add(&mut apply, &[1.0], terms, Interrupt::never())
                        .unwrap();
                    let exact = function.value(tau, square);
                    let largest = match function {
                        WaveFunction::Cosine => 1.0,
                        WaveFunction::Sine => tau,
                        WaveFunction::Slope => bound.sqrt(),
                        WaveFunction::Versine => 0.5 * tau * tau,
                        WaveFunction::Ramp => tau.powi(3) / 6.0,
                        WaveFunction::Parabola => tau.powi(4) / 24.0,
                        WaveFunction::Cubic => tau.powi(5) / 120.0,
                    };
                    let error = (out[0] - exact).abs() / largest;
                    assert!(
                        error < 1e-15 * (10.0 + a),
                        "{function:?} {a} {part}: {error:e}"
                    );
                }
            }
        }
    }
}
