//! The lines that `check` prints. Each carries the numbers in its text that are not among the facts of `run.json`, so that the JSON of `check` holds
//! every number that is printed.

use std::fmt::{self, Display, Formatter};

use serde_json::{Map, Value, json};

/// A line: its name, its text, and what the JSON says of it.
#[derive(Debug, Clone)]
pub(super) struct Line {
    name: &'static str,
    text: String,
    values: Vec<(&'static str, Entry)>,
}

/// How a value goes into the JSON.
#[derive(Debug, Clone)]
enum Entry {
    /// The value of the key.
    One(Value),
    /// An entry of the list of that key.
    Listed(Value),
}

impl Line {
    /// A line whose numbers are among the facts, or that has none.
    pub(super) fn new(name: &'static str, text: impl Into<String>) -> Self {
        Self {
            name,
            text: text.into(),
            values: Vec::new(),
        }
    }

    /// The same with a value for the JSON, in SI units. A number that is not finite and a missing one are null.
    pub(super) fn with(mut self, key: &'static str, value: impl Into<Value>) -> Self {
        self.values.push((key, Entry::One(value.into())));
        self
    }

    /// The same with an entry in a list of the JSON, for lines of which there may be several.
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
