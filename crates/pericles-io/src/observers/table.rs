//! Table written by an observer; after a resume it continues from its checkpoint.

use std::cell::RefCell;
use std::path::PathBuf;

use pericles::observe::Snapshot;
use pericles::{Archive, Checkpointed, PericlesError, Result, Values};

use crate::csv::{Cell, Column, CsvTable};
use crate::error::IoError;

/// Created at the first row of a new run; truncated and reopened by a restore.
pub(super) struct ObserverTable {
    path: PathBuf,
    columns: Vec<Column>,
    /// Name of the array in archives.
    key: &'static str,
    open: RefCell<Open>,
}

#[derive(Default)]
struct Open {
    table: Option<CsvTable>,
    /// Error that occurred while saving, which cannot report errors; returned with the next row.
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

    /// Appends and flushes the row of a snapshot, so that the table can be followed during the run; of several processes, one
    /// writes.
    pub(super) fn append(
        &self,
        snapshot: &Snapshot<'_>,
        cells: &[Cell],
    ) -> std::result::Result<(), IoError> {
        if !snapshot.is_written() {
            return Ok(());
        }
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

    /// Returns whether this process has written rows.
    pub(super) fn is_open(&self) -> bool {
        self.open.borrow().table.is_some()
    }

    /// Creates the file with its header if it does not exist, for tables that may have no rows.
    pub(super) fn touch(&self, snapshot: &Snapshot<'_>) -> std::result::Result<(), IoError> {
        if !snapshot.is_written() {
            return Ok(());
        }
        let open = &mut *self.open.borrow_mut();
        if open.table.is_none() {
            open.table = Some(CsvTable::create(&self.path, &self.columns)?);
        }
        Ok(())
    }
}

impl Checkpointed for ObserverTable {
    /// Records the length after syncing the rows to disk.
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

    /// Truncates the file to the recorded length.
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

/// Converts the error of a file that does not match the checkpoint.
pub(super) fn misfit(error: IoError) -> PericlesError {
    PericlesError::BadArchive {
        reason: error.to_string(),
    }
}

/// Returns the first columns of every table.
pub(super) fn step_and_time() -> Vec<Column> {
    vec![Column::integer("step"), Column::real("time", "s")]
}

/// Converts a count; counts in tables are far below the limit.
pub(super) fn whole(count: u64) -> Cell {
    Cell::Integer(i64::try_from(count).unwrap_or(i64::MAX))
}

/// Names of the axes.
pub(super) const AXES: [&str; 3] = ["x", "y", "z"];
