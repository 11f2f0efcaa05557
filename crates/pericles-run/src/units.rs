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

pub use pericles::units::{count, number_of, quantity, significant, unit_per};

/// Returns the SI unit of a number of `run.json` by the last part of its name; empty for ratios and counts.
///
/// Quantities of the whole body may be per unit of its section, see [`unit_per`].
pub fn unit_of_number(name: &str) -> &'static str {
    const UNITS: [(&str, &[&str]); 12] = [
        ("m", &["spacing", "horizon"]),
        (
            "s",
            &["dt", "stable_step", "t", "wall_seconds", "force_time"],
        ),
        (
            "rad/s",
            &[
                "highest_frequency",
                "highest_frequency_bound",
                "limiting_frequency",
                "limiting_frequency_bound",
                "contact_frequency",
            ],
        ),
        ("Pa", &["youngs_modulus", "bulk_modulus", "shear_modulus"]),
        ("J/m2", &["fracture_energy"]),
        ("J/m6", &["critical_bond_energy"]),
        (
            "J",
            &[
                "kinetic_energy",
                "elastic_energy",
                "dissipated_energy",
                "contact_energy",
                "contact_dissipated",
                "impactor_kinetic",
                "external_work",
                "initial_energy",
                "scheme_correction",
                "balance",
                "largest_balance",
            ],
        ),
        ("kg", &["mass"]),
        ("N", &["force"]),
        ("kg m/s", &["momentum", "impulse", "momentum_error"]),
        ("B", &["memory_estimate", "peak_memory"]),
        ("1/s", &["directed_bond_updates_per_second"]),
    ];
    let key = name.rsplit('.').next().unwrap_or(name);
    let found = UNITS.iter().find(|(_, keys)| keys.contains(&key));
    found.map_or("", |(unit, _)| unit)
}

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
    fn numbers_of_reports_have_units() {
        for (name, unit) in [
            ("audit.elastic_energy", "J"),
            ("audit.balance", "J"),
            ("audit.balance_over_work", ""),
            ("model.fracture_energy", "J/m2"),
            ("model.dt", "s"),
            ("audit.broken_bonds", ""),
        ] {
            assert_eq!(unit_of_number(name), unit, "{name}");
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
