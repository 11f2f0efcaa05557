//! The TOML document as an owned tree with the location of every key and value.

use toml::de::{DeTable, DeValue};

use crate::error::DeckError;
use crate::fault::Fault;
use crate::finding::Problem;
use crate::source::{Place, Sources};

/// A value with its location.
#[derive(Debug, Clone)]
pub(crate) struct Node {
    pub(crate) place: Place,
    pub(crate) value: Value,
}

/// The kind and content of a value.
#[derive(Debug, Clone)]
pub(crate) enum Value {
    Text(String),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    Date,
    Array(Vec<Node>),
    Table(Vec<Entry>),
}

/// A key with its value, in the order of the text.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) key_place: Place,
    pub(crate) node: Node,
}

impl Value {
    /// Returns whether it is a table or a list of tables.
    pub(crate) fn is_table(&self) -> bool {
        match self {
            Self::Table(_) => true,
            Self::Array(items) => items.first().is_some_and(|item| item.value.is_table()),
            _ => false,
        }
    }

    /// Returns the type in words.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Text(_) => "a string",
            Self::Integer(_) | Self::Float(_) => "a number",
            Self::Boolean(_) => "true or false",
            Self::Date => "a date",
            Self::Array(_) => "a list",
            Self::Table(_) => "a table",
        }
    }
}

/// Parses a document. Only the first syntax error is reported, because later ones are mostly its consequences.
pub(crate) fn parse(sources: &Sources) -> Result<Node, DeckError> {
    let text = sources.text(0);
    match DeTable::parse(text) {
        Ok(document) => {
            let mut entries = table(document.get_ref(), 0, 0);
            sort(&mut entries);
            Ok(Node {
                place: Place::default(),
                value: Value::Table(entries),
            })
        }
        Err(error) => {
            let span = error.span().unwrap_or(0..0);
            let place = Place {
                source: 0,
                start: span.start,
                end: span.end,
            };
            let fault = Fault::Syntax {
                message: error.message().to_owned(),
            };
            Err(DeckError::rejected(vec![Problem::new(
                fault,
                sources.locate(place),
            )]))
        }
    }
}

/// Parses a single value that starts `offset` bytes into its source; none if the text is not a TOML value.
pub(crate) fn parse_value(text: &str, source: usize, offset: usize) -> Option<Node> {
    let value = DeValue::parse(text).ok()?;
    Some(node(value.get_ref(), value.span(), source, offset))
}

fn table(entries: &DeTable<'_>, source: usize, offset: usize) -> Vec<Entry> {
    entries
        .iter()
        .map(|(key, value)| Entry {
            key: key.get_ref().to_string(),
            key_place: place(key.span(), source, offset),
            node: node(value.get_ref(), value.span(), source, offset),
        })
        .collect()
}

fn node(value: &DeValue<'_>, span: std::ops::Range<usize>, source: usize, offset: usize) -> Node {
    let value = match value {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
            Ok(integer) => Value::Integer(integer),
            // Beyond 64 bits: only the magnitude matters; the reader rejects infinite numbers.
            Err(_) => Value::Float(integer.as_str().parse().unwrap_or(f64::INFINITY)),
        },
        DeValue::Float(float) => Value::Float(float.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Boolean(boolean) => Value::Boolean(*boolean),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Array(items) => Value::Array(
            items
                .iter()
                .map(|item| node(item.get_ref(), item.span(), source, offset))
                .collect(),
        ),
        DeValue::Table(entries) => Value::Table(table(entries, source, offset)),
    };
    Node {
        place: place(span, source, offset),
        value,
    }
}

fn place(span: std::ops::Range<usize>, source: usize, offset: usize) -> Place {
    Place {
        source,
        start: span.start + offset,
        end: span.end + offset,
    }
}

/// Sorts entries into the order of the text; the parser returns them by name.
fn sort(entries: &mut [Entry]) {
    entries.sort_by_key(|entry| entry.key_place.start);
    for entry in entries {
        sort_node(&mut entry.node);
    }
}

fn sort_node(node: &mut Node) {
    match &mut node.value {
        Value::Table(entries) => sort(entries),
        Value::Array(items) => items.iter_mut().for_each(sort_node),
        _ => {}
    }
}
