//! Comparison of two results field by field and column by column.
//!
//! The relative difference of two values a, b of a field or column is |a − b| / s, where s is the largest magnitude
//! of the field at that time, or of the whole column, in either result. States and rows of tables are compared if
//! both results have one at the same time (up to rounding); the others are counted. Pictures, checkpoints and
//! run.json are not compared: they contain no further numbers, or differ from run to run.

mod times;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::PathBuf;

use pericles::sum::max_norm;
use pericles_io::{FieldData, read_csv};
use serde::Serialize;

use self::times::{Matches, matched};
use crate::error::RunError;
use crate::results::{FieldFile, Results};
use crate::units::quantity;

/// The differences between two results.
#[derive(Debug, Serialize)]
pub struct Comparison {
    /// The first folder.
    pub a: PathBuf,
    /// The second folder.
    pub b: PathBuf,
    /// The largest relative difference allowed.
    pub tolerance: f64,
    /// Fields, then the columns of tables.
    pub rows: Vec<Row>,
    /// Missing items, and counts or times that differ.
    pub unlike: Vec<String>,
    /// Number of states and rows without a counterpart of the same time and size.
    pub skipped: usize,
    /// Whether all differences are within the tolerance and nothing is missing.
    pub equal: bool,
}

/// One field over all times, or one column of a table.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// `fields` or the table's file.
    pub place: String,
    /// Name of the field or column.
    pub name: String,
    /// Number of values compared.
    pub values: usize,
    /// Number of values that differ.
    pub different: usize,
    /// Largest relative difference.
    pub relative: f64,
    /// Largest absolute difference, SI units.
    pub absolute: f64,
    /// Location of the largest relative difference.
    pub at: String,
}

impl Comparison {
    /// Compares two results; they are equal if no relative difference exceeds `tolerance` and nothing is missing.
    ///
    /// # Errors
    /// A file is damaged.
    pub fn of(a: &Results, b: &Results, tolerance: f64) -> Result<Self, RunError> {
        let mut unlike = Unlike::default();
        let mut rows = compare_fields(a, b, &mut unlike)?;
        rows.extend(compare_tables(a, b, &mut unlike)?);
        let within = |row: &Row| row.relative <= tolerance;
        let equal = unlike.words.is_empty() && rows.iter().all(within);
        Ok(Self {
            a: a.folder().into(),
            b: b.folder().into(),
            tolerance,
            rows,
            unlike: unlike.words,
            skipped: unlike.skipped,
            equal,
        })
    }
}

/// Items that only one of the two results has.
#[derive(Default)]
struct Unlike {
    words: Vec<String>,
    skipped: usize,
}

impl Unlike {
    /// Adds a message unless it is already present.
    fn note(&mut self, words: String) {
        if !self.words.contains(&words) {
            self.words.push(words);
        }
    }

    /// Reports states or rows without a counterpart; `times` are the times of the two results.
    fn note_alone(&mut self, place: &str, what: &str, matches: &Matches, times: [&[f64]; 2]) {
        let results = [("first", "second"), ("second", "first")];
        for ((alone, times), (has, lacks)) in matches.alone.iter().zip(times).zip(results) {
            let Some(&first) = alone.first() else {
                continue;
            };
            self.skipped += alone.len();
            self.note(format!(
                "{place}: {} of the {} {what}s of the {has} result, from t = {}, not compared: the {lacks} has none at the same time",
                alone.len(),
                times.len(),
                quantity(times[first], "s"),
            ));
        }
    }
}

/// Accumulates differences into a row.
struct Tally {
    row: Row,
}

impl Tally {
    fn new(place: &str, name: &str) -> Self {
        Self {
            row: Row {
                place: place.into(),
                name: name.into(),
                values: 0,
                different: 0,
                relative: 0.0,
                absolute: 0.0,
                at: String::new(),
            },
        }
    }

    /// Adds values that are scaled by the same magnitude; `place` names the k-th one.
    fn add(&mut self, a: &[f64], b: &[f64], place: impl Fn(usize) -> String) {
        let finite = |values: &[f64]| max_norm(values.iter().filter(|x| x.is_finite()));
        let size = finite(a).max(finite(b));
        self.row.values += a.len().min(b.len());
        for (k, (&a, &b)) in a.iter().zip(b).enumerate() {
            // Empty cells and infinities of the same sign are equal.
            if a == b || (a.is_nan() && b.is_nan()) {
                continue;
            }
            let absolute = (a - b).abs();
            let (absolute, relative) = if absolute.is_finite() {
                (absolute, absolute / size)
            } else {
                (f64::INFINITY, f64::INFINITY)
            };
            self.row.different += 1;
            self.row.absolute = self.row.absolute.max(absolute);
            if relative > self.row.relative {
                self.row.relative = relative;
                self.row.at = place(k);
            }
        }
    }
}

fn compare_fields(a: &Results, b: &Results, unlike: &mut Unlike) -> Result<Vec<Row>, RunError> {
    let (series_a, series_b) = (a.fields()?, b.fields()?);
    let times = |series: &[FieldFile]| series.iter().map(|state| state.time).collect::<Vec<_>>();
    let (times_a, times_b) = (times(&series_a), times(&series_b));
    if series_a.len() != series_b.len() {
        unlike.note(format!(
            "fields: {} states in the first, {} in the second",
            series_a.len(),
            series_b.len()
        ));
    }
    let matches = matched(&times_a, &times_b);
    unlike.note_alone("fields", "state", &matches, [&times_a, &times_b]);
    let mut tallies: BTreeMap<String, Tally> = BTreeMap::new();
    for (i, j) in matches.pairs {
        compare_state(&series_a[i], &series_b[j], &mut tallies, unlike)?;
    }
    Ok(tallies.into_values().map(|tally| tally.row).collect())
}

