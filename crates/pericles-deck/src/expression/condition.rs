//! Conditions: comparisons of expressions, combined with `&&`, `||` and `!`.
//!
//! Precedence from low to high: `||`, `&&`, `!`. Comparisons may be chained (`0 < x <= 1`). A comparison with
//! NaN is false.

use std::fmt;
use std::sync::Arc;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Expression, LONGEST, Malformed};

/// Largest nesting depth of parentheses.
const DEEPEST: usize = 60;

/// A compiled condition on the position and block of a point.
#[derive(Clone)]
pub struct Condition {
    text: Arc<str>,
    test: Arc<Test<Expression>>,
}

/// A condition on the values of expressions.
pub(super) enum Test<E> {
    Any(Vec<Self>),
    Every(Vec<Self>),
    Not(Box<Self>),
    Compare(E, Comparison, E),
}

#[derive(Clone, Copy)]
pub(super) enum Comparison {
    Less,
    AtMost,
    Greater,
    AtLeast,
    Equal,
    Unequal,
}

/// Operators, longer ones before their prefixes.
const COMPARISONS: [(&str, Comparison); 6] = [
    ("<=", Comparison::AtMost),
    (">=", Comparison::AtLeast),
    ("==", Comparison::Equal),
    ("!=", Comparison::Unequal),
    ("<", Comparison::Less),
    (">", Comparison::Greater),
];

impl Condition {
    /// What decks may contain.
    pub(crate) const ALLOWED: &str = "such as where = \"x > 0.01 && y < 0.02 || block == 2\", in m";

    /// Parses a condition on the variables named by `allowed`.
    pub(crate) fn parse(text: &str, allowed: &[&str]) -> Result<Self, Malformed> {
        let test = Test::of(text, &|side| Expression::parse(side, allowed))?;
        Ok(Self {
            text: text.into(),
            test: test.into(),
        })
    }

    /// Returns the text of the condition.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns whether it holds for a point of a block at a position (m).
    pub fn holds(&self, place: [f64; 3], block: u32) -> bool {
        let [x, y, z] = place;
        let values = [x, y, z, f64::NAN, f64::from(block), f64::NAN];
        self.test.holds(&|side| side.at(values))
    }
}

/// Parses a side of a comparison.
type Side<'a, E> = &'a dyn Fn(&str) -> Result<E, Malformed>;

impl<E: Clone> Test<E> {
    /// Parses a condition on expressions that `side` parses.
    pub(super) fn of(text: &str, side: Side<'_, E>) -> Result<Self, Malformed> {
        if text.len() > LONGEST {
            return reject(format!(
                "it has {} characters; allowed: at most {LONGEST}",
                text.len()
            ));
        }
        Self::parse(text, side, 0)
    }

    fn parse(text: &str, side: Side<'_, E>, depth: usize) -> Result<Self, Malformed> {
        if depth > DEEPEST {
            return reject(format!("it is nested more than {DEEPEST} deep"));
        }
        let text = text.trim();
        if text.is_empty() {
            return reject("it has an empty part".into());
        }
        for (sign, join) in [("||", Self::Any as fn(_) -> _), ("&&", Self::Every)] {
            let (parts, _) = split(text, &[sign])?;
            if parts.len() > 1 {
                let parts = parts.into_iter();
                let tests: Result<Vec<Self>, _> = parts
                    .map(|part| Self::parse(part, side, depth + 1))
                    .collect();
                return Ok(join(tests?));
            }
        }
        if let Some(rest) = text.strip_prefix('!') {
            return Ok(Self::Not(Self::parse(rest, side, depth + 1)?.into()));
        }
        let signs = COMPARISONS.map(|(sign, _)| sign);
        let (sides, found) = split(text, &signs)?;
        if found.is_empty() {
            return match text
                .strip_prefix('(')
                .and_then(|rest| rest.strip_suffix(')'))
            {
                Some(inner) => Self::parse(inner, side, depth + 1),
                None => reject(format!(
                    "`{text}` is not a comparison; allowed: comparisons (< <= > >= == !=) such as x > 0.1, combined with && (and), || (or), ! (not)"
                )),
            };
        }
        let sides: Result<Vec<E>, _> = sides.into_iter().map(side).collect();
        let sides = sides?;
        let pairs = sides.windows(2).zip(found);
        let mut tests: Vec<Self> = pairs
            .map(|(pair, sign)| {
                Self::Compare(pair[0].clone(), COMPARISONS[sign].1, pair[1].clone())
            })
            .collect();
        Ok(match tests.len() {
            1 => tests.remove(0),
            _ => Self::Every(tests),
        })
    }

