//! Formatting of numbers and lengths in messages.

/// Formats a number with four digits.
pub(crate) fn short(x: f64) -> String {
    if x == 0.0 || (0.99995e-3..1e4).contains(&x.abs()) {
        let digits = 3 - x.abs().max(1e-3).log10().floor() as i32;
        let text = format!("{x:.*}", digits.clamp(0, 6) as usize);
        return match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        };
    }
    let text = format!("{x:.3e}");
    match text.split_once('e') {
        Some((digits, power)) => {
            let digits = digits.trim_end_matches('0').trim_end_matches('.');
            format!("{digits}e{power}")
        }
        None => text,
    }
}

/// Formats a position in a plane, given in metres, in the unit that suits its larger coordinate.
pub(crate) fn place(at: [f64; 2]) -> String {
    const UNITS: [(&str, f64); 4] = [("km", 1e3), ("m", 1.0), ("mm", 1e-3), ("um", 1e-6)];
    let largest = at[0].abs().max(at[1].abs());
    let fits = |&&(_, size): &&(&str, f64)| largest >= size;
    let (unit, size) = match UNITS.iter().find(fits) {
        Some(&found) => found,
        None if largest == 0.0 => ("m", 1.0),
        None => ("nm", 1e-9),
    };
    let [x, y] = at.map(|x| short(x / size));
    format!("x = {x} {unit}, y = {y} {unit}")
}

#[cfg(test)]
mod tests {
    use super::{place, short};

    #[test]
    fn numbers_in_messages_have_four_digits() {
        for (x, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (0.2, "0.2"),
            (12.345678, "12.35"),
            (-1234.56, "-1235"),
            (9999.9, "10000"),
            (1.5e-5, "1.5e-5"),
            (1e30, "1e30"),
            (0.012345678, "0.01235"),
        ] {
            assert_eq!(short(x), text);
        }
    }

    #[test]
    fn positions_use_the_unit_of_their_largest_coordinate() {
        assert_eq!(place([5e-4, 1.5e-3]), "x = 0.5 mm, y = 1.5 mm");
        assert_eq!(place([0.0, -12.0]), "x = 0 m, y = -12 m");
        assert_eq!(place([0.0, 0.0]), "x = 0 m, y = 0 m");
        assert_eq!(place([2e-6, 0.0]), "x = 2 um, y = 0 um");
        assert_eq!(place([3e3, 4.5e4]), "x = 3 km, y = 45 km");
    }
}
