//! Axes of a sweep: a key of the deck and its values.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Maximum number of values of a key.
const MOST: usize = 10_000;

/// A key of the deck with its values: `key=a,b,c`, or `key=start:stop:step` including the stop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// The key, such as `material.horizon_ratio`.
    pub key: String,
    /// The values as written in decks.
    pub values: Vec<String>,
}

impl Axis {
    /// Returns the key without its tables.
    pub fn name(&self) -> &str {
        self.key.rsplit('.').next().unwrap_or_default()
    }
}

impl FromStr for Axis {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let allowed = "expected key=a,b,c or key=start:stop:step, such as material.horizon_ratio=3,4,6 or \"body.spacing=0.5 mm:2 mm:0.5 mm\"";
        let (key, values) = text
            .split_once('=')
            .ok_or_else(|| format!("missing `=`; {allowed}"))?;
        let values = match range(values) {
            Some(values) => values?,
            None => list(values),
        };
        if key.trim().is_empty() || values.iter().any(String::is_empty) {
            return Err(format!("empty key or value; {allowed}"));
        }
        if let Some((k, twice)) =
            (values.iter().enumerate()).find(|(k, v)| values[..*k].contains(v))
        {
            return Err(format!("value {} repeats {twice}", k + 1));
        }
        Ok(Self {
            key: key.trim().to_owned(),
            values,
        })
    }
}

/// Splits at commas outside brackets and quotation marks.
fn list(text: &str) -> Vec<String> {
    let mut values = vec![String::new()];
    let (mut depth, mut quoted) = (0_i32, false);
    for character in text.chars() {
        match character {
            '"' => quoted = !quoted,
            '[' | '{' if !quoted => depth += 1,
            ']' | '}' if !quoted => depth -= 1,
            ',' if !quoted && depth == 0 => {
                values.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(value) = values.last_mut() {
            value.push(character);
        }
    }
    values.iter().map(|value| value.trim().to_owned()).collect()
}

/// Returns the values of `start:stop:step`, or `None` if the text is not a range.
fn range(text: &str) -> Option<Result<Vec<String>, String>> {
    let parts: Vec<_> = text.split(':').map(measure).collect::<Option<_>>()?;
    let [(start, unit), (stop, stop_unit), (step, step_unit)] = parts[..] else {
        return None;
    };
    if [stop_unit, step_unit].map(str::trim) != [unit.trim(); 2] {
        return Some(Err("start, stop and step must have the same unit".into()));
    }
    // A stop within rounding is included.
    let count = ((stop - start) / step + 1e-9).floor();
    if !(0.0..MOST as f64).contains(&count) {
        return Some(Err(format!(
            "the range from {start} to {stop} has a step of the wrong sign or zero, or more than {MOST} values"
        )));
    }
    let value = |k: usize| {
        // Twelve digits: 0.3, not 0.30000000000000004.
        let number: f64 = format!("{:.11e}", start + k as f64 * step)
            .parse()
            .unwrap_or(f64::NAN);
        format!("{number}{unit}")
    };
    Some(Ok((0..=count as usize).map(value).collect()))
}

/// Splits a number and its unit.
fn measure(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let ends = (0..=text.len())
        .rev()
        .filter(|&end| text.is_char_boundary(end));
    let (number, unit) = ends
        .map(|end| text.split_at(end))
        .find_map(|(number, unit)| Some((number.parse::<f64>().ok()?, unit)))?;
    let follows = unit.trim_start();
    let unit_only = !follows.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    (number.is_finite() && unit_only).then_some((number, unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(text: &str) -> Vec<String> {
        text.parse::<Axis>().unwrap().values
    }

    #[test]
    fn lists_are_split_outside_brackets_and_quotes() {
        assert_eq!(values("a.b=3,4, 6"), ["3", "4", "6"]);
        assert_eq!(values("a=[1,2],[3,4]"), ["[1,2]", "[3,4]"]);
        assert_eq!(values("a=\"x,y\",z"), ["\"x,y\"", "z"]);
        assert_eq!(values("time.end=20 us"), ["20 us"]);
    }

    #[test]
    fn ranges_include_their_stop() {
        assert_eq!(values("a=0.1:0.5:0.1"), ["0.1", "0.2", "0.3", "0.4", "0.5"]);
        assert_eq!(values("a=4:0:-2"), ["4", "2", "0"]);
        assert_eq!(
            values("a=0.5 mm:2 mm:0.5 mm"),
            ["0.5 mm", "1 mm", "1.5 mm", "2 mm"]
        );
        assert_eq!(values("a=1:2:0.7"), ["1", "1.7"]);
        // Not a range, but a list of one value.
        assert_eq!(values("a=x:y:z"), ["x:y:z"]);
    }

    #[test]
    fn invalid_axes_are_rejected() {
        for wrong in [
            "a",
            "=1",
            "a=",
            "a=1,,2",
            "a=1,1",
            "a=0:1:0",
            "a=0:1:-1",
            "a=0:1:1e-9",
            "a=0 mm:1:1",
        ] {
            assert!(wrong.parse::<Axis>().is_err(), "{wrong}");
        }
    }
}
