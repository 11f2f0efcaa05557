//! The fitted values with their errors, as table, lines and picture.

use std::path::Path;

use pericles_deck::unit_of_key;
use pericles_io::{Axis, Curve, LineChart};

use super::curve::Measured;
use super::least_squares::{Minimum, Range, standard_errors};
use super::student::two_sided_95;
use super::{Evaluation, Record};
use crate::error::RunError;
use crate::json::write_rows;
use crate::units::{percent, quantity};

/// The result of a fit.
pub struct Outcome {
    values: Vec<FittedValue>,
    measured: Measured,
    /// The curve of the deck as given, and the fitted one, at the measured points.
    curves: [Vec<f64>; 2],
    /// Root mean square of the residuals of both.
    misfits: [f64; 2],
    /// Number of measured points beyond the end of the fitted curve.
    beyond: usize,
    converged: bool,
    runs: usize,
}

/// The fitted value of a key, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedValue {
    /// The key.
    pub key: String,
    /// The value of the deck.
    pub start: f64,
    /// The lower bound.
    pub low: f64,
    /// The upper bound.
    pub high: f64,
    /// The fitted value.
    pub value: f64,
    /// Standard error; NaN if the curve does not determine the value.
    pub error: f64,
    /// Half of the 95 % confidence interval.
    pub half: f64,
}

impl Outcome {
    pub(super) fn of(
        record: &Record,
        minimum: &Minimum,
        ranges: &[Range],
        evaluations: &[Evaluation],
    ) -> Self {
        let measured = record.measured.clone();
        let errors = standard_errors(minimum, ranges, record.step);
        let freedom = minimum.residuals.len().saturating_sub(ranges.len());
        let factor = two_sided_95(freedom);
        let values = record.parameters.iter().zip(&minimum.values).zip(errors);
        let values = values.map(|((parameter, &value), error)| FittedValue {
            key: parameter.key.clone(),
            start: parameter.start,
            low: parameter.low,
            high: parameter.high,
            value,
            error,
            half: factor * error,
        });
        let best = evaluations.iter().find(|one| one.values == minimum.values);
        let [start, best] = [evaluations.first(), best].map(|one| one.map(|one| &one.sampled));
        let misfit = |residuals: &[f64]| {
            let sum: f64 = residuals.iter().map(|r| r * r).sum();
            (sum / residuals.len() as f64).sqrt()
        };
        Self {
            values: values.collect(),
            misfits: [
                start.map_or(f64::NAN, |start| misfit(&measured.residuals(start))),
                misfit(&minimum.residuals),
            ],
            curves: [start, best].map(|one| one.map_or_else(Vec::new, |one| one.y.clone())),
            beyond: best.map_or(0, |best| best.beyond),
            measured,
            converged: minimum.converged,
            runs: minimum.evaluations,
        }
    }

    /// Returns the values with their errors.
    pub fn values(&self) -> &[FittedValue] {
        &self.values
    }

    /// Returns the number of runs.
    pub fn runs(&self) -> usize {
        self.runs
    }

    /// Returns the root mean square of the differences, divided by the largest measured |y|: of the deck as given and of
    /// the fitted one.
    pub fn misfits(&self) -> [f64; 2] {
        self.misfits
    }

    /// Returns whether the values no longer change by more than the tolerance.
    pub fn has_converged(&self) -> bool {
        self.converged
    }

    /// Returns the options of the command line that give a deck the fitted values.
    pub fn overrides(&self) -> Vec<String> {
        let values = self.values.iter();
        values
            .map(|value| format!("{}={:e}", value.key, value.value))
            .collect()
    }

