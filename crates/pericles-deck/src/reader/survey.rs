//! Survey of the reader: the keys of every table and the forms of their values, recorded while valid decks are read.
//!
//! The reader alone defines the keys; the schema follows from a survey of its calls. Places are named as in
//! `body.hole[].ball.radius`; below a definition shared by several places, they begin with its name:
//! `region.ball.radius`.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::Value as Json;

use crate::key_path::{KeyPath, Step};
use crate::quantity::Quantity;
use crate::range::Range;

/// A form of a value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Form {
    Text,
    Boolean,
    /// A whole number.
    Count {
        range: Range,
    },
    Number {
        quantity: Quantity,
        /// The range in words.
        allowed: Option<String>,
    },
    /// One of these words.
    Words(Vec<String>),
    /// A list, with its entries under `[]`.
    List {
        /// The length, if it is fixed.
        length: Option<usize>,
    },
    /// One entry per dimension of the body, under `[]`; brackets may be omitted in 1D.
    Vector,
    Table,
    /// A table whose keys are names, with values of this definition.
    Names(&'static str),
    /// A value of this definition.
    Defined(&'static str),
}

impl Form {
    /// Merges another form of the same kind; returns whether it is of the same kind.
    fn takes_in(&mut self, other: &Self) -> bool {
        match (&mut *self, other) {
            (Self::Words(words), Self::Words(others)) => {
                for word in others {
                    if !words.contains(word) {
                        words.push(word.clone());
                    }
                }
                true
            }
            (
                Self::List { length },
                Self::List {
                    length: other_length,
                },
            ) => {
                *length = length.filter(|length| *other_length == Some(*length));
                true
            }
            _ => self == other,
        }
    }
}

/// Survey of a value.
#[derive(Debug, Default)]
pub(crate) struct ValueSurvey {
    pub(crate) forms: Vec<Form>,
    /// Defaults; several if they depend on other keys.
    pub(crate) defaults: Vec<Json>,
}

/// Survey of a table.
#[derive(Debug, Default)]
pub(crate) struct TableSurvey {
    /// Number of complete readings.
    visits: usize,
    /// Keys in the order of their first request, with the number of readings that required them.
    keys: Vec<(&'static str, usize)>,
    /// Mutually exclusive keys, with the number of readings that required one.
    choices: Vec<(&'static [&'static str], usize)>,
    /// Exclusive keys that some decks may give together.
    together: Vec<&'static [&'static str]>,
}

impl TableSurvey {
    /// Returns the keys.
    pub(crate) fn keys(&self) -> impl Iterator<Item = &'static str> {
        self.keys.iter().map(|(key, _)| *key)
    }

    /// Returns whether a key is always required.
    pub(crate) fn needs(&self, key: &str) -> bool {
        self.keys
            .iter()
            .any(|(name, needed)| *name == key && *needed == self.visits)
    }

    /// Returns mutually exclusive keys and whether one of them is always required, as a choice or by its own name.
    pub(crate) fn choices(&self) -> impl Iterator<Item = (&'static [&'static str], bool)> {
        let exclusive =
            |(keys, _): &&(&'static [&'static str], usize)| !self.together.contains(keys);
        self.choices.iter().filter(exclusive).map(|(keys, chosen)| {
            let named = self.keys.iter().filter(|(key, _)| keys.contains(key));
            let needed = chosen + named.map(|(_, needed)| needed).sum::<usize>();
            (*keys, needed == self.visits)
        })
    }
}

/// The survey of all decks read so far.
#[derive(Debug, Default)]
pub(crate) struct Survey {
    values: BTreeMap<String, ValueSurvey>,
    tables: BTreeMap<String, TableSurvey>,
    /// Descriptions of declared tables (no key) and keys; several of a key with several meanings.
    descriptions: BTreeMap<(String, Option<String>), Vec<&'static str>>,
    /// Places of the current deck with their definitions.
    definitions: BTreeMap<KeyPath, &'static str>,
    /// Places of the current deck with a vector component without brackets.
    bare: BTreeSet<KeyPath>,
}

impl Survey {
    /// Starts another deck.
    pub(crate) fn begin(&mut self) {
        self.definitions.clear();
        self.bare.clear();
    }

    pub(crate) fn value(&self, place: &str) -> Option<&ValueSurvey> {
        self.values.get(place)
    }

    pub(crate) fn table(&self, place: &str) -> Option<&TableSurvey> {
        self.tables.get(place)
    }

    /// Returns all values.
    pub(crate) fn values(&self) -> impl Iterator<Item = &ValueSurvey> {
        self.values.values()
    }

    /// Returns all values with their places.
    #[cfg(test)]
    pub(crate) fn places(&self) -> impl Iterator<Item = (&str, &ValueSurvey)> {
        self.values
            .iter()
            .map(|(place, value)| (place.as_str(), value))
    }

    /// Returns all tables with their places.
    pub(crate) fn tables(&self) -> impl Iterator<Item = (&str, &TableSurvey)> {
        self.tables
            .iter()
            .map(|(place, table)| (place.as_str(), table))
    }

