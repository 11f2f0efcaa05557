//! Functions called by the study data: their arguments and results.

use std::any::Any;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use pericles_run::RunError;
use toml::{Table, Value};

use super::template;
use crate::context::Context;
use crate::row::Row;

/// A function and the name by which the data call it.
pub(crate) type Measure = (&'static str, fn(&Case<'_>) -> Result<Found, RunError>);

/// Intermediate results shared by the functions of a study, by name.
pub(super) type Shared = RefCell<BTreeMap<String, Rc<dyn Any>>>;

/// Arguments of a function at one place of the axes.
pub(crate) struct Case<'a> {
    arguments: &'a Table,
    /// Options of the study run.
    pub(crate) context: &'a Context<'a>,
    shared: &'a Shared,
    asked: RefCell<BTreeSet<String>>,
}

impl<'a> Case<'a> {
    pub(super) fn new(arguments: &'a Table, context: &'a Context<'a>, shared: &'a Shared) -> Self {
        Self {
            arguments,
            context,
            shared,
            asked: RefCell::default(),
        }
    }

    /// Arguments that the function has requested.
    pub(super) fn into_asked(self) -> BTreeSet<String> {
        self.asked.into_inner()
    }

    fn get(&self, name: &str) -> Option<&'a Value> {
        self.asked.borrow_mut().insert(name.to_owned());
        self.arguments.get(name)
    }

    fn lacks(&self, kind: &'static str, name: &str) -> RunError {
        let place = "set it in `with` or `axes` of the study's data";
        RunError::unknown(kind, name, self.arguments.keys(), place)
    }

    /// Returns true if the argument is given.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
    }

    /// Optional number.
    pub(crate) fn optional(&self, name: &str) -> Option<f64> {
        self.get(name).and_then(number)
    }

    /// Number.
    pub(crate) fn number(&self, name: &str) -> Result<f64, RunError> {
        self.optional(name)
            .ok_or_else(|| self.lacks("number", name))
    }

    /// Natural number.
    pub(crate) fn count(&self, name: &str) -> Result<usize, RunError> {
        let count = self.number(name)?;
        if count >= 0.0 && count.fract() == 0.0 {
            return Ok(count as usize);
        }
        Err(self.lacks("natural number", name))
    }

    /// Returns true if the argument is given and true.
    pub(crate) fn flag(&self, name: &str) -> bool {
        self.get(name).and_then(Value::as_bool).unwrap_or(false)
    }

    /// List of numbers, or a single number.
    pub(crate) fn numbers(&self, name: &str) -> Result<Vec<f64>, RunError> {
        let numbers = match self.get(name) {
            Some(Value::Array(all)) => all.iter().map(number).collect(),
            other => other.and_then(number).map(|one| vec![one]),
        };
        numbers.ok_or_else(|| self.lacks("list of numbers", name))
    }

    fn expanded(&self, text: &str) -> Result<String, RunError> {
        let known = |name: &str| {
            self.asked.borrow_mut().insert(name.to_owned());
            template::argument(self.arguments, name)
        };
        template::expand(text, &known).map_err(|name| self.lacks("argument", &name))
    }

    /// Text, with names of arguments replaced.
    pub(crate) fn text(&self, name: &str) -> Result<String, RunError> {
        let text = self.get(name).and_then(Value::as_str);
        self.expanded(text.ok_or_else(|| self.lacks("text", name))?)
    }

    /// List of texts, with names of arguments replaced; empty if not given.
    pub(crate) fn texts(&self, name: &str) -> Result<Vec<String>, RunError> {
        let all = self.get(name).and_then(Value::as_array);
        let texts = all.into_iter().flatten().filter_map(Value::as_str);
        texts.map(|text| self.expanded(text)).collect()
    }

    /// Named lists of texts, with names of arguments replaced; empty if not given.
    pub(crate) fn lists(&self, name: &str) -> Result<Vec<(String, Vec<String>)>, RunError> {
        let table = self.get(name).and_then(Value::as_table);
        let lists = table.into_iter().flatten().map(|(name, list)| {
            let texts = list.as_array().into_iter().flatten();
            let texts = texts.filter_map(Value::as_str);
            let texts: Result<_, RunError> = texts.map(|text| self.expanded(text)).collect();
            Ok((name.clone(), texts?))
        });
        lists.collect()
    }

    /// Value that a text selects.
    pub(crate) fn one_of<T: Clone>(
        &self,
        name: &'static str,
        all: &[(&str, T)],
    ) -> Result<T, RunError> {
        named(name, &self.text(name)?, all)
    }

    /// Computes a value once per study; `key` identifies its arguments.
    pub(crate) fn once<T: 'static>(
        &self,
        key: String,
        compute: impl FnOnce() -> Result<T, RunError>,
    ) -> Result<Rc<T>, RunError> {
        let known = self.shared.borrow().get(&key).cloned();
        if let Some(known) = known.and_then(|known| known.downcast().ok()) {
            return Ok(known);
        }
        let made = Rc::new(compute()?);
        let kept: Rc<dyn Any> = made.clone();
        self.shared.borrow_mut().insert(key, kept);
        Ok(made)
    }
}