    /// Returns a line per key, with its value before and after and half of its 95 % confidence interval, and a line about
    /// the misfit.
    pub fn lines(&self) -> Vec<String> {
        let widest = self
            .values
            .iter()
            .map(|value| value.key.chars().count())
            .max();
        let widest = widest.unwrap_or_default();
        let mut lines: Vec<String> = self
            .values
            .iter()
            .map(|value| {
                let unit = unit_of_key(&value.key);
                let range = match value.half.is_finite() {
                    true => format!(" ± {} (95 %)", quantity(value.half, unit)),
                    false => String::new(),
                };
                format!(
                    "{:<widest$}  {} → {}{range}",
                    value.key,
                    quantity(value.start, unit),
                    quantity(value.value, unit),
                )
            })
            .collect();
        lines.push(format!(
            "difference (root mean square) {} → {} of the largest |{}|; {} runs",
            percent(self.misfits[0]),
            percent(self.misfits[1]),
            self.measured.names[1],
            self.runs
        ));
        lines
    }

    /// Returns what limits the result.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if !self.converged {
            warnings.push(format!(
                "the values still change after {} runs; raise --runs, or --tolerance",
                self.runs
            ));
        }
        for value in &self.values {
            let key = &value.key;
            if value.value <= value.low || value.value >= value.high {
                warnings.push(format!("{key} is at its bound"));
            } else if value.error.is_nan() {
                warnings.push(format!(
                    "the curve does not determine {key}, alone or together with the other keys"
                ));
            }
        }
        if self.beyond > 0 {
            warnings.push(format!(
                "{} of {} measured points are beyond the end of the fitted curve, whose last value is compared with them; the run should be longer",
                self.beyond,
                self.measured.x.len()
            ));
        }
        warnings
    }

    /// Writes `fit.csv`, `curve.csv` and `fit.png`.
    ///
    /// # Errors
    /// A file cannot be written.
    pub(super) fn write(&self, folder: &Path) -> Result<(), RunError> {
        let header = [
            "key",
            "unit",
            "start",
            "value",
            "standard_error",
            "low_95",
            "high_95",
            "lower_bound",
            "upper_bound",
        ];
        let number = |value: f64| match value.is_nan() {
            true => String::new(),
            false => format!("{value:?}"),
        };
        let row = |value: &FittedValue| {
            let numbers = [
                value.start,
                value.value,
                value.error,
                value.value - value.half,
                value.value + value.half,
                value.low,
                value.high,
            ];
            let words = [value.key.clone(), unit_of_key(&value.key).to_owned()];
            words.into_iter().chain(numbers.map(number)).collect()
        };
        let mut table: Vec<Vec<String>> = vec![header.map(String::from).into()];
        table.extend(self.values.iter().map(row));
        write_rows(&folder.join("fit.csv"), &table)?;
        let [x_name, y_name] = self.titles();
        let mut table = vec![vec![
            x_name,
            format!("measured {y_name}"),
            format!("start {y_name}"),
            format!("fitted {y_name}"),
        ]];
        let [start, fitted] = &self.curves;
        table.extend((0..self.measured.x.len()).map(|k| {
            let numbers = [self.measured.x[k], self.measured.y[k], start[k], fitted[k]];
            numbers.map(number).to_vec()
        }));
        write_rows(&folder.join("curve.csv"), &table)?;
        Ok(self.chart().write(folder.join("fit.png"))?)
    }

    fn titles(&self) -> [String; 2] {
        [0, 1].map(|side| match self.measured.units[side].as_str() {
            "" => self.measured.names[side].clone(),
            unit => format!("{} [{unit}]", self.measured.names[side]),
        })
    }

    /// Returns the measured points with the curves before and after.
    fn chart(&self) -> LineChart {
        let axis = |side: usize| {
            let name = self.measured.names[side].replace('_', " ");
            Axis::new(name, self.measured.units[side].as_str())
        };
        let [start, fitted] = &self.curves;
        let x = &self.measured.x;
        LineChart::new(axis(0), axis(1))
            .curve(Curve::points("measured", x, &self.measured.y))
            .curve(Curve::line("deck as given", x, start).dashed())
            .curve(Curve::line("fitted", x, fitted))
    }
}
