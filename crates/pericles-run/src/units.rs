//! Formatting of numbers with units.

/// Formats a time span: `0.4 s`, `12 s`, `3 min 20 s`, `2 h 5 min`.
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "unknown time".into();
    }
    if seconds < 10.0 {
        return format!("{:.1} s", seconds.max(0.0));
    }
    let whole = seconds.round() as u64;
    match whole {
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    }
}

/// Formats a memory size: `512 B`, `16.2 MB`.
pub fn bytes(count: u64) -> String {
    let size = count as f64;
    let (factor, unit) = match count {
        0..1_000 => (1.0, "B"),
        1_000..1_000_000 => (1e3, "kB"),
        1_000_000..1_000_000_000 => (1e6, "MB"),
        _ => (1e9, "GB"),
    };
    format!("{} {unit}", significant(size / factor, 3))
}

/// Formats a number of threads: `1 thread`, `2 threads`.
pub fn threads(number: usize) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} thread{ending}")
}

/// Formats a ratio in percent with two significant digits.
pub fn percent(ratio: f64) -> String {
    if !ratio.is_finite() {
        return "unknown".into();
    }
    format!("{} %", significant(100.0 * ratio, 2))
}

pub use pericles::units::{count, number_of, quantity, significant};

/// Formats an angular frequency (1/s) with five significant digits: `1.6330`, `5.8244e6`.
pub fn frequency(omega: f64) -> String {
    if omega == 0.0 || (1e-3..1e5).contains(&omega.abs()) {
        significant(omega, 5)
    } else {
        format!("{omega:.4e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_spans_are_formatted_with_units() {
        for (seconds, text) in [
            (0.04, "0.0 s"),
            (9.94, "9.9 s"),
            (59.4, "59 s"),
            (59.6, "1 min 0 s"),
            (3599.9, "1 h 0 min"),
            (7500.0, "2 h 5 min"),
            (f64::NAN, "unknown time"),
        ] {
            assert_eq!(duration(seconds), text);
        }
    }

    #[test]
    fn ratios_and_sizes_are_rounded() {
        assert_eq!(frequency(1.633), "1.6330");
        assert_eq!(frequency(5_824_437.0), "5.8244e6");
        assert_eq!(percent(0.000_234_5), "0.023 %");
        assert_eq!(percent(-0.5), "-50 %");
        assert_eq!(bytes(999), "999 B");
        assert_eq!(bytes(51_234_567), "51.2 MB");
    }
}
