//! Numbers with units: `"72 GPa"`, `"0.25 mm"`, `"135 J/m2"`.
//!
//! A quantity is a number, an optional space, and a unit. A unit is a product (`*`, `·`) and quotient (`/`,
//! from left to right) of prefixed symbols with integer powers: `kg/m3`, `kg·m^-3`, `N/m²`, `1/s`. Powers of
//! ten are added to the exponent of the number before it is rounded to binary, so that `"0.25 mm"` is the
//! same double as `0.25e-3`.

use crate::dimension::Dimension;

/// A number in SI units and the dimension of its unit; none without a unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Measure {
    pub(crate) value: f64,
    pub(crate) dimension: Option<Dimension>,
}

/// Errors of parsing a quantity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum UnitError {
    /// The text does not begin with a number.
    NoNumber,
    /// The number is too large for a double.
    TooLarge,
    /// An unknown symbol, with the most similar unit.
    Unknown {
        symbol: String,
        nearest: Option<String>,
    },
    /// A unit that is not a product of powers.
    Malformed { unit: String },
    /// A number with a decimal comma.
    Comma,
}

/// A unit: its size is `factor · 10^exponent` in SI.
struct Unit {
    symbol: &'static str,
    exponent: i32,
    factor: f64,
    dimension: Dimension,
    prefixed: bool,
}

const fn unit(symbol: &'static str, exponent: i32, kg: i32, m: i32, s: i32) -> Unit {
    Unit {
        symbol,
        exponent,
        factor: 1.0,
        dimension: Dimension::new(kg, m, s),
        prefixed: true,
    }
}

const fn plain(symbol: &'static str, exponent: i32, factor: f64, s: i32) -> Unit {
    Unit {
        symbol,
        exponent,
        factor,
        dimension: Dimension::new(0, 0, s),
        prefixed: false,
    }
}

const UNITS: [Unit; 16] = [
    unit("m", 0, 0, 1, 0),
    unit("g", -3, 1, 0, 0),
    unit("s", 0, 0, 0, 1),
    unit("N", 0, 1, 1, -2),
    unit("Pa", 0, 1, -1, -2),
    unit("bar", 5, 1, -1, -2),
    unit("J", 0, 1, 2, -2),
    unit("W", 0, 1, 2, -3),
    unit("Hz", 0, 0, 0, -1),
    Unit {
        symbol: "K",
        exponent: 0,
        factor: 1.0,
        dimension: Dimension::kelvin(1),
        prefixed: true,
    },
    // A point of typography, 1/72 inch.
    Unit {
        symbol: "pt",
        exponent: 0,
        factor: 25.4e-3 / 72.0,
        dimension: Dimension::new(0, 1, 0),
        prefixed: false,
    },
    plain("min", 0, 60.0, 1),
    plain("h", 0, 3600.0, 1),
    plain("%", -2, 1.0, 0),
    plain("rad", 0, 1.0, 0),
    plain("deg", 0, std::f64::consts::PI / 180.0, 0),
];