    /// Returns whether the condition holds for the values of its expressions.
    pub(super) fn holds(&self, value: &dyn Fn(&E) -> f64) -> bool {
        match self {
            Self::Any(parts) => parts.iter().any(|part| part.holds(value)),
            Self::Every(parts) => parts.iter().all(|part| part.holds(value)),
            Self::Not(part) => !part.holds(value),
            Self::Compare(left, comparison, right) => {
                let (left, right) = (value(left), value(right));
                match comparison {
                    Comparison::Less => left < right,
                    Comparison::AtMost => left <= right,
                    Comparison::Greater => left > right,
                    Comparison::AtLeast => left >= right,
                    Comparison::Equal => left == right,
                    Comparison::Unequal => left != right,
                }
            }
        }
    }

    /// Adds both sides of every comparison, in the order of the text.
    pub(super) fn comparisons<'t>(&'t self, found: &mut Vec<[&'t E; 2]>) {
        match self {
            Self::Any(parts) | Self::Every(parts) => {
                parts.iter().for_each(|part| part.comparisons(found));
            }
            Self::Not(part) => part.comparisons(found),
            Self::Compare(left, _, right) => found.push([left, right]),
        }
    }
}

fn reject<T>(reason: String) -> Result<T, Malformed> {
    Err(Malformed { reason })
}

/// Splits a text at operators outside parentheses; returns the parts and the indices of the operators.
fn split<'t>(text: &'t str, signs: &[&str]) -> Result<(Vec<&'t str>, Vec<usize>), Malformed> {
    let (mut parts, mut found) = (Vec::new(), Vec::new());
    let (mut depth, mut from, mut skip) = (0usize, 0, 0);
    let mut is_quoted = false;
    for (at, character) in text.char_indices() {
        if at < skip {
            continue;
        }
        if character == '\'' {
            is_quoted = !is_quoted;
        }
        if is_quoted {
            continue;
        }
        match character {
            '(' => depth += 1,
            ')' if depth == 0 => {
                return reject("a closing parenthesis has no opening one".into());
            }
            ')' => depth -= 1,
            _ if depth == 0 => {
                let rest = &text[at..];
                if let Some(sign) = signs.iter().position(|sign| rest.starts_with(sign)) {
                    parts.push(&text[from..at]);
                    found.push(sign);
                    from = at + signs[sign].len();
                    skip = from;
                }
            }
            _ => {}
        }
    }
    if depth > 0 {
        return reject("a parenthesis is not closed".into());
    }
    parts.push(&text[from..]);
    Ok((parts, found))
}

/// Serialises as its text.
impl Serialize for Condition {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text)
    }
}

impl<'de> Deserialize<'de> for Condition {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::parse(&text, &["x", "y", "z", "block"])
            .map_err(|malformed| D::Error::custom(format!("`{text}`: {}", malformed.reason)))
    }
}

impl fmt::Debug for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Condition({:?})", self.text)
    }
}

/// Compares the texts.
impl PartialEq for Condition {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ALLOWED: [&str; 4] = ["x", "y", "z", "block"];

    #[test]
    fn conditions_have_the_usual_precedence() {
        // At (2, 3, 5) in block 7.
        let cases = [
            ("x > 1", true),
            ("x >= 2 && y < 3", false),
            ("x >= 2 && y < 3 || z == 5", true),
            ("x >= 2 && (y < 3 || z == 5)", true),
            ("x > 2 || y > 2 && z > 5", false),
            ("!(x > 1) || block == 7", true),
            ("!x > 1", false),
            ("! (block != 7) && 0 < x <= 2", true),
            ("0 < x < 2", false),
            ("(x + 1)^2 > 2 * (y + 1)", true),
            ("((x - 2)^2 + (y - 3)^2) <= 1e-9", true),
            ("(((x) < y))", true),
            ("sqrt(-x) < 1 || sqrt(-x) >= 1", false),
        ];
        for (text, expected) in cases {
            let condition = Condition::parse(text, &ALLOWED).unwrap();
            assert_eq!(condition.holds([2.0, 3.0, 5.0], 7), expected, "{text}");
        }
    }

    #[test]
    fn invalid_conditions_are_rejected() {
        for (text, says) in [
            ("x + 1", "is not a comparison"),
            ("(x > 1", "not closed"),
            ("x > 1)", "no opening one"),
            ("x > 1 &&", "empty"),
            ("x > 1 and y > 1", "an operator is missing before `and`"),
            ("x = 1", "is not a comparison"),
            ("t > 1", "unknown name `t`"),
            ("x > ", "it is empty"),
            ("", "empty"),
        ] {
            let malformed = Condition::parse(text, &ALLOWED).unwrap_err();
            assert!(
                malformed.reason.contains(says),
                "{text}: {}",
                malformed.reason
            );
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]
        #[test]
        fn arbitrary_text_never_panics(text in "[-+*/()<>=!&| .0-9xyzblock]{0,24}") {
            if let Ok(condition) = Condition::parse(&text, &ALLOWED) {
                condition.holds([0.1, 0.2, 0.3], 4);
            }
        }
    }
}
