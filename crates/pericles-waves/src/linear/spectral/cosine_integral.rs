//! Entire cosine integral.

/// Computes Cin(x) = ∫₀^x (1 − cos t)/t dt = γ + ln x − Ci(x) for x ≥ 0 (DLMF 6.2.12), to some 1e-15 (1 + Cin).
pub(super) fn cin(x: f64) -> f64 {
    /// Euler's constant (DLMF 5.2.3).
    const GAMMA: f64 = 0.577_215_664_901_532_9;
    /// Argument at which the series loses a digit and the continued fraction needs about fifty terms.
    const SWITCH: f64 = 4.0;
    if x <= SWITCH {
        // Σ (−1)^{k+1} x^{2k} / (2k (2k)!), DLMF 6.6.6
        let (mut term, mut sum) = (-1.0, 0.0);
        for k in 1..60 {
            let two_k = 2.0 * f64::from(k);
            term *= -x * x / (two_k * (two_k - 1.0));
            sum += term / two_k;
            if term.abs() < 1e-18 * sum {
                break;
            }
        }
        sum
    } else {
        GAMMA + x.ln() - ci(x)
    }
}

/// Ci(x) = −Re E₁(ix), by the continued fraction E₁(z) = e^{−z}/(z+1−1²/(z+3−2²/(z+5−…))) (DLMF 6.9.1, even part) with Lentz's method.
fn ci(x: f64) -> f64 {
    type Complex = rustfft::num_complex::Complex<f64>;
    let one = Complex::new(1.0, 0.0);
    let mut b = Complex::new(1.0, x);
    let mut c = Complex::new(1e300, 0.0);
    let mut d = one / b;
    let mut fraction = d;
    for k in 1..500 {
        let a = -f64::from(k * k);
        b += 2.0;
        d = one / (d * a + b);
        c = b + one / c * a;
        let factor = c * d;
        fraction *= factor;
        if (factor - one).norm() < 1e-16 {
            break;
        }
    }
    -(fraction * Complex::new(0.0, -x).exp()).re
}

#[cfg(test)]
mod tests {
    use super::*;
    use gauss_quad::GaussLegendre;

    #[test]
    fn cosine_integral_equals_its_quadrature() {
        let rule = GaussLegendre::new(std::num::NonZeroUsize::new(32).unwrap());
        for x in [1e-6, 0.3, 3.999, 4.001, 7.0, 30.0, 200.0] {
            let pieces = 1 + x as usize;
            let integral: f64 = (0..pieces)
                .map(|k| {
                    let at = |k: usize| x * k as f64 / pieces as f64;
                    rule.integrate(at(k), at(k + 1), |t| 2.0 * (0.5 * t).sin().powi(2) / t)
                })
                .sum();
            let error = (cin(x) - integral).abs() / integral;
            assert!(error < 4e-15, "{x}: {error:e}");
        }
    }
}
