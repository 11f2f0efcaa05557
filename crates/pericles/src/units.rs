//! Numbers in messages and plots: few digits, with SI prefixes, or a power of ten where a prefix would be wrong.

/// Units that take a prefix, alone or as the first factor of a product or quotient.
const PREFIXED: [&str; 10] = ["m", "s", "N", "J", "Pa", "W", "Hz", "g", "K", "B"];

/// Prefixes from 10⁻¹² to 10¹².
const PREFIXES: [&str; 9] = ["p", "n", "µ", "m", "", "k", "M", "G", "T"];

/// Units of quantities of a whole body: forces, energies, momenta and masses.
///
/// A body in two dimensions that is 1 m thick, the default, represents one of any thickness, and a bar with an area of 1 m²
/// one of any area. Their quantities are given per metre or per square metre.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BodyUnits {
    dimension: usize,
    is_unit: bool,
}

impl BodyUnits {
    /// Returns the units of a body with the given thickness (m) in two dimensions or area (m²) in one dimension.
    pub fn of(dimension: usize, section: f64) -> Self {
        Self {
            dimension,
            is_unit: dimension < 3 && section == 1.0,
        }
    }

    /// Returns the unit of the thickness or area by which the quantities are divided, `m` or `m2`; none if they are those of the
    /// whole body.
    pub fn per(self) -> Option<&'static str> {
        match (self.is_unit, self.dimension) {
            (false, _) => None,
            (true, 1) => Some("m2"),
            (true, _) => Some("m"),
        }
    }

    /// Returns the unit of a quantity that has the given SI unit for the whole body: `N/m` for `N`.
    pub fn unit(self, whole: &str) -> String {
        unit_per(whole, self.per())
    }

    /// Returns the unit for the whole body of a quantity with the given unit: `N` for `N/m`; the unit itself for other quantities.
    pub fn whole(self, unit: &str) -> &str {
        let is_own = |whole: &&str| self.per().is_some() && self.unit(whole) == unit;
        OF_BODY.into_iter().find(is_own).unwrap_or(unit)
    }

    /// Formats a quantity of the whole body, with the given SI unit, as [`quantity`] does.
    pub fn quantity(self, value: f64, whole: &str) -> String {
        quantity(value, &self.unit(whole))
    }
}

/// SI units of quantities of a whole body.
const OF_BODY: [&str; 6] = ["N", "J", "kg", "kg m/s", "N m", "N s"];

/// Returns the SI unit of a quantity of a body per metre of thickness or per square metre of area; the unit itself for other
/// quantities, such as lengths.
pub fn unit_per(whole: &str, per: Option<&str>) -> String {
    match per.filter(|_| OF_BODY.contains(&whole)) {
        None => whole.into(),
        Some("m") if whole == "kg m/s" => "kg/s".into(),
        Some("m") if whole == "N m" => "N".into(),
        Some(per) => format!("{whole}/{per}"),
    }
}

/// Scaling of numbers of one kind for display.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Divisor of the values.
    pub factor: f64,
    /// Unit with its prefix or power of ten.
    pub unit: String,
}

impl Shown {
    /// Chooses prefix or power of ten for numbers up to `largest` in magnitude.
    pub fn for_size(largest: f64, unit: &str) -> Self {
        if !largest.is_finite() || largest <= 0.0 {
            return Self::plain(unit);
        }
        let thousands = (largest.log10() + 1e-9).div_euclid(3.0) as i32;
        let symbol = unit.split(['/', '·', ' ']).next().unwrap_or_default();
        if PREFIXED.contains(&symbol) {
            // Kiloseconds are not in use.
            let most = if symbol == "s" { 0 } else { 4 };
            let thousands = thousands.clamp(-4, most);
            let prefix = PREFIXES[(thousands + 4) as usize];
            // 10⁻⁶ as the nearest double, which (10³)⁻² is not: 46e-6 / 1e-6 must print as 46.
            return Self {
                factor: power_of_ten(3 * thousands),
                unit: format!("{prefix}{unit}"),
            };
        }
        // Numbers from 0.001 to five digits need no power of ten.
        let power = largest.log10().floor() as i32;
        if (-3..5).contains(&power) {
            return Self::plain(unit);
        }
        let ten = format!("10{}", superscript(3 * thousands));
        Self {
            factor: power_of_ten(3 * thousands),
            unit: format!("{ten} {unit}").trim_end().to_owned(),
        }
    }

