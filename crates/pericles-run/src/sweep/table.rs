//! The table of a sweep: a row per run.

use std::path::{Path, PathBuf};

use pericles_io::read_csv;

use super::results::SweepResults;
use crate::error::RunError;
use crate::json::write_rows;
use crate::results::Results;
use crate::units::significant;

/// Columns of all runs with the names of their numbers in `run.json`.
const NUMBERS: [(&str, &str); 10] = [
    ("points", "model.points"),
    ("dt", "model.dt"),
    ("time", "progress.t"),
    ("kinetic_energy", "audit.kinetic_energy"),
    ("elastic_energy", "audit.elastic_energy"),
    ("dissipated_energy", "audit.dissipated_energy"),
    ("external_work", "audit.external_work"),
    ("energy_drift", "audit.energy_drift"),
    ("broken_bonds", "audit.broken_bonds"),
    ("largest_damage", "audit.largest_damage"),
];

/// Columns of [`NUMBERS`] in the summary of the program.
const SHOWN: [&str; 3] = ["broken_bonds", "energy_drift", "elastic_energy"];

/// The table of a sweep.
pub struct Table {
    /// The header, then a row per run.
    rows: Vec<Vec<String>>,
    /// Number of columns before the numbers: name, values and status of a run.
    words: usize,
    path: PathBuf,
}

impl SweepResults {
    /// Collects values, status and results of the runs.
    pub fn table(&self) -> Table {
        Table::of(self)
    }
}

impl Table {
    fn of(sweep: &SweepResults) -> Self {
        let (axes, members) = (&sweep.record.axes, &sweep.members);
        let found: Vec<Option<Results>> = sweep.runs().map(|(_, results)| results).collect();
        let probes: Vec<Vec<(String, f64)>> = found
            .iter()
            .map(|results| last_readings(results.as_ref()))
            .collect();
        // All runs have the same probes and quantities; runs that failed early have no values.
        let longest = probes.iter().max_by_key(|readings| readings.len());
        let readings: Vec<&str> = longest
            .into_iter()
            .flatten()
            .map(|(name, _)| name.as_str())
            .collect();
        let mut header: Vec<String> = vec!["run".into()];
        header.extend(axes.iter().map(|axis| axis.key.clone()));
        header.push("status".into());
        // Runs without results have no numbers.
        let first = found.iter().flatten().next();
        let unit = |number: &str| first.map_or(String::new(), |results| results.unit_of(number));
        header.extend(NUMBERS.map(|(name, number)| with_unit(name, &unit(number))));
        header.extend(readings.iter().map(|name| (*name).to_owned()));
        let mut rows = vec![header];
        for ((member, results), probes) in members.iter().zip(&found).zip(&probes) {
            let mut row = vec![member.name.clone()];
            row.extend(member.values.iter().cloned());
            row.push(
                results
                    .as_ref()
                    .map_or("none", |results| results.text("/status"))
                    .to_owned(),
            );
            let number = |name: &str| {
                let pointer = format!("/{}", name.replace('.', "/"));
                let value = results.as_ref()?.value(&pointer)?;
                value.is_number().then(|| value.to_string())
            };
            row.extend(NUMBERS.map(|(_, name)| number(name).unwrap_or_default()));
            row.extend(readings.iter().map(|name| {
                let reading = probes.iter().find(|(probe, _)| probe == name);
                reading.map_or(String::new(), |(_, x)| format!("{x:?}"))
            }));
            rows.push(row);
        }
        Self {
            rows,
            words: axes.len() + 2,
            path: sweep.folder().join("summary.csv"),
        }
    }

    /// Writes `summary.csv`.
    ///
    /// # Errors
    /// The table cannot be written.
    pub(super) fn write(&self) -> Result<(), RunError> {
        write_rows(&self.path, &self.rows)
    }

    /// Returns the header, then a row per run.
    pub fn rows(&self) -> &[Vec<String>] {
        &self.rows
    }

    /// Returns the path of `summary.csv`.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns names, status and main results of the runs as aligned columns.
    pub fn lines(&self) -> Vec<String> {
        let (rows, words) = (&self.rows, self.words);
        let Some(header) = rows.first() else {
            return Vec::new();
        };
        let wanted = (words - 1..words).chain((words..header.len()).filter(|&column| {
            let number = NUMBERS.get(column - words);
            number.is_none_or(|(name, _)| SHOWN.contains(name))
        }));
        let columns: Vec<usize> = std::iter::once(0).chain(wanted).collect();
        let short = |row: usize, column: usize| -> String {
            let text = &rows[row][column];
            match text.parse::<f64>() {
                Ok(number) if row > 0 && column >= words && number.fract() != 0.0 => {
                    significant(number, 4)
                }
                Ok(number) if row > 0 && column >= words => format!("{number}"),
                _ => text.clone(),
            }
        };
        let line = |row: usize| {
            let cells = columns.iter().map(|&column| {
                let width = (0..rows.len())
                    .map(|row| short(row, column).chars().count())
                    .max();
                format!(
                    "{:<width$}",
                    short(row, column),
                    width = width.unwrap_or_default()
                )
            });
            let cells: Vec<String> = cells.collect();
            cells.join("  ").trim_end().to_owned()
        };
        (0..rows.len()).map(line).collect()
    }
}

/// Returns the header of a column.
fn with_unit(name: &str, unit: &str) -> String {
    match unit {
        "" => name.to_owned(),
        unit => format!("{name} [{unit}]"),
    }
}

/// Returns the values of probes and derived quantities in the last row of their tables.
fn last_readings(results: Option<&Results>) -> Vec<(String, f64)> {
    let mut readings = Vec::new();
    for name in ["probes.csv", "quantities.csv"] {
        let table = results.map(|results| read_csv(results.folder().join(name)));
        let Some(Ok(table)) = table else {
            continue;
        };
        let columns = table.columns.iter().zip(&table.values).skip(2);
        readings.extend(columns.filter_map(|(column, values)| {
            Some((with_unit(column.name(), column.unit()), *values.last()?))
        }));
    }
    readings
}
