//! Positions and labels of ticks.

use pericles::units::{power_of_ten, superscript};

/// The ticks of an axis or a colour bar.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Ticks {
    /// Labelled ticks.
    pub(super) major: Vec<(f64, String)>,
    /// Short ticks between them.
    pub(super) minor: Vec<f64>,
}

impl Ticks {
    /// Returns about `wanted` multiples of 1, 2 or 5 times a power of ten from `low` to `high`, at least two.
    pub(super) fn linear(low: f64, high: f64, wanted: usize) -> Self {
        if low.is_nan() || high.is_nan() || high <= low || !(high - low).is_finite() {
            return Self::default();
        }
        let (mut mantissa, mut power) = step((high - low) / wanted.max(1) as f64);
        loop {
            let step = f64::from(mantissa) * power_of_ten(power);
            // Slightly beyond the ends, so that rounding does not drop a tick there
            let slack = 1e-9 * (high - low) / step;
            let first = (low / step - slack).ceil();
            let last = (high / step + slack).floor();
            if last <= first {
                (mantissa, power) = match mantissa {
                    5 => (2, power),
                    2 => (1, power),
                    _ => (5, power - 1),
                };
                continue;
            }
            let digits = (-power).clamp(0, 12) as usize;
            let label = |value: f64| without_minus_zero(format!("{value:.digits$}"));
            let major = (0..=(last - first) as usize)
                .map(|k| (first + k as f64) * step)
                .map(|value| (value, label(value)))
                .collect();
            return Self {
                major,
                minor: Vec::new(),
            };
        }
    }

    /// Returns powers of ten from `low` to `high`; over less than two decades also 2 and 5 times these.
    pub(super) fn logarithmic(low: f64, high: f64, wanted: usize) -> Self {
        if !(low > 0.0 && high > low && high.is_finite()) {
            return Self::default();
        }
        let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
        let inside = |value: f64| value >= low * (1.0 - 1e-9) && value <= high * (1.0 + 1e-9);
        let decades = high.log10() - low.log10();
        let every = ((decades / wanted.max(1) as f64).ceil() as usize).max(1);
        let mut ticks = Self::default();
        for power in first..=last {
            for mantissa in 1..10 {
                let value = f64::from(mantissa) * power_of_ten(power);
                let labelled = match mantissa {
                    1 => ((power - first) as usize).is_multiple_of(every),
                    2 | 5 => decades < 2.0,
                    _ => decades < 0.5,
                };
                if !inside(value) {
                    continue;
                }
                if labelled {
                    ticks
                        .major
                        .push((value, logarithmic_label(mantissa, power)));
                } else if every == 1 || mantissa == 1 {
                    ticks.minor.push(value);
                }
            }
        }
        ticks
    }

    /// Returns the longest label by the given measure of length.
    pub(super) fn longest(&self, width: impl Fn(&str) -> f64) -> f64 {
        self.major
            .iter()
            .map(|(_, label)| width(label))
            .fold(0.0, f64::max)
    }
}

/// Returns the smallest of 1, 2, 5 times a power of ten that is at least `raw`, as mantissa and exponent.
fn step(raw: f64) -> (u8, i32) {
    let power = raw.log10().floor() as i32;
    let mantissa = raw / power_of_ten(power);
    // the tolerance keeps a step of exactly 0.2 from becoming 0.5
    match mantissa - 1e-9 {
        m if m <= 1.0 => (1, power),
        m if m <= 2.0 => (2, power),
        m if m <= 5.0 => (5, power),
        _ => (1, power + 1),
    }
}

/// Returns the largest of 1, 2, 5 times a power of ten that is at most `limit`.
pub(super) fn round_below(limit: f64) -> f64 {
    let power = limit.log10().floor() as i32;
    let mantissa = limit / power_of_ten(power) + 1e-9;
    let best = [5.0, 2.0].into_iter().find(|&m| m <= mantissa);
    best.unwrap_or(1.0) * power_of_ten(power)
}

fn logarithmic_label(mantissa: i32, power: i32) -> String {
    let plain = (-1..=3).contains(&power) && mantissa != 1;
    match mantissa {
        1 => format!("10{}", superscript(power)),
        _ if plain => format!("{}", f64::from(mantissa) * power_of_ten(power)),
        _ => format!("{mantissa}·10{}", superscript(power)),
    }
}

fn without_minus_zero(label: String) -> String {
    match label.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| c == '0' || c == '.') => rest.to_owned(),
        // a typographic minus sign, as wide as a digit
        Some(rest) => format!("−{rest}"),
        None => label,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn labels(ticks: &Ticks) -> Vec<&str> {
        ticks.major.iter().map(|(_, label)| &**label).collect()
    }

    #[test]
    fn round_numbers_are_chosen() {
        assert_eq!(
            labels(&Ticks::linear(0.0, 1.0, 5)),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(
            labels(&Ticks::linear(-50.0, 50.0, 5)),
            ["−40", "−20", "0", "20", "40"]
        );
        assert_eq!(
            labels(&Ticks::linear(0.98, 1.021, 4)),
            ["0.98", "1.00", "1.02"]
        );
        assert!(Ticks::linear(1.0, 1.0, 5).major.is_empty());
        assert!(Ticks::linear(f64::NAN, 1.0, 5).major.is_empty());
    }

    #[test]
    fn decades_are_labelled_and_subdivided() {
        let ticks = Ticks::logarithmic(1e-3, 1e1, 6);
        assert_eq!(labels(&ticks), ["10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]);
        assert_eq!(ticks.minor.len(), 4 * 8);
        let many = Ticks::logarithmic(1e-16, 1.0, 4);
        assert_eq!(labels(&many), ["10⁻¹⁶", "10⁻¹²", "10⁻⁸", "10⁻⁴", "10⁰"]);
        let few = Ticks::logarithmic(0.15, 3.0, 6);
        assert_eq!(labels(&few), ["0.2", "0.5", "10⁰", "2"]);
        assert!(Ticks::logarithmic(0.0, 1.0, 5).major.is_empty());
    }

    #[test]
    fn scale_bars_have_round_lengths() {
        for (limit, round) in [
            (0.3, 0.2),
            (0.5, 0.5),
            (9.9, 5.0),
            (10.0, 10.0),
            (1.2e-3, 1e-3),
        ] {
            assert_eq!(round_below(limit), round);
        }
    }

    proptest! {
        #[test]
        fn labels_match_their_values_and_lie_inside_the_range(low in -1e6_f64..1e6, size in 1e-3_f64..1e6, wanted in 2_usize..12) {
            let high = low + size;
            let ticks = Ticks::linear(low, high, wanted);
            prop_assert!((2..=5.max(wanted + 1)).contains(&ticks.major.len()));
            for (value, label) in &ticks.major {
                let slack = 1e-8 * size;
                prop_assert!(*value >= low - slack && *value <= high + slack);
                let told: f64 = label.replace('−', "-").parse().unwrap();
                prop_assert!((told - value).abs() <= 1e-9 * value.abs().max(size));
            }
        }
    }
}