const PREFIXES: [(&str, i32); 14] = [
    ("", 0),
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("u", -6),
    ("µ", -6),       // micro sign
    ("\u{3bc}", -6), // Greek mu
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// Largest power of a symbol and largest number of symbols: beyond practical use, and small enough for exact
/// arithmetic.
const LARGEST_POWER: i32 = 9;
const MOST_FACTORS: usize = 16;

/// Parses a number with an optional unit.
pub(crate) fn parse(text: &str) -> Result<Measure, UnitError> {
    let text = text.trim();
    let (number, rest) = split_number(text).ok_or(UnitError::NoNumber)?;
    if rest.starts_with(',') {
        return Err(UnitError::Comma);
    }
    let rest = rest.trim_start();
    if rest.is_empty() {
        return Ok(Measure {
            value: finite(number.parse())?,
            dimension: None,
        });
    }
    let scale = parse_unit(rest)?;
    let (mantissa, exponent) = match number.split_once(['e', 'E']) {
        // Exponents beyond i32 exceed the range of doubles, except for a zero mantissa, which no deck needs.
        Some((mantissa, exponent)) => (
            mantissa,
            exponent.parse::<i32>().map_err(|_| UnitError::TooLarge)?,
        ),
        None => (number, 0),
    };
    let exponent = exponent.saturating_add(scale.exponent);
    Ok(Measure {
        value: finite(Ok::<_, std::num::ParseFloatError>(
            finite(format!("{mantissa}e{exponent}").parse())? * scale.factor,
        ))?,
        dimension: Some(scale.dimension),
    })
}

/// Returns the dimension of an SI unit as in tables, such as `kg m/s`; none if the unit is unknown or has a factor.
pub(crate) fn dimension_of(unit: &str) -> Option<Dimension> {
    if unit.is_empty() || unit == "1" {
        return Some(Dimension::NONE);
    }
    let measure = parse(&format!("1 {}", unit.trim().replace(' ', "·"))).ok()?;
    measure.dimension.filter(|_| measure.value == 1.0)
}

fn finite(value: Result<f64, std::num::ParseFloatError>) -> Result<f64, UnitError> {
    match value {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(UnitError::TooLarge),
        Err(_) => Err(UnitError::NoNumber),
    }
}

/// Splits off the longest decimal number at the beginning.
fn split_number(text: &str) -> Option<(&str, &str)> {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        bytes[from..]
            .iter()
            .take_while(|b| b.is_ascii_digit())
            .count()
    };
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(sign);
    let mut end = sign + whole;
    let mut fraction = 0;
    if bytes.get(end) == Some(&b'.') {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return None;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let count = digits((end + 1 + sign).min(bytes.len()));
        if count > 0 {
            end += 1 + sign + count;
        }
    }
    Some(text.split_at(end))
}

struct Scale {
    exponent: i32,
    factor: f64,
    dimension: Dimension,
}

fn parse_unit(text: &str) -> Result<Scale, UnitError> {
    let malformed = || UnitError::Malformed { unit: text.into() };
    let mut scale = Scale {
        exponent: 0,
        factor: 1.0,
        dimension: Dimension::NONE,
    };
    let mut rest = text;
    let mut sign = 1;
    for count in 0.. {
        if count == MOST_FACTORS {
            return Err(malformed());
        }
        let end = rest.find(['*', '·', '⋅', '/']).unwrap_or(rest.len());
        let (factor, tail) = rest.split_at(end);
        let factor = factor.trim();
        // "1/s": only the first factor may be a plain 1.
        if !(factor == "1" && count == 0 && tail.starts_with('/')) {
            let (symbol, power) = split_power(factor).ok_or_else(malformed)?;
            let (unit, prefix) = lookup(symbol)?;
            scale.exponent += sign * power * (unit.exponent + prefix);
            scale.factor *= unit.factor.powi(sign * power);
            scale.dimension.add(unit.dimension, sign * power);
        }
        let mut letters = tail.chars();
        match letters.next() {
            None => return Ok(scale),
            Some('/') => sign = -1,
            Some(_) => sign = 1,
        }
        rest = letters.as_str();
    }
    Err(malformed())
}

/// Splits a symbol and its power: `m2`, `m^2`, `m²`, `s^-1`, `s⁻¹`.
fn split_power(factor: &str) -> Option<(&str, i32)> {
    let is_power =
        |c: char| c.is_ascii_digit() || matches!(c, '^' | '-' | '+') || superscript(c).is_some();
    let start = factor.find(is_power).unwrap_or(factor.len());
    let (symbol, power) = factor.split_at(start);
    if symbol.is_empty() {
        return None;
    }
    if power.is_empty() {
        return Some((symbol, 1));
    }
    let power = power.strip_prefix('^').unwrap_or(power);
    let plain: String = power.chars().map(|c| superscript(c).unwrap_or(c)).collect();
    let power = plain.parse::<i32>().ok()?;
    (power != 0 && power.abs() <= LARGEST_POWER).then_some((symbol.trim_end(), power))
}

