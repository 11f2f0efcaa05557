//! Typed access to one value.

use serde_json::Value as Json;

use super::{Form, Ledger};
use crate::document::{Entry, Node, Value};
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::range::{ANY, COUNT, POSITIVE, Range};
use crate::source::Place;
use crate::units::{self, UnitError};

/// A value with its path from the root.
#[derive(Clone)]
pub(crate) struct Item<'a> {
    ledger: &'a Ledger,
    path: KeyPath,
    node: &'a Node,
}

impl<'a> Item<'a> {
    pub(super) fn new(ledger: &'a Ledger, path: KeyPath, node: &'a Node) -> Self {
        ledger.note_place(&path, node.place);
        Self { ledger, path, node }
    }

    pub(crate) fn place(&self) -> Place {
        self.node.place
    }

    pub(crate) fn report(&self, fault: Fault) {
        self.ledger.report(self.node.place, fault);
    }

    /// Reports that a value is out of range.
    pub(crate) fn out_of_range(&self, allowed: &str) {
        self.ledger
            .report_value(self.place(), |value| Fault::OutOfRange {
                value,
                allowed: format!("allowed: {allowed}"),
            });
    }

    fn wrong_kind(&self, expected: impl Into<String>) {
        let expected = expected.into();
        self.ledger
            .report_value(self.place(), |value| Fault::WrongKind {
                value,
                found: self.node.value.kind(),
                expected,
            });
    }

    pub(crate) fn record(&self, value: impl Into<Json>) {
        self.ledger.record(&self.path, value.into());
    }

    fn note(&self, form: impl FnOnce() -> Form) {
        self.ledger.note(|survey| survey.form(&self.path, form()));
    }

    /// Notes in the survey that the form of this value is the shared definition `name`, with its description.
    pub(crate) fn define(&self, name: &'static str, about: &'static str) {
        self.ledger.note(|survey| {
            survey.define(&self.path, name);
            survey.about(&self.path, about);
        });
    }

    /// Returns the string, if it is one; for values that may be a word or something else.
    pub(crate) fn word(&self) -> Option<&'a str> {
        match &self.node.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// Returns whether it is a list.
    pub(crate) fn is_list(&self) -> bool {
        matches!(self.node.value, Value::Array(_))
    }

    /// Returns the number of entries, if it is a list.
    pub(crate) fn list_length(&self) -> Option<usize> {
        match &self.node.value {
            Value::Array(items) => Some(items.len()),
            _ => None,
        }
    }

    /// Reports a list of the wrong length.
    pub(crate) fn wrong_length(&self, allowed: &str) {
        let found = self.list_length().unwrap_or_default();
        self.ledger
            .report_value(self.place(), |value| Fault::WrongLength {
                value,
                found,
                allowed: format!("allowed: {allowed}"),
            });
    }

    pub(crate) fn is_table(&self) -> bool {
        matches!(self.node.value, Value::Table(_))
    }

    /// Returns whether it is this keyword.
    pub(crate) fn is_keyword(&self, word: &'static str) -> bool {
        self.note(|| Form::Words(vec![word.into()]));
        let is = self.word() == Some(word);
        if is {
            self.record(word);
        }
        is
    }

    /// Reads a string.
    pub(crate) fn text(&self) -> Option<String> {
        self.note(|| Form::Text);
        let Some(text) = self.word() else {
            self.wrong_kind("a string in quotes");
            return None;
        };
        self.record(text);
        Some(text.to_owned())
    }

    pub(crate) fn boolean(&self) -> Option<bool> {
        self.note(|| Form::Boolean);
        let Value::Boolean(boolean) = self.node.value else {
            self.wrong_kind("true or false, without quotes");
            return None;
        };
        self.record(boolean);
        Some(boolean)
    }

    /// Reads a whole number of at least one.
    pub(crate) fn count(&self) -> Option<u64> {
        self.count_within(COUNT)
    }

    /// Reads a whole number in a range.
    pub(crate) fn count_within(&self, range: Range) -> Option<u64> {
        self.note(|| Form::Count { range });
        let whole = match self.node.value {
            Value::Integer(integer) => u64::try_from(integer).ok(),
            // Allows 1e6 for a million; a double is not exact beyond 2^53.
            Value::Float(float) if float.fract() == 0.0 && (0.0..9e15).contains(&float) => {
                Some(float as u64)
            }
            Value::Float(_) => None,
            _ => {
                self.wrong_kind(range.words());
                return None;
            }
        };
        match whole {
            Some(count) if range.contains(count as f64) => {
                self.record(count);
                Some(count)
            }
            _ => {
                self.out_of_range(&range.words());
                None
            }
        }
    }

