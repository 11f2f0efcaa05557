//! `diff`: compare two results field by field and column by column.

use std::path::Path;

use pericles_io::IoError;
use pericles_run::Results;
use pericles_run::diff::{Comparison, Row};

use crate::args::DiffArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// Compares two folders.
///
/// # Errors
/// A folder has no results, or a file is damaged.
pub(crate) fn diff(args: &DiffArgs) -> Result<Exit, CliError> {
    let (a, b) = (Results::open(&args.a)?, Results::open(&args.b)?);
    let comparison = Comparison::of(&a, &b, args.tolerance)?;
    let json_only = args.json.as_deref() == Some(Path::new("-"));
    if let Some(path) = &args.json {
        console::write_json(path, &comparison)?;
    }
    if !json_only {
        print(&comparison)?;
    }
    Ok(if comparison.equal {
        Exit::Done
    } else {
        Exit::Comparison
    })
}

/// Prints the differences.
fn print(comparison: &Comparison) -> Result<(), IoError> {
    for unlike in &comparison.unlike {
        console::print(format_args!("{unlike}"))?;
    }
    let different: Vec<&Row> = comparison
        .rows
        .iter()
        .filter(|row| row.different > 0)
        .collect();
    let width = |text: fn(&Row) -> &str| {
        different
            .iter()
            .map(|row| text(row).len())
            .max()
            .unwrap_or(0)
    };
    let (places, names) = (width(|row| &row.place), width(|row| &row.name));
    for row in &different {
        let beyond = if row.relative > comparison.tolerance {
            "exceeds"
        } else {
            "within"
        };
        console::print(format_args!(
            "{:<places$}  {:<names$}  relative difference {:.1e}, absolute {:.1e}; {} of {} values differ; {} — {beyond} {:.0e}",
            row.place,
            row.name,
            row.relative,
            row.absolute,
            row.different,
            row.values,
            row.at,
            comparison.tolerance
        ))?;
    }
    let values: usize = comparison.rows.iter().map(|row| row.values).sum();
    let (fields, same) = (
        comparison.rows.len(),
        comparison.rows.len() - different.len(),
    );
    let verdict = match (comparison.equal, different.is_empty()) {
        (true, true) => "bitwise identical",
        (true, false) => "equal within the tolerance",
        (false, _) => "different",
    };
    let skipped = match comparison.skipped {
        0 => String::new(),
        1 => "; 1 state or row was not compared".into(),
        skipped => format!("; {skipped} states and rows were not compared"),
    };
    console::print(format_args!(
        "{verdict}: {same} of {fields} fields and columns are identical; {values} values compared{skipped}"
    ))
}
