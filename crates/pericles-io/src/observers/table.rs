//! Table of an observer, in a file or in memory. A file continues from its checkpoint after a resume.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use pericles::observe::Snapshot;
use pericles::{Archive, Checkpointed, PericlesError, Result, Values};

use crate::csv::{Cell, Column, CsvData, CsvTable};
use crate::error::IoError;

/// Where the rows of a table go.
#[derive(Debug, Clone)]
pub enum TableTarget {
    /// A CSV file, which is created at the first row.
    File(PathBuf),
    /// Memory, for programs that read the rows. Checkpoints do not contain them: a restored run drops the rows of its later
    /// steps.
    Memory(Arc<Mutex<CsvData>>),
}

impl From<PathBuf> for TableTarget {
    fn from(path: PathBuf) -> Self {
        Self::File(path)
    }
}

impl From<&PathBuf> for TableTarget {
    fn from(path: &PathBuf) -> Self {
        Self::File(path.clone())
    }
}

impl From<&Path> for TableTarget {
    fn from(path: &Path) -> Self {
        Self::File(path.to_path_buf())
    }
}

/// A file is created at the first row of a new run; truncated and reopened by a restore.
pub(super) struct ObserverTable {
    target: TableTarget,
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
    /// Whether a restore is followed by the next row; rows in memory from its step on are dropped.
    is_restored: bool,
}

impl ObserverTable {
    pub(super) fn new(target: TableTarget, key: &'static str, columns: Vec<Column>) -> Self {
        if let TableTarget::Memory(data) = &target {
            let mut data = data.lock().unwrap_or_else(PoisonError::into_inner);
            data.values = vec![Vec::new(); columns.len()];
            data.columns.clone_from(&columns);
        }
        Self {
            target,
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
        let path = match &self.target {
            TableTarget::File(path) => path,
            TableTarget::Memory(data) => {
                let mut data = data.lock().unwrap_or_else(PoisonError::into_inner);
                let is_restored = std::mem::take(&mut self.open.borrow_mut().is_restored);
                let first = is_restored.then_some(snapshot.state().step);
                keep(&mut data, first, cells);
                return Ok(());
            }
        };
        let open = &mut *self.open.borrow_mut();
        if let Some(trouble) = open.trouble.take() {
            return Err(trouble);
        }
        let table = match &mut open.table {
            Some(table) => table,
            none => none.insert(CsvTable::create(path, &self.columns)?),
        };
        table.append(cells)?;
        table.flush()
    }

    /// Returns the file, if this process has written rows to one.
    pub(super) fn written(&self) -> Option<&Path> {
        match &self.target {
            TableTarget::File(path) if self.open.borrow().table.is_some() => Some(path),
            _ => None,
        }
    }

    /// Creates the file with its header if it does not exist, for tables that may have no rows.
    pub(super) fn touch(&self, snapshot: &Snapshot<'_>) -> std::result::Result<(), IoError> {
        let TableTarget::File(path) = &self.target else {
            return Ok(());
        };
        if !snapshot.is_written() {
            return Ok(());
        }
        let open = &mut *self.open.borrow_mut();
        if open.table.is_none() {
            open.table = Some(CsvTable::create(path, &self.columns)?);
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
            target,
            columns: _,
        } = self;
        if let TableTarget::Memory(_) = target {
            return;
        }
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
        let TableTarget::File(path) = &self.target else {
            self.open.borrow_mut().is_restored = true;
            return Ok(());
        };
        let mut length = 0;
        archive.u64_into(self.key, std::slice::from_mut(&mut length))?;
        let table = (length > 0)
            .then(|| CsvTable::reopen(path, &self.columns, length))
            .transpose()
            .map_err(misfit)?;
        self.open = RefCell::new(Open {
            table,
            ..Open::default()
        });
        Ok(())
    }
}

/// Appends a row to a table in memory; rows from `first` on are dropped before.
fn keep(data: &mut CsvData, first: Option<u64>, cells: &[Cell]) {
    let steps = &data.values[0];
    let kept = match first {
        Some(first) => steps.partition_point(|&step| step < first as f64),
        None => steps.len(),
    };
    for (column, cell) in data.values.iter_mut().zip(cells) {
        column.truncate(kept);
        column.push(match *cell {
            Cell::Real(value) => value,
            Cell::Integer(value) => value as f64,
        });
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