    /// Returns whether it may be a number instead of the word `word`; none after reporting another word.
    pub(crate) fn is_number_or(&self, word: &'static str, quantity: Quantity) -> Option<bool> {
        if self.is_keyword(word) {
            return Some(false);
        }
        let is_text = |text: &str| !text.contains(|c: char| c.is_ascii_digit());
        if !self.word().is_some_and(is_text) {
            return Some(true);
        }
        self.ledger
            .report_value(self.place(), |value| Fault::NotANumber {
                value,
                expected: format!("{}, or \"{word}\"", quantity.expected()),
            });
        None
    }

    /// Reads a finite number in SI units.
    pub(crate) fn quantity(&self, quantity: Quantity) -> Option<f64> {
        self.note(|| Form::Number {
            quantity,
            allowed: None,
        });
        let value = self.measure(quantity)?;
        self.record(value);
        Some(value)
    }

    fn measure(&self, quantity: Quantity) -> Option<f64> {
        let expected = || quantity.expected();
        let report = |fault: &dyn Fn(String) -> Fault| {
            self.ledger.report_value(self.place(), fault);
            None
        };
        let not_a_number = || {
            report(&|value| Fault::NotANumber {
                value,
                expected: expected(),
            })
        };
        match &self.node.value {
            Value::Integer(integer) => Some(*integer as f64),
            Value::Float(float) if float.is_finite() => Some(*float),
            Value::Float(_) => not_a_number(),
            Value::Text(text) => match units::parse(text) {
                Ok(measure) => match measure.dimension {
                    Some(dimension) if dimension != quantity.dimension() => {
                        report(&|value| Fault::WrongUnit {
                            value,
                            expected: quantity.name().into(),
                            allowed: expected(),
                        })
                    }
                    _ => Some(measure.value),
                },
                Err(UnitError::Unknown { symbol, nearest }) => {
                    report(&|value| Fault::UnknownUnit {
                        value,
                        unit: symbol.clone(),
                        nearest: nearest.clone(),
                        expected: expected(),
                    })
                }
                Err(UnitError::Malformed { unit }) => report(&|value| Fault::UnknownUnit {
                    value,
                    unit: unit.clone(),
                    nearest: None,
                    expected: expected(),
                }),
                Err(UnitError::Comma) => report(&|value| Fault::Comma { value }),
                Err(UnitError::NoNumber | UnitError::TooLarge) => not_a_number(),
            },
            _ => {
                self.wrong_kind(expected());
                None
            }
        }
    }

    /// Reads a positive number.
    pub(crate) fn positive(&self, quantity: Quantity) -> Option<f64> {
        self.number(quantity, POSITIVE)
    }

    /// Reads a number in a range.
    pub(crate) fn number(&self, quantity: Quantity, range: Range) -> Option<f64> {
        match range.is_any() {
            true => self.quantity(quantity),
            false => self.within(quantity, &range.words(), |value| range.contains(value)),
        }
    }

    /// Reads a number that satisfies a condition, which `allowed` describes.
    pub(crate) fn within(
        &self,
        quantity: Quantity,
        allowed: &str,
        accepts: impl FnOnce(f64) -> bool,
    ) -> Option<f64> {
        self.note(|| Form::Number {
            quantity,
            allowed: Some(allowed.to_owned()),
        });
        let value = self.measure(quantity)?;
        self.record(value);
        if accepts(value) {
            Some(value)
        } else {
            self.out_of_range(allowed);
            None
        }
    }

    /// Reads one of a list of words.
    pub(crate) fn choice<T: Copy>(
        &self,
        what: &'static str,
        words: &[(impl AsRef<str>, T)],
    ) -> Option<T> {
        let allowed = || words.iter().map(|(word, _)| word.as_ref());
        self.note(|| Form::Words(allowed().map(String::from).collect()));
        let Some(text) = self.word() else {
            let words: Vec<String> = allowed().map(|word| format!("\"{word}\"")).collect();
            self.wrong_kind(format!("one of {}", words.join(", ")));
            return None;
        };
        if let Some((_, value)) = words.iter().find(|(word, _)| word.as_ref() == text) {
            self.record(text);
            return Some(*value);
        }
        self.unknown_word(what, text, allowed());
        None
    }