    /// Returns the descriptions of declared tables (no key) and keys.
    pub(crate) fn descriptions(&self) -> impl Iterator<Item = (&str, Option<&str>, String)> {
        let all = self.descriptions.iter();
        all.map(|((table, key), texts)| (table.as_str(), key.as_deref(), texts.join(" ")))
    }

    /// Returns the names of all definitions.
    pub(crate) fn definitions(&self) -> Vec<&'static str> {
        let forms = self.values.values().flat_map(|value| &value.forms);
        let mut names: Vec<&'static str> = forms
            .filter_map(|form| match form {
                Form::Defined(name) | Form::Names(name) => Some(*name),
                _ => None,
            })
            .collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// Notes that the value at a place has a shared definition.
    pub(super) fn define(&mut self, path: &KeyPath, name: &'static str) {
        self.form(path, Form::Defined(name));
        self.definitions.insert(path.clone(), name);
    }

    /// The same as [`Self::define`], for the entries of a table of names.
    pub(super) fn define_named(&mut self, table: &KeyPath, entry: &KeyPath, name: &'static str) {
        self.form(table, Form::Names(name));
        self.definitions.insert(entry.clone(), name);
    }

    /// Notes a vector; `bare`: a component without brackets.
    pub(super) fn vector(&mut self, path: &KeyPath, bare: bool) {
        self.form(path, Form::Vector);
        if bare {
            self.bare.insert(path.clone());
        }
    }

    pub(super) fn form(&mut self, path: &KeyPath, form: Form) {
        let forms = &mut self.value_at(path).forms;
        if !forms.iter_mut().any(|known| known.takes_in(&form)) {
            forms.push(form);
        }
    }

    pub(super) fn default(&mut self, path: &KeyPath, default: Json) {
        let defaults = &mut self.value_at(path).defaults;
        if !defaults.contains(&default) {
            defaults.push(default);
        }
    }

    pub(super) fn key(&mut self, table: &KeyPath, key: &'static str) {
        let keys = &mut self.table_at(table).keys;
        if !keys.iter().any(|(name, _)| *name == key) {
            keys.push((key, 0));
        }
    }

    /// Notes the description of a declared table.
    pub(super) fn about(&mut self, table: &KeyPath, text: &'static str) {
        let place = self.place(table);
        let texts = self.descriptions.entry((place, None)).or_default();
        if !texts.contains(&text) {
            texts.push(text);
        }
    }

    /// Notes the description of a declared key.
    pub(super) fn describe(&mut self, table: &KeyPath, key: &str, text: &'static str) {
        let described = (self.place(table), Some(key.to_owned()));
        let texts = self.descriptions.entry(described).or_default();
        if !texts.contains(&text) {
            texts.push(text);
        }
    }

    pub(super) fn needed(&mut self, table: &KeyPath, key: &'static str) {
        let keys = &mut self.table_at(table).keys;
        if let Some((_, needed)) = keys.iter_mut().find(|(name, _)| *name == key) {
            *needed += 1;
        }
    }

    pub(super) fn choice(&mut self, table: &KeyPath, keys: &'static [&'static str], needed: bool) {
        for key in keys {
            self.key(table, key);
        }
        let choices = &mut self.table_at(table).choices;
        let needed = usize::from(needed);
        match choices.iter_mut().find(|(known, _)| *known == keys) {
            Some((_, count)) => *count += needed,
            None => choices.push((keys, needed)),
        }
    }

    /// Notes that usually exclusive keys may be given together.
    pub(super) fn together(&mut self, table: &KeyPath, keys: &'static [&'static str]) {
        let together = &mut self.table_at(table).together;
        if !together.contains(&keys) {
            together.push(keys);
        }
    }

    /// Notes that a table has been read completely.
    pub(super) fn visited(&mut self, table: &KeyPath) {
        self.table_at(table).visits += 1;
    }

    fn value_at(&mut self, path: &KeyPath) -> &mut ValueSurvey {
        self.values.entry(self.place(path)).or_default()
    }

    fn table_at(&mut self, path: &KeyPath) -> &mut TableSurvey {
        self.tables.entry(self.place(path)).or_default()
    }

    /// Returns the name of a place, from the nearest definition above it or from the root.
    fn place(&self, path: &KeyPath) -> String {
        let mut rest = Vec::new();
        let mut above = path.clone();
        let mut name = loop {
            if let Some(definition) = self.definitions.get(&above) {
                break (*definition).to_owned();
            }
            match (above.steps().last().cloned(), above.parent()) {
                (Some(step), Some(parent)) => {
                    rest.push(step);
                    above = parent;
                }
                _ => break String::new(),
            }
        };
        for step in rest.iter().rev() {
            match step {
                Step::Index(_) => name += "[]",
                Step::Key(key) => name = below(&name, key),
            }
        }
        // A definition covers its component.
        if self.bare.contains(path) && !self.definitions.contains_key(path) {
            name += "[]";
        }
        name
    }
}

/// Returns the place of a key in the table at a place.
pub(crate) fn below(table: &str, key: &str) -> String {
    if table.is_empty() {
        return key.to_owned();
    }
    format!("{table}.{key}")
}
