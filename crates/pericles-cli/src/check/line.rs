//! Lines of the output of `check`. A line carries the numbers of its text that are not among the facts of `run.json`,
//! so that the JSON output of `check` contains every printed number.

use std::fmt::{self, Display, Formatter};

use serde_json::{Map, Value, json};

/// A line: label, text, and values for the JSON.
#[derive(Debug, Clone)]
pub(super) struct Line {
    name: &'static str,
    text: String,
    values: Vec<(&'static str, Entry)>,
}

/// A value in the JSON.
#[derive(Debug, Clone)]
enum Entry {
    /// The value of the key.
    One(Value),
    /// An entry of the list under the key.
    Listed(Value),
}

impl Line {
    /// Creates a line whose numbers are among the facts, or that has none.
    pub(super) fn new(name: &'static str, text: impl Into<String>) -> Self {
        Self {
            name,
            text: text.into(),
            values: Vec::new(),
        }
    }

    /// Adds a value for the JSON, in SI units. Non-finite and missing numbers become null.
    pub(super) fn with(mut self, key: &'static str, value: impl Into<Value>) -> Self {
        self.values.push((key, Entry::One(value.into())));
        self
    }

    /// Adds an entry to a list of the JSON, for lines that occur several times.
    pub(super) fn with_entry(mut self, key: &'static str, value: impl Into<Value>) -> Self {
        self.values.push((key, Entry::Listed(value.into())));
        self
    }
}

impl Display for Line {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(f, "{:<18} {}", self.name, self.text)
    }
}

/// Adds the values of the lines to a JSON object.
pub(super) fn add_values(object: &mut Map<String, Value>, lines: &[Line]) {
    for (key, entry) in lines.iter().flat_map(|line| &line.values) {
        match entry {
            Entry::One(value) => {
                let before = object.insert((*key).to_owned(), value.clone());
                debug_assert!(before.is_none(), "two values of {key}");
            }
            Entry::Listed(value) => {
                let list = object.entry(*key).or_insert_with(|| json!([]));
                if let Value::Array(list) = list {
                    list.push(value.clone());
                }
            }
        }
    }
}
