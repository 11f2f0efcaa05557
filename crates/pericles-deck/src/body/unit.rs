//! Units of length of files.

use crate::declaration::Check;
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::reader::Item;
use crate::units::{self, UnitError};

/// Reads a unit of length, returned in metres.
pub(crate) fn unit_of<S>(item: &Item<'_>, _: S) -> Option<f64> {
    let text = item.text()?;
    length_unit(&text).map_err(|fault| item.report(fault)).ok()
}

pub(crate) fn check_unit<S>(unit: &f64, path: &KeyPath, _: S, check: &mut Check) {
    check.positive(path.key("unit"), *unit);
}

/// Converts a unit of length such as "mm" or "1 mm" to metres.
///
/// # Errors
/// The text is not a unit of length.
pub fn length_unit(text: &str) -> Result<f64, Fault> {
    let unknown = |unit: &str, nearest: Option<String>| Fault::UnknownUnit {
        value: text.into(),
        unit: unit.into(),
        nearest,
        expected: "the unit of length of the file, such as \"mm\"".into(),
    };
    let text = text.trim();
    let with_number = match text.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
        true => text.to_owned(),
        false => format!("1 {text}"),
    };
    match units::parse(&with_number) {
        Ok(measure)
            if measure.dimension == Some(Quantity::Length.dimension()) && measure.value > 0.0 =>
        {
            Ok(measure.value)
        }
        Err(UnitError::Unknown { symbol, nearest }) => Err(unknown(&symbol, nearest)),
        _ => Err(unknown(text, None)),
    }
}

#[cfg(test)]
mod tests {
    use super::length_unit;

    #[test]
    fn units_of_length_are_symbols_or_lengths() {
        assert_eq!(length_unit("mm").unwrap(), 1e-3);
        assert_eq!(length_unit("m").unwrap(), 1.0);
        assert_eq!(length_unit("25.4 mm").unwrap(), 0.0254);
        for wrong in ["", "MPa", "3", "-1 mm", "0 mm", "mmm"] {
            assert!(length_unit(wrong).is_err(), "{wrong}");
        }
    }
}
