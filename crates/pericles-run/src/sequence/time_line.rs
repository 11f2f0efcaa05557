//! The results of several steps on one time line.

use std::collections::BTreeSet;
use std::path::Path;

use pericles_io::{Cell, Column, CsvData, CsvTable, PvdSeries, read_csv};
use serde_json::{Value, json};

use crate::error::RunError;
use crate::json::write_json;
use crate::results::{Results, file_name};

const TIME: &str = "time";
const STEP: &str = "step";

/// Columns that add up over the steps; the energy dissipated by the body is handed over with its state.
const TOTALS: [&str; 2] = ["external_work", "balance"];

/// Returns the names of all files that are written, and of the record of the steps.
pub(super) fn names(record: &str) -> Vec<String> {
    [record, "run.json", "fields.pvd", "*.csv"]
        .map(String::from)
        .to_vec()
}

/// A step that has results.
struct Done<'a> {
    name: &'a str,
    results: Results,
    /// Time and number of time steps before it.
    time: f64,
    steps: u64,
}

/// Writes tables, the series of fields and `run.json` of all steps so far.
///
/// # Errors
/// Results cannot be read or written.
pub(super) fn write_time_line<'a>(
    folder: &Path,
    names: impl Iterator<Item = &'a str>,
) -> Result<(), RunError> {
    let names: Vec<&str> = names.collect();
    let (mut time, mut steps) = (0.0, 0);
    let mut done = Vec::new();
    for &name in &names {
        let Ok(results) = Results::open(&folder.join(name)) else {
            break;
        };
        let lasted = results.number("/progress/t").unwrap_or(0.0);
        let taken = results.count("/progress/last_step");
        done.push(Done {
            name,
            results,
            time,
            steps,
        });
        time += lasted;
        steps += taken;
    }
    let Some(last) = done.last() else {
        return Ok(());
    };
    let tables = done.iter().flat_map(|step| step.results.tables());
    let tables: BTreeSet<String> = tables.map(|path| file_name(&path)).collect();
    for table in &tables {
        write_table(folder, table, &done)?;
    }
    write_series(folder, &done)?;
    write_report(folder, &names, &done, last)
}

/// Writes a table of all steps that have it; a cell is empty in steps without its column.
fn write_table(folder: &Path, name: &str, done: &[Done<'_>]) -> Result<(), RunError> {
    let mut parts: Vec<(&Done<'_>, CsvData)> = Vec::new();
    for step in done {
        let path = step.results.folder().join(name);
        if path.is_file() {
            parts.push((step, read_csv(path)?));
        }
    }
    let mut columns: Vec<&Column> = Vec::new();
    for column in parts.iter().flat_map(|(_, part)| &part.columns) {
        if !columns.iter().any(|known| known.name() == column.name()) {
            columns.push(column);
        }
    }
    // Tables of other kinds, such as profiles, belong to one step.
    if !columns.iter().any(|column| column.name() == TIME) {
        return Ok(());
    }
    let mut rows: Vec<Vec<f64>> = vec![Vec::new(); columns.len()];
    for (column, values) in columns.iter().zip(&mut rows) {
        let mut total = 0.0;
        for (step, part) in &parts {
            let skipped = repeated_rows(step, part);
            let place = (part.columns.iter()).position(|own| own.name() == column.name());
            let own = place.map(|place| &part.values[place]);
            let offset = match column.name() {
                TIME => step.time,
                STEP => step.steps as f64,
                name if TOTALS.contains(&name) => total,
                _ => 0.0,
            };
            match own {
                Some(own) => {
                    values.extend(own[skipped..].iter().map(|value| value + offset));
                    total += own.last().copied().unwrap_or(0.0);
                }
                None => values.extend(std::iter::repeat_n(f64::NAN, part.rows() - skipped)),
            }
        }
    }
    let is_whole = |value: &f64| value.fract() == 0.0 && value.abs() < 1e15;
    let integers: Vec<bool> = (columns.iter().zip(&rows))
        .map(|(column, values)| column.unit().is_empty() && values.iter().all(is_whole))
        .collect();
    let headers: Vec<Column> = (columns.iter().zip(&integers))
        .map(|(column, integer)| match integer {
            true => Column::integer(column.name()),
            false => Column::real(column.name(), column.unit()),
        })
        .collect();
    let mut table = CsvTable::create(folder.join(name), &headers)?;
    for row in 0..rows.first().map_or(0, Vec::len) {
        let cells: Vec<Cell> = (rows.iter().zip(&integers))
            .map(|(values, integer)| match integer {
                true => Cell::Integer(values[row] as i64),
                false => Cell::Real(values[row]),
            })
            .collect();
        table.append(&cells)?;
    }
    Ok(table.flush()?)
}

/// Returns the number of rows at the start of a step, which repeat the last state of the step before.
fn repeated_rows(step: &Done<'_>, part: &CsvData) -> usize {
    let times = part.column(TIME).unwrap_or_default();
    let at_start = times.iter().take_while(|time| **time == 0.0).count();
    match step.steps > 0 && at_start < times.len() {
        true => at_start,
        false => 0,
    }
}

/// Writes the series of the fields of all steps.
fn write_series(folder: &Path, done: &[Done<'_>]) -> Result<(), RunError> {
    let mut series: Option<PvdSeries> = None;
    for step in done {
        let files = step.results.folder().join("fields.pvd");
        if !files.is_file() {
            continue;
        }
        let states = PvdSeries::read(files)?;
        let series = match &mut series {
            Some(series) => series,
            None => series.insert(PvdSeries::create(folder.join("fields.pvd"))?),
        };
        let skipped = usize::from(!series.is_empty() && states.len() > 1);
        for (time, file) in &states[skipped..] {
            series.push(
                step.time + time,
                &format!("{}/{}", step.name, file.display()),
            )?;
        }
    }
    Ok(())
}

/// Writes the report of the last step, with the list of all steps.
fn write_report(
    folder: &Path,
    names: &[&str],
    done: &[Done<'_>],
    last: &Done<'_>,
) -> Result<(), RunError> {
    let list: Vec<Value> = (names.iter().enumerate())
        .map(|(k, name)| {
            let step = done.get(k);
            let value = |pointer: &str| step.and_then(|step| step.results.value(pointer)).cloned();
            json!({
                "name": name,
                "status": value("/status"),
                "start": step.map(|step| step.time),
                "duration": value("/progress/t"),
                "scheme": value("/model/scheme"),
                "balance": value("/audit/balance"),
            })
        })
        .collect();
    let mut report = last.results.value("").cloned().unwrap_or_default();
    report["steps"] = list.into();
    let time = last.results.number("/progress/t").unwrap_or(0.0);
    report["progress"]["t"] = json!(last.time + time);
    report["progress"]["last_step"] = json!(last.steps + last.results.count("/progress/last_step"));
    report["model"]["steps"] = json!(last.steps + last.results.count("/model/steps"));
    let mut schemes: Vec<&str> = (done.iter())
        .map(|step| step.results.text("/model/scheme"))
        .collect();
    schemes.dedup();
    report["model"]["scheme"] = schemes.join(", ").into();
    if done.len() < names.len() && report["status"] == "finished" {
        report["status"] = "stopped".into();
    }
    write_json(&folder.join("run.json"), &report)
}
