//! Keys that are fitted, with their bounds.

use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::least_squares::Range;
use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::sweep::value_of;

/// Ratio of the default bounds to the value of the deck.
const SPAN: f64 = 10.0;

/// A key as on the command line: `KEY`, or `KEY=LOW:HIGH` with values as in decks.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    key: String,
    bounds: Option<[String; 2]>,
}

impl FromStr for Wanted {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let allowed =
            "expected KEY or KEY=LOW:HIGH, such as \"material.youngs_modulus=20 GPa:40 GPa\"";
        let (key, bounds) = match text.split_once('=') {
            None => (text, None),
            Some((key, bounds)) => {
                let (low, high) = bounds.split_once(':').ok_or(allowed)?;
                (key, Some([low, high].map(|bound| bound.trim().to_owned())))
            }
        };
        let is_empty = |text: &String| text.is_empty();
        if key.trim().is_empty() || bounds.iter().flatten().any(is_empty) {
            return Err(allowed.into());
        }
        Ok(Self {
            key: key.trim().to_owned(),
            bounds,
        })
    }
}

/// A key with its value in the deck and its bounds, in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Parameter {
    pub key: String,
    pub start: f64,
    pub low: f64,
    pub high: f64,
}

impl Parameter {
    /// Reads the value of a key and its bounds; by default a tenth of the value and ten times the value.
    ///
    /// # Errors
    /// The key has no number, the deck is invalid at a bound, or the bounds do not contain the value.
    pub fn of(deck: &DeckText, wanted: &Wanted) -> Result<Self, RunError> {
        let Wanted { key, bounds } = wanted;
        let rejected = |reason: String| RunError::NoFit { reason };
        let start = value_of(&deck.read()?, key);
        let start = start.filter(|start| *start != 0.0).ok_or_else(|| {
            rejected(format!(
                "{key} has no number other than zero in the deck; a fitted key must have a value, from which the fit starts"
            ))
        })?;
        let default = match start > 0.0 {
            true => [start / SPAN, start * SPAN],
            false => [start * SPAN, start / SPAN],
        };
        let [low, high] = match bounds {
            None => default,
            Some([low, high]) => {
                let bound = |text: &str| {
                    let mut deck = deck.clone();
                    deck.overrides.push(format!("{key}={text}"));
                    let value = value_of(&deck.read()?, key);
                    value.ok_or_else(|| {
                        rejected(format!("the bound {text} of {key} is not a number"))
                    })
                };
                [bound(low)?, bound(high)?]
            }
        };
        if !(low < high && (low..=high).contains(&start)) {
            return Err(rejected(format!(
                "the bounds {low} to {high} of {key} (SI units) do not contain its value in the deck, {start}"
            )));
        }
        Ok(Self {
            key: key.clone(),
            start,
            low,
            high,
        })
    }

    /// Returns the range of the search; changes are measured in units of the value in the deck.
    pub fn range(&self) -> Range {
        Range {
            start: self.start,
            low: self.low,
            high: self.high,
            scale: self.start.abs(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_have_optional_bounds() {
        let wanted: Wanted = "material.youngs_modulus=20 GPa:40 GPa".parse().unwrap();
        assert_eq!(wanted.key, "material.youngs_modulus");
        assert_eq!(wanted.bounds, Some(["20 GPa".into(), "40 GPa".into()]));
        assert_eq!("a.b".parse::<Wanted>().unwrap().bounds, None);
        for wrong in ["", "=1:2", "a=1", "a=1:", "a=:2"] {
            assert!(wrong.parse::<Wanted>().is_err(), "{wrong}");
        }
    }
}