    /// Reports an unknown word.
    pub(crate) fn unknown_word<'w>(
        &self,
        what: &'static str,
        text: &str,
        allowed: impl Iterator<Item = &'w str> + Clone,
    ) {
        self.report(Fault::unknown_word(what, text, allowed));
    }

    /// Returns the entries of a list.
    pub(crate) fn list(&self, expected: &str) -> Option<Vec<Item<'a>>> {
        self.note(|| Form::List { length: None });
        self.entries(expected)
    }

    fn entries(&self, expected: &str) -> Option<Vec<Item<'a>>> {
        let Value::Array(nodes) = &self.node.value else {
            self.wrong_kind(expected);
            return None;
        };
        self.record(Json::Array(Vec::new()));
        Some(
            nodes
                .iter()
                .enumerate()
                .map(|(k, node)| Item::new(self.ledger, self.path.index(k), node))
                .collect(),
        )
    }

    /// Returns the components of a vector: one per dimension, or one to three if another error makes the
    /// dimension unknown. In 1D the brackets may be omitted.
    pub(crate) fn components(
        &self,
        dimension: Option<usize>,
        expected: &str,
    ) -> Option<Vec<Item<'a>>> {
        let bare = dimension == Some(1) && !self.is_list();
        self.ledger.note(|survey| survey.vector(&self.path, bare));
        if bare {
            return Some(vec![self.clone()]);
        }
        let items = self.entries(&format!(
            "a list with one entry per dimension, each {expected}"
        ))?;
        let right = match dimension {
            Some(dimension) => items.len() == dimension,
            None => (1..=3).contains(&items.len()),
        };
        if right {
            return Some(items);
        }
        let allowed = match dimension {
            Some(1) => "allowed: one entry, the body is 1D".into(),
            Some(dimension) => {
                format!("allowed: {dimension} entries, one per dimension of the body")
            }
            None => "allowed: one entry per dimension of the body".into(),
        };
        self.ledger
            .report_value(self.place(), |value| Fault::WrongLength {
                value,
                found: items.len(),
                allowed,
            });
        None
    }

    /// Returns the entries of a list of given length.
    pub(crate) fn exactly(&self, length: usize, expected: &str) -> Option<Vec<Item<'a>>> {
        self.note(|| Form::List {
            length: Some(length),
        });
        let items = self.entries(expected)?;
        if items.len() == length {
            return Some(items);
        }
        self.ledger
            .report_value(self.place(), |value| Fault::WrongLength {
                value,
                found: items.len(),
                allowed: format!("allowed: {expected}"),
            });
        None
    }

    /// Reads a vector of quantities; missing components are zero.
    pub(crate) fn vector(&self, quantity: Quantity, dimension: Option<usize>) -> Option<[f64; 3]> {
        self.vector_within(quantity, ANY, dimension)
    }

    /// Reads a vector whose components are in a range; missing components are zero.
    pub(crate) fn vector_within(
        &self,
        quantity: Quantity,
        range: Range,
        dimension: Option<usize>,
    ) -> Option<[f64; 3]> {
        let items = self.components(dimension, &quantity.expected())?;
        let mut vector = Some([0.0; 3]);
        for (c, item) in items.iter().enumerate() {
            // Continue after an invalid entry to report all of them.
            match (item.number(quantity, range), &mut vector) {
                (Some(value), Some(vector)) => vector[c] = value,
                _ => vector = None,
            }
        }
        vector
    }

    /// Returns the entries of a table.
    pub(super) fn table_entries(&self) -> Option<&'a [Entry]> {
        self.note(|| Form::Table);
        let Value::Table(entries) = &self.node.value else {
            self.wrong_kind("a table");
            return None;
        };
        Some(entries)
    }

    pub(super) fn ledger(&self) -> &'a Ledger {
        self.ledger
    }

    pub(super) fn path(&self) -> &KeyPath {
        &self.path
    }

    /// Unwraps a result of the library and reports an error.
    pub(crate) fn accept<T>(&self, result: pericles::Result<T>) -> Option<T> {
        result.map_err(|error| self.report(error.into())).ok()
    }
}
