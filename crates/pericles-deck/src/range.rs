//! Ranges of numbers: one declaration for reader, schema and the check of models made by programs.

use std::borrow::Cow;

/// A range of numbers with its description.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Range {
    low: Bound,
    high: Bound,
    /// Whether only whole numbers are in it.
    is_whole: bool,
    /// Whether zero is not in it.
    is_nonzero: bool,
    /// The description, if it does not follow from the bounds.
    words: Option<&'static str>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Bound {
    None,
    /// The value is in the range.
    At(f64),
    /// The value is not in the range.
    Beyond(f64),
}

use Bound::{At, Beyond, None as Unbounded};

/// All finite numbers.
pub(crate) const ANY: Range = of(Unbounded, Unbounded);

/// Numbers above zero.
pub(crate) const POSITIVE: Range = of(Beyond(0.0), Unbounded).described(POSITIVE_WORDS);

/// The description of [`POSITIVE`].
pub(crate) const POSITIVE_WORDS: &str = "a positive number";

/// Zero and numbers above it.
pub(crate) const NOT_NEGATIVE: Range = at_least(0.0).described("zero or a positive number");

/// Numbers from 0 to 1.
pub(crate) const FRACTION: Range = from_to(0.0, 1.0);

/// Returns the numbers of at least `low`.
pub(crate) const fn at_least(low: f64) -> Range {
    of(At(low), Unbounded)
}

/// Returns the numbers from `low` to `high`, both included.
pub(crate) const fn from_to(low: f64, high: f64) -> Range {
    of(At(low), At(high))
}

/// Returns the numbers above `low` and below `high`.
pub(crate) const fn between(low: f64, high: f64) -> Range {
    of(Beyond(low), Beyond(high))
}

/// Returns the numbers above `low` and at most `high`.
pub(crate) const fn above_to(low: f64, high: f64) -> Range {
    of(Beyond(low), At(high))
}

/// Returns the numbers of at least `low` and below `high`.
pub(crate) const fn from_below(low: f64, high: f64) -> Range {
    of(At(low), Beyond(high))
}

/// Whole numbers of at least one.
pub(crate) const COUNT: Range = at_least(1.0).whole();

/// Returns the whole numbers from 1 to `most`.
pub(crate) const fn count_to(most: u32) -> Range {
    from_to(1.0, most as f64).whole()
}

/// Returns the whole numbers from 0 to `most`.
pub(crate) const fn whole_to(most: u32) -> Range {
    from_to(0.0, most as f64).whole()
}

/// All finite numbers but zero.
pub(crate) const NONZERO: Range = Range {
    is_nonzero: true,
    words: Some("any number but 0"),
    ..ANY
};

const fn of(low: Bound, high: Bound) -> Range {
    Range {
        low,
        high,
        is_whole: false,
        is_nonzero: false,
        words: None,
    }
}

impl Range {
    /// Returns the same range with another description.
    pub(crate) const fn described(self, words: &'static str) -> Self {
        Self {
            words: Some(words),
            ..self
        }
    }

    /// Returns the whole numbers of the range.
    pub(crate) const fn whole(self) -> Self {
        Self {
            is_whole: true,
            ..self
        }
    }

    /// Returns whether a number is finite and in the range.
    pub(crate) fn contains(&self, value: f64) -> bool {
        let above = match self.low {
            Unbounded => true,
            At(low) => value >= low,
            Beyond(low) => value > low,
        };
        let below = match self.high {
            Unbounded => true,
            At(high) => value <= high,
            Beyond(high) => value < high,
        };
        value.is_finite()
            && above
            && below
            && (!self.is_whole || value.fract() == 0.0)
            && !(self.is_nonzero && value == 0.0)
    }

    /// Returns the lower bound.
    pub(crate) fn least(&self) -> f64 {
        match self.low {
            Unbounded => f64::NEG_INFINITY,
            At(low) | Beyond(low) => low,
        }
    }

    /// Returns whether the range contains all finite numbers.
    pub(crate) fn is_any(&self) -> bool {
        *self == ANY
    }

    /// Returns the description: "a number from 0 to 1".
    pub(crate) fn words(&self) -> Cow<'static, str> {
        if let Some(words) = self.words {
            return words.into();
        }
        let (low, high) = (self.low, self.high);
        if self.is_whole {
            let any = Self {
                is_whole: false,
                ..*self
            };
            let words = any.words().replace("a number ", "");
            let of = if words.starts_with("at least") {
                "of "
            } else {
                ""
            };
            return format!("a whole number {of}{words}").into();
        }
        match (low, high) {
            (Unbounded, Unbounded) => "a finite number".into(),
            (At(low), Unbounded) => format!("at least {low}").into(),
            (At(low), At(high)) => {
                format!("a number from {} to {}", plain(low), plain(high)).into()
            }
            _ => {
                let low = match low {
                    Unbounded => Option::None,
                    At(low) => Some(format!("of at least {}", plain(low))),
                    Beyond(low) => Some(format!("above {}", plain(low))),
                };
                let high = match high {
                    Unbounded => Option::None,
                    At(high) => Some(format!("at most {}", plain(high))),
                    Beyond(high) => Some(format!("below {}", plain(high))),
                };
                let bounds: Vec<String> = low.into_iter().chain(high).collect();
                format!("a number {}", bounds.join(" and ")).into()
            }
        }
    }
}

/// Formats a bound: 0.5, 1e-12.
fn plain(bound: f64) -> String {
    match bound != 0.0 && bound.abs() < 1e-3 {
        true => format!("{bound:e}"),
        false => bound.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_contain_the_numbers_that_their_descriptions_name() {
        for (range, words, inside, outside) in [
            (ANY, "a finite number", -1e300, f64::INFINITY),
            (POSITIVE, "a positive number", 1e-300, 0.0),
            (at_least(0.0), "at least 0", 0.0, -1e-300),
            (FRACTION, "a number from 0 to 1", 1.0, 1.0 + 1e-12),
            (
                between(1e-12, 1.0),
                "a number above 1e-12 and below 1",
                0.5,
                1.0,
            ),
            (COUNT, "a whole number of at least 1", 7.0, 0.0),
            (count_to(8), "a whole number from 1 to 8", 8.0, 7.5),
            (
                above_to(0.0, 0.9),
                "a number above 0 and at most 0.9",
                0.9,
                0.0,
            ),
        ] {
            assert_eq!(range.words(), words);
            assert!(
                range.contains(inside) && !range.contains(outside),
                "{words}"
            );
            assert!(!range.contains(f64::NAN), "{words}");
        }
    }
}
