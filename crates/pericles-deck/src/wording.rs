//! Formatting of numbers, positions and lists in messages.

use pericles::units;

/// Formats a count in groups of three digits; two significant digits from 1e9.
pub(crate) fn count(number: f64) -> String {
    if (0.0..1e9).contains(&number) {
        units::count(number.round_ties_even() as u64)
    } else {
        format!("{number:.1e}")
    }
}

/// Returns a text for quotation in messages; long texts are cut.
pub fn shortened(text: &str) -> String {
    const LONGEST: usize = 60;
    match text.char_indices().nth(LONGEST) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

/// Returns the end of a message about the first of several names.
pub(crate) fn further(more: usize) -> String {
    match more {
        0 => String::new(),
        more => format!("; {more} more names are shortened"),
    }
}

/// Formats a list: `a`, `b` and `c`.
pub(crate) fn names(words: &[String]) -> String {
    joined(words, '`')
}

/// Formats a list: "a", "b" and "c".
pub(crate) fn quoted(words: &[String]) -> String {
    joined(words, '"')
}

fn joined(words: &[String], mark: char) -> String {
    let words: Vec<String> = words
        .iter()
        .map(|word| format!("{mark}{word}{mark}"))
        .collect();
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        Some((last, _)) => last.clone(),
        None => "none".into(),
    }
}

/// Formats alternatives: a, b or c.
pub(crate) fn or<'a>(words: impl Iterator<Item = &'a str>) -> String {
    let words: Vec<&str> = words.collect();
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => words.concat(),
    }
}

/// Formats a number of bytes.
pub(crate) fn bytes(count: f64) -> String {
    let units = [(1e12, "TB"), (1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    match units.into_iter().find(|(size, _)| count >= *size) {
        Some((size, unit)) => format!("{:.1} {unit}", count / size),
        None => format!("{count:.0} bytes"),
    }
}

/// Formats a percentage: `12.3 %`.
pub(crate) fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    let rounded: f64 = format!("{percent:.2e}").parse().unwrap_or(percent);
    format!("{rounded} %")
}

/// Formats three digits with the prefix that keeps the number between 1 and 1000: `4.21 mm`, `812 ns`.
pub(crate) fn prefixed(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 7] = [
        (1.0, ""),
        (1e-3, "m"),
        (1e-6, "µ"),
        (1e-9, "n"),
        (1e-12, "p"),
        (1e3, "k"),
        (1e6, "M"),
    ];
    let fits = |(scale, _): &&(f64, &str)| (1.0..999.5).contains(&(value / scale));
    match PREFIXES.iter().find(fits) {
        Some((scale, prefix)) => {
            let number = value / scale;
            let decimals = 2 - number.log10().floor().clamp(0.0, 2.0) as usize;
            format!("{number:.decimals$} {prefix}{unit}")
        }
        None => format!("{value:.3e} {unit}"),
    }
}

/// Formats a position: `(0.001, 0.002)`.
pub fn spot(place: &[f64]) -> String {
    let numbers: Vec<String> = place.iter().map(|x| short(*x)).collect();
    format!("({})", numbers.join(", "))
}

/// Formats an extent: `from (0, 0) to (0.1, 0.04) m`.
pub(crate) fn reach(low: &[f64], high: &[f64]) -> String {
    format!("from {} to {} m", spot(low), spot(high))
}

/// Formats a number with four digits.
pub(crate) fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    format!("{rounded}")
}
