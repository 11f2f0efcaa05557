//! Charts of scalars over the values of a sweep.

use pericles_deck::{Deck, unit_of_key};
use pericles_io::{Axis as ChartAxis, Curve, LineChart};
use serde_json::Value;

use super::record::Member;
use super::results::SweepResults;
use crate::error::RunError;
use crate::results::Results;
use crate::scalar::Scalar;

impl SweepResults {
    /// Returns the values of the keys of each run in SI units; none for values that are not numbers.
    ///
    /// # Errors
    /// The deck cannot be read.
    pub fn numbers(&self) -> Result<Vec<Vec<Option<f64>>>, RunError> {
        let of_member = |member: &Member| {
            let deck = member.deck.read()?;
            let axes = self.record.axes.iter();
            Ok(axes.map(|axis| value_of(&deck, &axis.key)).collect())
        };
        self.members.iter().map(of_member).collect()
    }

    /// Returns a chart of a scalar of the runs over the values of a key, by default of the first one, with a curve for each
    /// combination of the other values. Values that are not numbers are counted from 1. Runs without results are omitted.
    ///
    /// The scalar is a column of the tables (last value), `max:COLUMN`, `min:COLUMN`, or a number of `run.json` such as
    /// `audit.elastic_energy`.
    ///
    /// # Errors
    /// The sweep does not have the key, or the runs do not have the scalar.
    pub fn chart(&self, key: Option<&str>, scalar: &str) -> Result<LineChart, RunError> {
        let axes = &self.record.axes;
        let place = match key {
            None => 0,
            Some(key) => {
                let found = axes
                    .iter()
                    .position(|axis| axis.key == key || axis.name() == key);
                found.ok_or_else(|| {
                    let keys: Vec<String> = self.keys().map(|(key, _)| key.into()).collect();
                    let listing = format!("the keys of the sweep are {}", keys.join(", "));
                    RunError::unknown("key", key, &keys, &listing)
                })?
            }
        };
        let source = Scalar::named(scalar);
        let (mut curves, mut unit): (Vec<Family>, _) = (Vec::new(), String::new());
        let mut is_numeric = true;
        for member in &self.members {
            let Ok(results) = Results::open(&self.folder().join(&member.name)) else {
                continue;
            };
            let value;
            (value, unit) = source.of(&results)?;
            let x = value_of(&member.deck.read()?, &axes[place].key);
            is_numeric &= x.is_some();
            let number = axes[place].values.iter();
            let number = number
                .take_while(|value| **value != member.values[place])
                .count();
            let others = axes.iter().zip(&member.values).enumerate();
            let others: Vec<String> = others
                .filter(|(k, _)| *k != place)
                .map(|(_, (axis, value))| format!("{} = {value}", axis.name()))
                .collect();
            let name = others.join(", ");
            let point = (x, number as f64 + 1.0, value);
            match curves.iter_mut().find(|family| family.name == name) {
                Some(family) => family.points.push(point),
                None => curves.push(Family {
                    name,
                    points: vec![point],
                }),
            }
        }
        let across = match is_numeric {
            true => ChartAxis::new(axes[place].key.as_str(), unit_of_key(&axes[place].key)),
            false => ChartAxis::new(format!("{} (number of the value)", axes[place].key), ""),
        };
        let upward = ChartAxis::new(source.title(), unit);
        let chart = curves
            .into_iter()
            .fold(LineChart::new(across, upward), |chart, family| {
                let mut points: Vec<(f64, f64)> = family
                    .points
                    .iter()
                    .map(|(x, number, y)| (x.filter(|_| is_numeric).unwrap_or(*number), *y))
                    .collect();
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
                chart.curve(Curve::line(family.name, &x, &y).with_markers())
            });
        Ok(chart)
    }
}

/// Runs with the same values of all other keys: value of the key, its number, scalar.
struct Family {
    name: String,
    points: Vec<(Option<f64>, f64, f64)>,
}

/// Returns the value of a key of a deck in SI units; none if it is not a number.
pub(crate) fn value_of(deck: &Deck, key: &str) -> Option<f64> {
    let found = key.split('.').try_fold(deck.to_json(), |value, part| {
        let index: Option<usize> = part.parse().ok();
        match (value, index) {
            (Value::Array(items), Some(index)) => items.get(index),
            _ => value.get(part),
        }
    });
    found.and_then(Value::as_f64)
}
