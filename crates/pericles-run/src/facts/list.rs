//! The list of facts: lines of `check`, and an object of JSON.

use pericles::units::unit_per;
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::{Map, Value};

/// Parts of the list in the order in which they are printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Section {
    /// Points, bonds, memory.
    Body,
    /// Meshes and neighbours.
    Mesh,
    /// Materials and interfaces.
    Material,
    /// Plane waves.
    Waves,
    /// The initial state, frequencies and the time step.
    Time,
    /// Loads, heat conduction, contact.
    Conditions,
    /// Probes.
    Probes,
    /// Absorbing and open boundaries.
    Boundaries,
    /// Measured times and division among processes.
    Cost,
}

/// A property of a run before its first step.
#[derive(Debug, Clone, PartialEq)]
pub struct Fact {
    /// Key in JSON.
    pub key: &'static str,
    /// SI unit of numbers; empty for ratios, counts and other values.
    pub unit: String,
    /// Value; numbers are in SI units, NaN and infinities are null.
    pub value: Value,
    /// Whether `run.json` has it; `check --json` has all facts.
    pub is_recorded: bool,
}

/// Facts that are printed in one line.
#[derive(Debug, Clone)]
pub struct Line {
    section: Section,
    label: &'static str,
    /// Empty if the facts are not printed.
    text: String,
    facts: Vec<Fact>,
}

impl Line {
    /// Adds a fact of `run.json`.
    pub fn fact(&mut self, key: &'static str, unit: &str, value: impl Serialize) -> &mut Self {
        self.add(key, unit, &value, true)
    }

    /// Adds a fact of `run.json` that not all runs have.
    pub fn some(
        &mut self,
        key: &'static str,
        unit: &str,
        value: Option<impl Serialize>,
    ) -> &mut Self {
        match value {
            Some(value) => self.fact(key, unit, value),
            None => self,
        }
    }

    /// Adds a fact that only `check` reports.
    pub fn checked(&mut self, key: &'static str, unit: &str, value: impl Serialize) -> &mut Self {
        self.add(key, unit, &value, false)
    }

    /// Adds a list, unless it is empty.
    pub fn entries(
        &mut self,
        key: &'static str,
        values: &[impl Serialize],
        is_recorded: bool,
    ) -> &mut Self {
        match values {
            [] => self,
            values => self.add(key, "", &values, is_recorded),
        }
    }

    fn add(
        &mut self,
        key: &'static str,
        unit: &str,
        value: &impl Serialize,
        is_recorded: bool,
    ) -> &mut Self {
        self.facts.push(Fact {
            key,
            unit: unit.to_owned(),
            // Facts are numbers, texts, lists and structures, which serialise without errors.
            value: serde_json::to_value(value).unwrap_or_default(),
            is_recorded,
        });
        self
    }
}

/// The properties of a run before its first step, in SI units.
///
/// A fact is created in one place, with key, unit, value and the line in which `check` prints it. `run.json`, `check --json`,
/// reports and the Python package read this list.
#[derive(Debug, Clone, Default)]
pub struct Facts {
    lines: Vec<Line>,
    /// Warnings about the run.
    pub warnings: Vec<String>,
}

impl Facts {
    /// Adds a line; the facts of its numbers are added to it.
    pub fn line(
        &mut self,
        section: Section,
        label: &'static str,
        text: impl Into<String>,
    ) -> &mut Line {
        self.lines.push(Line {
            section,
            label,
            text: text.into(),
            facts: Vec::new(),
        });
        let last = self.lines.len() - 1;
        &mut self.lines[last]
    }

    /// Adds facts that are not printed.
    pub fn unprinted(&mut self, section: Section) -> &mut Line {
        self.line(section, "", "")
    }

    /// Adds lines whose numbers are facts of other lines.
    pub fn lines<T: Into<String>>(
        &mut self,
        section: Section,
        lines: impl IntoIterator<Item = (&'static str, T)>,
    ) {
        for (label, text) in lines {
            self.line(section, label, text);
        }
    }

    /// Adds lines whose facts are the entries of a list, which is missing if it is empty.
    pub fn list(
        &mut self,
        section: Section,
        key: &'static str,
        is_recorded: bool,
        entries: impl IntoIterator<Item = (&'static str, String, Value)>,
    ) {
        let mut values = Vec::new();
        for (label, text, value) in entries {
            self.line(section, label, text);
            values.push(value);
        }
        self.unprinted(section).entries(key, &values, is_recorded);
    }

    /// Returns all facts.
    pub fn iter(&self) -> impl Iterator<Item = &Fact> {
        self.lines.iter().flat_map(|line| &line.facts)
    }

    /// Returns label and text of the printed lines, in the order of the sections.
    pub fn printed(&self) -> Vec<(&'static str, &str)> {
        let mut lines: Vec<&Line> = self.lines.iter().collect();
        lines.retain(|line| !line.text.is_empty());
        lines.sort_by_key(|line| line.section);
        let pairs = lines.into_iter().map(|line| (line.label, &*line.text));
        pairs.collect()
    }

    /// Returns the text of the line with a label.
    pub fn words(&self, label: &str) -> Option<&str> {
        let line = self.lines.iter().find(|line| line.label == label)?;
        Some(&line.text)
    }

    /// Returns the value of a fact.
    pub fn value(&self, key: &str) -> Option<&Value> {
        let fact = self.iter().find(|fact| fact.key == key)?;
        Some(&fact.value)
    }

    /// Returns a number; `None` if the run does not have it.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.value(key)?.as_f64()
    }

    /// Returns a count; zero if the run does not have it.
    pub fn count(&self, key: &str) -> u64 {
        self.value(key).and_then(Value::as_u64).unwrap_or_default()
    }

    /// Returns a text; empty if the run does not have it.
    pub fn text(&self, key: &str) -> &str {
        self.value(key).and_then(Value::as_str).unwrap_or_default()
    }

    /// Returns the unit of a quantity of the body that has the given unit for the whole body.
    pub fn unit(&self, whole: &str) -> String {
        unit_per(whole, self.value("units_per").and_then(Value::as_str))
    }

    /// Returns all facts as an object of JSON, with their units and the warnings.
    pub fn to_json(&self) -> Map<String, Value> {
        let values = self
            .iter()
            .map(|fact| (fact.key.into(), fact.value.clone()));
        let mut json: Map<String, Value> = values.collect();
        let with_unit = self.iter().filter(|fact| !fact.unit.is_empty());
        let units = with_unit.map(|fact| (fact.key.into(), fact.unit.as_str().into()));
        json.insert("units".into(), Value::Object(units.collect()));
        json.insert("warnings".into(), self.warnings.clone().into());
        json
    }
}

/// The facts of `run.json` with the warnings.
impl Serialize for Facts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for fact in self.iter().filter(|fact| fact.is_recorded) {
            map.serialize_entry(fact.key, &fact.value)?;
        }
        map.serialize_entry("warnings", &self.warnings)?;
        map.end()
    }
}