/// Compares the common fields of two states.
fn compare_state(
    one: &FieldFile,
    other: &FieldFile,
    tallies: &mut BTreeMap<String, Tally>,
    unlike: &mut Unlike,
) -> Result<(), RunError> {
    let (a, b) = (one.read()?, other.read()?);
    if a.points.len() != b.points.len() {
        unlike.skipped += 1;
        unlike.note(format!(
            "fields: {} points in the first, {} in the second",
            a.points.len() / 3,
            b.points.len() / 3
        ));
        return Ok(());
    }
    let time = quantity(one.time, "s");
    let mut tally = |name: &str, components: usize, a: &[f64], b: &[f64]| {
        let tally = tallies
            .entry(name.to_owned())
            .or_insert_with(|| Tally::new("fields", name));
        tally.add(a, b, |k| format!("at t = {time}, point {}", k / components));
    };
    if a.is_on_cells == b.is_on_cells || !are_near(&a.points, &b.points) {
        tally("Points", 3, &a.points, &b.points);
    }
    let names = |data: &FieldData| {
        data.fields
            .iter()
            .map(|field| field.name.clone())
            .collect::<Vec<_>>()
    };
    note_missing("fields", &names(&a), &names(&b), unlike);
    for field in &a.fields {
        if let Some(twin) = b.field(&field.name) {
            tally(&field.name, field.components, &field.values, &twin.values);
        }
    }
    Ok(())
}

/// Whether points are the same to rounding: points of a file on cells are centroids.
fn are_near(a: &[f64], b: &[f64]) -> bool {
    /// Rounding of a mean of eight corners, with a margin.
    const ROUNDING: f64 = 1e-12;
    let size = max_norm(a.iter().chain(b));
    let mut pairs = a.iter().zip(b);
    pairs.all(|(a, b)| (a - b).abs() <= ROUNDING * size)
}

fn compare_tables(a: &Results, b: &Results, unlike: &mut Unlike) -> Result<Vec<Row>, RunError> {
    let named = |results: &Results| -> BTreeMap<OsString, PathBuf> {
        let tables = results.tables().into_iter();
        tables
            .filter_map(|path| Some((path.file_name()?.to_owned(), path)))
            .collect()
    };
    let (a, b) = (named(a), named(b));
    let names = |tables: &BTreeMap<OsString, PathBuf>| {
        tables
            .keys()
            .map(|name| name.to_string_lossy().into_owned())
            .collect::<Vec<_>>()
    };
    note_missing("the folder", &names(&a), &names(&b), unlike);
    let mut rows = Vec::new();
    for (name, path) in &a {
        let Some(twin) = b.get(name) else { continue };
        let file = name.to_string_lossy();
        let (one, other) = (read_csv(path)?, read_csv(twin)?);
        if one.rows() != other.rows() {
            unlike.note(format!(
                "{file}: {} rows in the first, {} in the second",
                one.rows(),
                other.rows()
            ));
        }
        let matches = match (one.column("time"), other.column("time")) {
            (Some(a), Some(b)) => {
                let matches = matched(a, b);
                unlike.note_alone(&file, "row", &matches, [a, b]);
                matches
            }
            // Without times, rows are matched by number.
            _ => {
                unlike.skipped += one.rows().abs_diff(other.rows());
                let common = one.rows().min(other.rows());
                Matches {
                    pairs: (0..common).map(|k| (k, k)).collect(),
                    ..Matches::default()
                }
            }
        };
        let columns = |data: &pericles_io::CsvData| {
            data.columns
                .iter()
                .map(|column| column.name().to_owned())
                .collect::<Vec<_>>()
        };
        note_missing(&file, &columns(&one), &columns(&other), unlike);
        for (column, values) in one.columns.iter().zip(&one.values) {
            if let Some(twin) = other.column(column.name()) {
                let mut tally = Tally::new(&file, column.name());
                let pairs = &matches.pairs;
                let ours: Vec<f64> = pairs.iter().map(|(i, _)| values[*i]).collect();
                let theirs: Vec<f64> = pairs.iter().map(|(_, j)| twin[*j]).collect();
                tally.add(&ours, &theirs, |k| format!("row {}", pairs[k].0 + 1));
                rows.push(tally.row);
            }
        }
    }
    Ok(rows)
}

/// Reports names that only one of the two results has.
fn note_missing(place: &str, a: &[String], b: &[String], unlike: &mut Unlike) {
    for (have, lack, which) in [(a, b, "first"), (b, a, "second")] {
        for name in have.iter().filter(|name| !lack.contains(name)) {
            unlike.note(format!("{place}: only the {which} has {name}"));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_are_relative_to_the_largest_value() {
        let mut tally = Tally::new("fields", "Displacement");
        tally.add(&[1e-3, -2e-3, 0.0], &[1e-3, -2e-3, 4e-9], |k| {
            format!("{k}")
        });
        assert_eq!((tally.row.values, tally.row.different), (3, 1));
        assert!((tally.row.relative - 2e-6).abs() < 1e-18);
        assert_eq!((tally.row.absolute, tally.row.at.as_str()), (4e-9, "2"));
    }

    #[test]
    fn nan_and_infinity_differ_from_every_other_value() {
        let mut tally = Tally::new("a.csv", "x");
        let (nan, infinity) = (f64::NAN, f64::INFINITY);
        tally.add(
            &[nan, infinity, -infinity],
            &[nan, infinity, -infinity],
            |_| String::new(),
        );
        assert_eq!(tally.row.different, 0);
        tally.add(&[nan, infinity, 1.0], &[0.0, -infinity, nan], |_| {
            String::new()
        });
        assert_eq!(tally.row.different, 3);
        assert_eq!(tally.row.relative, f64::INFINITY);
    }
}