    /// The unit without a prefix.
    pub fn plain(unit: &str) -> Self {
        Self {
            factor: 1.0,
            unit: unit.to_owned(),
        }
    }

    /// Returns `name [unit]`, or the name alone for dimensionless numbers.
    pub fn label(&self, name: &str) -> String {
        match (name.is_empty(), self.unit.is_empty()) {
            (_, true) => name.to_owned(),
            (true, false) => format!("[{}]", self.unit),
            (false, false) => format!("{name} [{}]", self.unit),
        }
    }
}

/// Formats a quantity with three digits and a suitable SI prefix: `46.0 µs`.
pub fn quantity(value: f64, unit: &str) -> String {
    // Round first: 999.96 ns is 1.00 µs.
    let rounded: f64 = format!("{value:.2e}").parse().unwrap_or(value);
    let shown = Shown::for_size(rounded.abs(), unit);
    let scaled = rounded / shown.factor;
    // Beyond the prefixes.
    if scaled != 0.0 && !(1e-3..1e6).contains(&scaled.abs()) && scaled.is_finite() {
        return format!("{rounded:.2e} {unit}").trim_end().to_owned();
    }
    let digits = if scaled == 0.0 || !scaled.is_finite() {
        0
    } else {
        (2 - (scaled.abs().log10() + 1e-9).floor() as i32).clamp(0, 9) as usize
    };
    format!("{scaled:.digits$} {}", shown.unit)
        .trim_end()
        .to_owned()
}

/// Formats a quantity with its SI prefix and up to seven digits, for use in an input: `0.7017544 mm`.
pub fn precise(value: f64, unit: &str) -> String {
    let rounded: f64 = format!("{value:.6e}").parse().unwrap_or(value);
    let shown = Shown::for_size(rounded.abs(), unit);
    let scaled: f64 = format!("{:.6e}", rounded / shown.factor)
        .parse()
        .unwrap_or(rounded);
    if scaled != 0.0 && !(1e-3..1e6).contains(&scaled.abs()) {
        return format!("{rounded:e} {unit}");
    }
    format!("{scaled} {}", shown.unit).trim_end().to_owned()
}

/// Formats a number with the given significant digits, without an exponent where that is readable: `0.001809`,
/// `1540`, `7.20e10`.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let rounded: f64 = format!("{value:.*e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(value);
    let size = rounded.abs();
    if (1e-4..1e7).contains(&size) {
        let decimals = (digits as f64 - 1.0 - size.log10().floor()).clamp(0.0, 12.0);
        format!("{rounded:.*}", decimals as usize)
    } else {
        format!("{rounded:.*e}", digits.saturating_sub(1))
    }
}

/// Formats a number of units, such as load steps: whole numbers without decimals, others with three digits.
pub fn number_of(value: f64) -> String {
    let whole = value.round();
    match (value - whole).abs() < 1e-6 * value.abs() {
        true => format!("{whole}"),
        false => significant(value, 3),
    }
}

/// Formats a large count in groups of three digits: `1 234 567`.
pub fn count(number: u64) -> String {
    let digits = number.to_string();
    let mut grouped = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            grouped.push(' ');
        }
        grouped.push(digit);
    }
    grouped
}

/// Returns the double nearest to 10ⁿ.
pub fn power_of_ten(power: i32) -> f64 {
    format!("1e{power}").parse().unwrap_or(f64::NAN)
}

