//! A table that an observer fills, and that goes on after a resume where its checkpoint was written.

use std::cell::RefCell;
use std::path::PathBuf;

use pericles::{Archive, PericlesError, Result, Saved, Values};

use crate::csv::{Cell, Column, CsvTable};
use crate::error::IoError;

/// Created at the first row of a fresh run, cut back and reopened by a restore.
pub(super) struct ObserverTable {
    path: PathBuf,
    columns: Vec<Column>,
    /// The array's name in archives.
    key: &'static str,
    open: RefCell<Open>,
}

#[derive(Default)]
struct Open {
    table: Option<CsvTable>,
    /// Trouble met while saving, which has no way to report it: told at the next row.
    trouble: Option<IoError>,
}

impl ObserverTable {
    pub(super) fn new(path: PathBuf, key: &'static str, columns: Vec<Column>) -> Self {
        Self {
            path,
            columns,
            key,
            open: RefCell::default(),
        }
    }

    /// Adds columns to a table that has no rows yet.
    pub(super) fn add_columns(&mut self, columns: Vec<Column>) {
        self.columns.extend(columns);
    }

    /// Adds a row and hands it to the system, so that a table can be followed while the run goes on.
    pub(super) fn append(&self, cells: &[Cell]) -> std::result::Result<(), IoError> {
        let open = &mut *self.open.borrow_mut();
        if let Some(trouble) = open.trouble.take() {
            return Err(trouble);
        }
        let table = match &mut open.table {
            Some(table) => table,
            none => none.insert(CsvTable::create(&self.path, &self.columns)?),
        };
        table.append(cells)?;
        table.flush()
    }

    /// Creates the file with its header if it is not there yet, for tables that may stay without rows.
    pub(super) fn touch(&self) -> std::result::Result<(), IoError> {
        let open = &mut *self.open.borrow_mut();
        if open.table.is_none() {
            open.table = Some(CsvTable::create(&self.path, &self.columns)?);
        }
        Ok(())
    }
}

impl Saved for ObserverTable {
    /// Notes the length; the rows are on the disk when the checkpoint that remembers it is.
    fn save(&self, archive: &mut Archive) {
        let Self {
            open,
            key,
            path: _,
            columns: _,
        } = self;
        let open = &mut *open.borrow_mut();
        let length = open.table.as_mut().map_or(0, |table| {
            if let Err(error) = table.sync() {
                open.trouble = Some(error);
            }
            table.len_bytes()
        });
        archive.put(*key, Values::U64(vec![length]));
    }

    /// Cuts the file back to the noted length.
    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut length = 0;
        archive.u64_into(self.key, std::slice::from_mut(&mut length))?;
        let table = (length > 0)
            .then(|| CsvTable::reopen(&self.path, &self.columns, length))
            .transpose()
            .map_err(misfit)?;
        self.open = RefCell::new(Open {
            table,
            trouble: None,
        });
        Ok(())
    }
}

/// A file that does not go with the checkpoint, as the library reports it.
pub(super) fn misfit(error: IoError) -> PericlesError {
    PericlesError::BadArchive {
        reason: error.to_string(),
    }
}

/// The columns every table begins with.
pub(super) fn step_and_time() -> Vec<Column> {
    vec![Column::integer("step"), Column::real("time", "s")]
}

/// Counts in tables are far below the limit.
pub(super) fn whole(count: u64) -> Cell {
    Cell::Integer(i64::try_from(count).unwrap_or(i64::MAX))
}

/// Names of the axes.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];