fn superscript(c: char) -> Option<char> {
    const RAISED: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
    if c == '⁻' {
        return Some('-');
    }
    let digit = RAISED.chars().position(|raised| raised == c)?;
    char::from_digit(digit as u32, 10)
}

fn lookup(symbol: &str) -> Result<(&'static Unit, i32), UnitError> {
    let exact = UNITS.iter().find(|unit| unit.symbol == symbol);
    let prefixed = || {
        PREFIXES.iter().find_map(|(prefix, exponent)| {
            let base = symbol.strip_prefix(prefix)?;
            let unit = UNITS.iter().find(|u| u.prefixed && u.symbol == base)?;
            Some((unit, *exponent))
        })
    };
    exact
        .map(|unit| (unit, 0))
        .or_else(prefixed)
        .ok_or_else(|| UnitError::Unknown {
            symbol: symbol.into(),
            nearest: nearest_symbol(symbol),
        })
}

/// Common names of units, with the symbol to write.
const OTHER_NAMES: [(&str, &str); 22] = [
    ("sec", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("msec", "ms"),
    ("usec", "us"),
    ("µsec", "us"),
    ("nsec", "ns"),
    ("hour", "h"),
    ("hours", "h"),
    ("minutes", "min"),
    ("meter", "m"),
    ("metre", "m"),
    ("micron", "um"),
    ("microns", "um"),
    ("gram", "g"),
    ("tonne", "Mg"),
    ("newton", "N"),
    ("pascal", "Pa"),
    ("joule", "J"),
    ("percent", "%"),
    ("inch", "25.4 mm"),
    ("psi", "6.895 kPa"),
];

fn nearest_symbol(symbol: &str) -> Option<String> {
    let lower = symbol.to_lowercase();
    let known = OTHER_NAMES.iter().find(|(name, _)| *name == lower);
    if let Some((_, unit)) = known {
        return Some((*unit).into());
    }
    // Common prefixes come first, so that they win among equally similar ones.
    let names: Vec<String> = ["", "M", "m", "k", "G", "n", "u", "c"]
        .iter()
        .flat_map(|prefix| {
            UNITS
                .iter()
                .filter(move |unit| prefix.is_empty() || unit.prefixed)
                .map(move |unit| format!("{prefix}{}", unit.symbol))
        })
        .collect();
    // A capital M means mega, regardless of the rest.
    let first = symbol.chars().next();
    let alike = names
        .iter()
        .find(|name| name.to_lowercase() == lower && name.chars().next() == first);
    alike.cloned().or_else(|| {
        super::nearest::nearest(symbol, names.iter().map(String::as_str)).map(String::from)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn value(text: &str) -> f64 {
        parse(text).unwrap().value
    }

    #[test]
    fn known_factors() {
        for (text, si) in [
            ("72 GPa", 72e9),
            ("0.25 mm", 0.25e-3),
            ("25 ns", 25e-9),
            ("135 J/m2", 135.0),
            ("2440 kg/m3", 2440.0),
            ("7.85 g/cm3", 7850.0),
            ("7.85g/cm^3", 7850.0),
            ("12 MPa", 12e6),
            ("12 N/mm²", 12e6),
            ("20 m/s", 20.0),
            ("72 km/h", 20.0),
            ("1 mm2", 1e-6),
            ("5 N", 5.0),
            ("3 N/m3", 3.0),
            ("48 GN/m³", 48e9),
            ("50 %", 0.5),
            ("0.3 µm", 0.3e-6),
            ("0.3 \u{3bc}m", 0.3e-6),
            ("0.3 um", 0.3e-6),
            ("1 bar", 1e5),
            ("10 mbar", 1e3),
            ("10 min", 600.0),
            ("1.5 h", 5400.0),
            ("2 kW*s", 2e3),
            ("2 kW·s/m2", 2e3),
            ("2 1/s", 2.0),
            ("4 m·s⁻²", 4.0),
            ("1 mm^-1", 1e3),
            ("-1e-3 kN", -1.0),
            ("+.5 MHz", 5e5),
            ("1e3", 1e3),
        ] {
            assert_eq!(value(text), si, "{text}");
        }
    }

    #[test]
    fn dimensions() {
        let dimension = |text: &str| parse(text).unwrap().dimension;
        let joule = Some(Dimension::new(1, 2, -2));
        for text in ["1 J", "1 N*m", "1 W·s", "1 kg·m2/s2", "1 Pa*m3"] {
            assert_eq!(dimension(text), joule, "{text}");
        }
        assert_eq!(dimension("1 Pa"), dimension("1 J/m3"));
        assert_eq!(dimension("3 %"), Some(Dimension::NONE));
        assert_eq!(dimension("3"), None);
        // Quotients are evaluated from the left.
        assert_eq!(dimension("1 J/m*s"), dimension("1 N*s"));
    }

    #[test]
    fn invalid_quantities_are_rejected() {
        assert_eq!(parse(""), Err(UnitError::NoNumber));
        assert_eq!(parse("mm"), Err(UnitError::NoNumber));
        assert_eq!(parse("nan m"), Err(UnitError::NoNumber));
        assert_eq!(parse("inf"), Err(UnitError::NoNumber));
        assert_eq!(parse("32,5 GPa"), Err(UnitError::Comma));
        assert_eq!(parse("1,000"), Err(UnitError::Comma));
        assert_eq!(parse("1e999"), Err(UnitError::TooLarge));
        assert_eq!(parse("1e300 Tm3"), Err(UnitError::TooLarge));
        for text in [
            "1 m//s", "1 m/", "1 m^0", "1 m2.5", "1 m^99", "1 /s", "1 m^",
        ] {
            assert!(
                matches!(parse(text), Err(UnitError::Malformed { .. })),
                "{text}"
            );
        }
        for (text, symbol, near) in [
            ("1 GPA", "GPA", "GPa"),
            ("1 mn", "mn", "mN"),
            ("1 kpa", "kpa", "kPa"),
            ("1 MPA", "MPA", "MPa"),
            ("1 mPA", "mPA", "mPa"),
            ("1 sec", "sec", "s"),
            ("150 usec", "usec", "us"),
            ("2 microns", "microns", "um"),
            ("2 furlong", "furlong", ""),
        ] {
            let Err(UnitError::Unknown { symbol: s, nearest }) = parse(text) else {
                panic!("{text}")
            };
            assert_eq!(s, symbol);
            assert_eq!(
                nearest.as_deref(),
                (!near.is_empty()).then_some(near),
                "{text}"
            );
        }
    }

    proptest! {
        #[test]
        fn arbitrary_text_never_panics(text in ".*") {
            let _ = parse(&text);
        }

        #[test]
        fn quantity_like_text_never_panics(text in "[-+]?[0-9]{0,3}\\.?[0-9]{0,3}([eE][-+]?[0-9]{0,12})? ?[a-zA-Zµ%0-9^*/·²⁻¹ -]{0,12}") {
            if let Ok(measure) = parse(&text) {
                prop_assert!(measure.value.is_finite());
            }
        }

        #[test]
        fn powers_of_ten_are_exact(number in -1e6..1e6f64) {
            prop_assert_eq!(value(&format!("{number} mm")), format!("{number}e-3").parse::<f64>().unwrap());
            prop_assert_eq!(value(&format!("{number:e} GPa")), {
                let text = format!("{number:e}");
                let (mantissa, exponent) = text.split_once('e').unwrap();
                format!("{mantissa}e{}", exponent.parse::<i32>().unwrap() + 9).parse::<f64>().unwrap()
            });
        }

        #[test]
        fn plain_numbers_are_unchanged(number in proptest::num::f64::NORMAL) {
            prop_assert_eq!(value(&format!("{number}")), number);
            prop_assert_eq!(value(&format!("{number:e}")), number);
        }
    }
}
