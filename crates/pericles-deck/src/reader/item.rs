//! One value being read.

use serde_json::Value as Json;

use super::{Form, Ledger};
use crate::document::{Entry, Node, Value};
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::source::Place;
use crate::units::{self, UnitError};

/// A range in words.
pub(crate) const POSITIVE: &str = "a positive number";

/// A value with its way from the root.
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

    /// Reports that a number is out of its range.
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

    /// Says that its form is that of other values of this name as well.
    pub(crate) fn define(&self, name: &'static str) {
        self.ledger.note(|survey| survey.define(&self.path, name));
    }

    /// The string, if it is one; for values that may be a word or something else.
    pub(crate) fn word(&self) -> Option<&'a str> {
        match &self.node.value {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The list, if it is one.
    pub(crate) fn is_list(&self) -> bool {
        matches!(self.node.value, Value::Array(_))
    }

    /// The number of entries, if it is a list.
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

    /// Whether it is this word, which is a value of its own.
    pub(crate) fn is_keyword(&self, word: &'static str) -> bool {
        self.note(|| Form::Words(vec![word.into()]));
        let is = self.word() == Some(word);
        if is {
            self.record(word);
        }
        is
    }

    /// A string.
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

    /// A whole number of at least one.
    pub(crate) fn count(&self) -> Option<u64> {
        self.note(|| Form::Count);
        let expected = "a whole number of at least 1";
        let whole = match self.node.value {
            Value::Integer(integer) => u64::try_from(integer).ok(),
            // 1e6 is how people write a million; beyond 2^53 a double holds no exact count.
            Value::Float(float) if float.fract() == 0.0 && (1.0..9e15).contains(&float) => {
                Some(float as u64)
            }
            Value::Float(_) => None,
            _ => {
                self.wrong_kind(expected);
                return None;
            }
        };
        match whole {
            Some(count) if count > 0 => {
                self.record(count);
                Some(count)
            }
            _ => {
                self.out_of_range(expected);
                None
            }
        }
    }

    /// A finite number in SI units.
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

    /// A positive number.
    pub(crate) fn positive(&self, quantity: Quantity) -> Option<f64> {
        self.within(quantity, POSITIVE, |value| value > 0.0)
    }

    /// A number that satisfies a condition, given in words too.
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

    /// One of a list of words.
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

    /// Reports a word that is not among those allowed.
    pub(crate) fn unknown_word<'w>(
        &self,
        what: &'static str,
        text: &str,
        allowed: impl Iterator<Item = &'w str> + Clone,
    ) {
        self.report(Fault::unknown_word(what, text, allowed));
    }

    /// The entries of a list.
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

    /// The entries of a vector with one entry per dimension; any of one to three entries if the dimension is not known for an
    /// error made elsewhere. In one dimension the number may stand without brackets.
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
            Some(1) => "allowed: one entry, for the body has one dimension".into(),
            Some(dimension) => {
                format!("allowed: {dimension} entries, one for each dimension of the body")
            }
            None => "allowed: one entry for each dimension of the body".into(),
        };
        self.ledger
            .report_value(self.place(), |value| Fault::WrongLength {
                value,
                found: items.len(),
                allowed,
            });
        None
    }

    /// The entries of a list of known length.
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

    /// A vector of quantities, missing components zero.
    pub(crate) fn vector(&self, quantity: Quantity, dimension: Option<usize>) -> Option<[f64; 3]> {
        let items = self.components(dimension, &quantity.expected())?;
        let mut vector = Some([0.0; 3]);
        for (c, item) in items.iter().enumerate() {
            // Go on after a bad entry: the others may be bad as well.
            match (item.quantity(quantity), &mut vector) {
                (Some(value), Some(vector)) => vector[c] = value,
                _ => vector = None,
            }
        }
        vector
    }

    /// The entries of a table.
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

    /// Passes on what the library accepts and reports what it refuses.
    pub(crate) fn accept<T>(&self, result: pericles::Result<T>) -> Option<T> {
        result.map_err(|error| self.report(error.into())).ok()
    }
}
