//! Bessel functions of the first kind for a sequence of orders.

/// Computes J_0(x) … J_{m−1}(x) for x ≥ 0, accurate to some 1e-16 of max(1, …), small values to full relative
/// accuracy.
///
/// Miller's backward recurrence J_{k−1} = (2k/x) J_k − J_{k+1} from far beyond the turning point k ≈ x, normalised
/// by J₀ + 2 Σ J_2k = 1 (DLMF 3.6, 10.12.4).
pub fn bessel_into(x: f64, values: &mut [f64]) {
    /// A power of two, so that rescaling is exact.
    const LARGE: f64 = 1.340_780_792_994_259_7e154;
    const SMALL: f64 = 1.0 / LARGE;
    values.fill(0.0);
    if values.is_empty() {
        return;
    }
    if x == 0.0 {
        values[0] = 1.0;
        return;
    }
    // Beyond x + 12 x^⅓ + 30 orders J is below 1e-17 of its largest value.
    let turning = x + 12.0 * x.cbrt() + 30.0;
    let start = 2 * ((turning.max(values.len() as f64 + 30.0) / 2.0).ceil() as usize);
    let (mut above, mut here) = (0.0, SMALL);
    let mut sum = 0.0;
    for k in (0..=start).rev() {
        if k < values.len() {
            values[k] = here;
        }
        if k % 2 == 0 {
            sum += if k == 0 { here } else { 2.0 * here };
        }
        if k == 0 {
            break;
        }
        let below = 2.0 * k as f64 / x * here - above;
        (above, here) = (here, below);
        if here.abs() > LARGE {
            above *= SMALL;
            here *= SMALL;
            sum *= SMALL;
            values.iter_mut().skip(k).for_each(|value| *value *= SMALL);
        }
    }
    values.iter_mut().for_each(|value| *value /= sum);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// J_k(x) = 1/π ∫₀^π cos(kθ − x sin θ) dθ: the trapezoidal rule is exact to round-off with enough points.
    fn integral(k: usize, x: f64) -> f64 {
        let points = 400 + 4 * x as usize;
        let angle = |j: usize| std::f64::consts::PI * j as f64 / points as f64;
        let value = |j: usize| (k as f64 * angle(j) - x * angle(j).sin()).cos();
        let inner: f64 = (1..points).map(value).sum();
        (inner + 0.5 * (value(0) + value(points))) / points as f64
    }

    #[test]
    fn bessel_functions_equal_their_integral() {
        let mut values = vec![0.0; 140];
        for x in [1e-3, 0.7, 2.4, 11.0, 60.0, 100.0] {
            bessel_into(x, &mut values);
            for k in [0, 1, 2, 5, 17, 61, 130] {
                let error = (values[k] - integral(k, x)).abs();
                assert!(error < 2e-15, "J_{k}({x}): {error:e}");
            }
        }
    }

    #[test]
    fn small_bessel_values_keep_relative_accuracy() {
        // J_4(x) = (x/2)⁴/24 (1 − x²/20 + …)
        let mut values = [0.0; 6];
        for x in [1e-9f64, 1e-3] {
            bessel_into(x, &mut values);
            let leading = (0.5 * x).powi(4) / 24.0 * (1.0 - x * x / 20.0);
            assert!((values[4] / leading - 1.0).abs() < 1e-12);
        }
        bessel_into(0.0, &mut values);
        assert_eq!(values, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    }
}