/// Formats an integer as superscript digits.
pub fn superscript(number: i32) -> String {
    number
        .to_string()
        .chars()
        .map(|character| match character {
            '-' => '⁻',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '0' => '⁰',
            digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantities_of_a_body_are_per_unit_section() {
        let unit = |dimension, section| BodyUnits::of(dimension, section).unit("N");
        assert_eq!(unit(1, 1.0), "N/m2");
        assert_eq!(unit(2, 1.0), "N/m");
        assert_eq!(unit(2, 0.01), "N");
        assert_eq!(unit(3, 1.0), "N");
        let plate = BodyUnits::of(2, 1.0);
        assert_eq!(plate.unit("kg m/s"), "kg/s");
        assert_eq!(plate.unit("Pa"), "Pa");
        assert_eq!(plate.quantity(1200.0, "J"), "1.20 kJ/m");
        assert_eq!(plate.whole("J/m"), "J");
        assert_eq!(plate.whole("m/s"), "m/s");
        assert_eq!(BodyUnits::of(3, 1.0).whole("N/m"), "N/m");
    }

    #[test]
    fn lengths_take_the_unit_of_their_size() {
        for (size, factor, unit) in [
            (0.1, 1e-3, "mm"),
            (1.0, 1.0, "m"),
            (0.999, 1e-3, "mm"),
            (25e-6, 1e-6, "µm"),
            (1e-3, 1e-3, "mm"),
            (1000.0, 1e3, "km"),
            (3e-20, 1e-12, "pm"),
        ] {
            let shown = Shown::for_size(size, "m");
            assert_eq!((shown.factor, &*shown.unit), (factor, unit), "{size}");
        }
    }

    #[test]
    fn only_units_that_can_take_a_prefix_get_one() {
        let label = |size, unit| Shown::for_size(size, unit).label("q");
        assert_eq!(label(2e7, "J/m³"), "q [MJ/m³]");
        assert_eq!(label(2e7, "m²"), "q [10⁶ m²]");
        assert_eq!(label(2e7, ""), "q [10⁶]");
        assert_eq!(label(5e-5, ""), "q [10⁻⁶]");
        assert_eq!(label(0.7, ""), "q");
        assert_eq!(label(4e4, "kg/m³"), "q [kg/m³]");
        assert_eq!(label(3e5, "s"), "q [s]");
        assert_eq!(label(0.0, "m/s"), "q [m/s]");
        assert_eq!(label(f64::NAN, "m/s"), "q [m/s]");
    }

    #[test]
    fn quantities_have_three_digits() {
        for (value, text) in [
            (46e-6, "46.0 µs"),
            (0.0, "0 s"),
            (999.96e-9, "1.00 µs"),
            (5e-7, "500 ns"),
            (12.345, "12.3 s"),
            (86_400.0, "86400 s"),
            (-2e-3, "-2.00 ms"),
            (1.06e-15, "0.00106 ps"),
            (-3.456e-20, "-3.46e-20 s"),
            (2e6, "2.00e6 s"),
        ] {
            assert_eq!(quantity(value, "s"), text);
        }
    }

    #[test]
    fn precise_quantities_have_up_to_seven_digits() {
        assert_eq!(precise(0.04 / 57.0, "m"), "701.7544 µm");
        assert_eq!(precise(0.1, "m"), "100 mm");
        assert_eq!(precise(1e30, "m"), "1e30 m");
    }

    #[test]
    fn significant_digits_are_rounded() {
        assert_eq!(significant(0.001_808_7, 4), "0.001809");
        assert_eq!(significant(1541.3, 3), "1540");
        assert_eq!(significant(9.996, 3), "10.0");
        assert_eq!(significant(7.2e10, 3), "7.20e10");
        assert_eq!(significant(-3.0e-9, 2), "-3.0e-9");
        assert_eq!(significant(f64::NAN, 2), "NaN");
    }

    #[test]
    fn counts_are_grouped() {
        assert_eq!(count(0), "0");
        assert_eq!(count(999), "999");
        assert_eq!(count(1_234_567), "1 234 567");
    }

    #[test]
    fn exponents_are_raised() {
        assert_eq!(superscript(-1234567890), "⁻¹²³⁴⁵⁶⁷⁸⁹⁰");
    }
}