/// Returns the value that a word of the data selects.
pub(crate) fn named<T: Clone>(
    kind: &'static str,
    word: &str,
    all: &[(&str, T)],
) -> Result<T, RunError> {
    let found = all.iter().find(|(known, _)| *known == word);
    found.map(|(_, value)| value.clone()).ok_or_else(|| {
        let words = all.iter().map(|(known, _)| *known);
        let allowed = words.clone().collect::<Vec<_>>().join(", ");
        RunError::unknown(kind, word, words, &format!("allowed: {allowed}"))
    })
}

pub(super) fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|n| n as f64))
}

/// Curve of a figure.
#[derive(Debug)]
pub(super) struct Drawn {
    pub(super) name: &'static str,
    pub(super) label: Option<String>,
    pub(super) x: Vec<f64>,
    pub(super) y: Vec<f64>,
}

/// Results of a function.
#[derive(Debug, Default)]
pub(crate) struct Found {
    /// Numbers by name; `None` if the measured event did not happen.
    values: BTreeMap<String, Option<f64>>,
    /// Texts by name, for labels and notes.
    texts: BTreeMap<String, String>,
    /// Curves.
    pub(super) curves: Vec<Drawn>,
    /// Complete rows, if only the function knows their number.
    pub(super) rows: Vec<Row>,
}

impl Found {
    /// Adds a number.
    pub(crate) fn value(mut self, name: impl Into<String>, value: impl Into<Option<f64>>) -> Self {
        self.values.insert(name.into(), value.into());
        self
    }

    /// Adds a text.
    pub(crate) fn text(mut self, name: &str, text: impl Into<String>) -> Self {
        self.texts.insert(name.into(), text.into());
        self
    }

    /// Adds a curve whose label is given by the data.
    pub(crate) fn curve(self, name: &'static str, x: &[f64], y: &[f64]) -> Self {
        self.labelled(name, None, x, y)
    }

    /// Adds a curve that may have its own label.
    pub(crate) fn labelled(
        mut self,
        name: &'static str,
        label: Option<String>,
        x: &[f64],
        y: &[f64],
    ) -> Self {
        let (x, y) = (x.to_vec(), y.to_vec());
        self.curves.push(Drawn { name, label, x, y });
        self
    }

    /// Returns the number with this name, if any.
    pub(super) fn number(&self, name: &str) -> Option<Option<f64>> {
        self.values.get(name).copied()
    }

    /// Returns the number or text with this name.
    pub(super) fn shown(&self, name: &str) -> Option<Value> {
        let number = self.values.get(name).copied().flatten().map(Value::Float);
        number.or_else(|| self.texts.get(name).cloned().map(Value::String))
    }
}

impl From<Vec<Row>> for Found {
    fn from(rows: Vec<Row>) -> Self {
        Self {
            rows,
            ..Self::default()
        }
    }
}

/// The number named `value`.
impl From<f64> for Found {
    fn from(value: f64) -> Self {
        Self::default().value("value", value)
    }
}

/// Numbers with their names.
impl<const N: usize> From<[(&str, f64); N]> for Found {
    fn from(values: [(&str, f64); N]) -> Self {
        let put = |found: Self, (name, value)| found.value(name, value);
        values.into_iter().fold(Self::default(), put)
    }
}
