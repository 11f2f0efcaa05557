//! Student's t distribution.

use std::f64::consts::FRAC_PI_2;

/// Returns t with P(|T| < t) = 95 % for `freedom` degrees of freedom, to about 1e-6; NaN for none.
///
/// With T = √ν tan θ the probability is the ratio of the integrals of cos^(ν−1) over (0, θ) and (0, π/2).
pub(super) fn two_sided_95(freedom: usize) -> f64 {
    const SHARE: f64 = 0.95;
    const CELLS: usize = 2000;
    if freedom == 0 {
        return f64::NAN;
    }
    let power = freedom as f64 - 1.0;
    // Simpson's rule.
    let integral = |end: f64| {
        let h = end / CELLS as f64;
        let height = |x: f64| x.cos().max(0.0).powf(power);
        let cell = |k: usize| {
            let x = k as f64 * h;
            height(x) + 4.0 * height(x + 0.5 * h) + height(x + h)
        };
        (0..CELLS).map(cell).sum::<f64>() * h / 6.0
    };
    let whole = integral(FRAC_PI_2);
    let (mut low, mut high) = (0.0, FRAC_PI_2);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        match integral(middle) < SHARE * whole {
            true => low = middle,
            false => high = middle,
        }
    }
    (freedom as f64).sqrt() * low.tan()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        for (freedom, t) in [
            (1, 12.7062),
            (2, 4.30265),
            (5, 2.57058),
            (30, 2.04227),
            (1000, 1.96234),
        ] {
            let found = two_sided_95(freedom);
            assert!((found / t - 1.0).abs() < 1e-5, "{freedom}: {found}");
        }
    }
}
