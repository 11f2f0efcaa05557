//! The table of a sweep: a row per run.

use std::io::Write;
use std::path::{Path, PathBuf};

use pericles_io::{OutputFolder, csv_row, read_csv, write_atomically};

use super::axis::Axis;
use super::record::Member;
use crate::error::RunError;
use crate::results::Results;
use crate::units::significant;

/// The columns of every run, with their place in `run.json`.
const NUMBERS: [(&str, &str); 10] = [
    ("points", "/model/points"),
    ("dt [s]", "/model/dt"),
    ("time [s]", "/progress/t"),
    ("kinetic_energy [J]", "/audit/kinetic_energy"),
    ("elastic_energy [J]", "/audit/elastic_energy"),
    ("dissipated_energy [J]", "/audit/dissipated_energy"),
    ("external_work [J]", "/audit/external_work"),
    ("energy_drift", "/audit/energy_drift"),
    ("broken_bonds", "/audit/broken_bonds"),
    ("largest_damage", "/audit/largest_damage"),
];

/// The table of a sweep.
pub struct Table {
    /// The header, then a row per run.
    rows: Vec<Vec<String>>,
    /// Columns before the numbers: the name of a run, its values, its status.
    words: usize,
    path: PathBuf,
}

impl Table {
    /// Collects the values, and how the runs ended, and writes them to `summary.csv`.
    ///
    /// # Errors
    /// A table that cannot be written.
    pub(super) fn write(
        axes: &[Axis],
        members: &[Member],
        folder: &OutputFolder,
    ) -> Result<Self, RunError> {
        let found: Vec<Option<Results>> = members
            .iter()
            .map(|member| Results::open(&folder.file(&member.name)).ok())
            .collect();
        let probes: Vec<Vec<(String, f64)>> = found
            .iter()
            .map(|results| last_readings(results.as_ref()))
            .collect();
        // Runs of one deck have the same probes; one that failed early has none.
        let longest = probes.iter().max_by_key(|readings| readings.len());
        let readings: Vec<&str> = longest
            .into_iter()
            .flatten()
            .map(|(name, _)| name.as_str())
            .collect();
        let mut header: Vec<String> = vec!["run".into()];
        header.extend(axes.iter().map(|axis| axis.key.clone()));
        header.push("status".into());
        header.extend(NUMBERS.map(|(name, _)| name.to_owned()));
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
            let number = |pointer: &str| {
                let value = results.as_ref()?.value(pointer)?;
                value.is_number().then(|| value.to_string())
            };
            row.extend(NUMBERS.map(|(_, pointer)| number(pointer).unwrap_or_default()));
            row.extend(readings.iter().map(|name| {
                let reading = probes.iter().find(|(probe, _)| probe == name);
                reading.map_or(String::new(), |(_, x)| format!("{x:?}"))
            }));
            rows.push(row);
        }
        let path = folder.file("summary.csv");
        write_atomically(&path, |file| {
            rows.iter()
                .try_for_each(|row| file.write_all(csv_row(row).as_bytes()))
        })?;
        Ok(Self {
            rows,
            words: axes.len() + 2,
            path,
        })
    }

    /// The file that holds it, `summary.csv`.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The names and status of the runs, and the numbers that are there, in columns for people.
    pub fn lines(&self) -> Vec<String> {
        let (rows, words) = (&self.rows, self.words);
        let Some(header) = rows.first() else {
            return Vec::new();
        };
        let wanted = (words - 1..words).chain((words..header.len()).filter(|&column| {
            ["broken_bonds", "energy_drift", "elastic_energy [J]"]
                .contains(&header[column].as_str())
                || column >= words + NUMBERS.len()
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

/// What the probes read in the last row of their table.
fn last_readings(results: Option<&Results>) -> Vec<(String, f64)> {
    let table = results.map(|results| read_csv(results.folder().join("probes.csv")));
    let Some(Ok(table)) = table else {
        return Vec::new();
    };
    let columns = table.columns.iter().zip(&table.values).skip(2);
    columns
        .filter_map(|(column, values)| {
            let name = format!("{} [{}]", column.name(), column.unit());
            Some((name, *values.last()?))
        })
        .collect()
}
