//! Results kept in memory.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use numpy::PyArray1;
use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::{Archive, Checkpointed};
use pericles_io::in_user_order;
use pericles_run::KeptTable;
use pyo3::prelude::*;

use crate::arrays::{TableColumn, view};
use crate::callback::{components, field_named, squeezed};
use crate::errors::plain;

/// The kept fields of a run, in the user's order of points.
#[derive(Default)]
pub struct Kept {
    dimension: usize,
    fields: Vec<Field>,
    frames: Vec<Frame>,
}

struct Frame {
    step: u64,
    time: f64,
    values: Vec<Arc<Vec<f64>>>,
}

/// Keeps fields.
pub struct FieldKeeper(pub Arc<Mutex<Kept>>);

fn locked<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Kept {
    /// Keeps fields of a body of the given dimension.
    pub fn new(fields: Vec<Field>, dimension: usize) -> Self {
        Self {
            fields,
            dimension,
            frames: Vec::new(),
        }
    }

    /// Bytes of one output of a body with `points` points.
    pub fn bytes(&self, points: usize) -> f64 {
        let fields = self.fields.iter();
        let numbers: usize = fields.map(|&field| components(field, self.dimension)).sum();
        8.0 * numbers as f64 * points as f64
    }
}

impl Observer for FieldKeeper {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ObserveError> {
        let kept = &mut *locked(&self.0);
        let (state, cloud) = (snapshot.state(), snapshot.system().cloud());
        // After a checkpoint was loaded, the later outputs of the earlier run do not count.
        kept.frames.retain(|frame| frame.step < state.step);
        let mut values = Vec::new();
        for &field in &kept.fields {
            snapshot.check(field)?;
            let ordered = in_user_order(cloud, snapshot.field(field)).into_owned();
            values.push(Arc::new(ordered));
        }
        kept.frames.push(Frame {
            step: state.step,
            time: state.t,
            values,
        });
        Ok(())
    }
}

/// Kept fields are results, not state.
impl Checkpointed for FieldKeeper {
    fn save(&self, _archive: &mut Archive) {}

    fn restore(&mut self, _archive: &Archive) -> pericles::Result<()> {
        Ok(())
    }
}

/// Results in memory.
#[pyclass(frozen, module = "pericles._pericles")]
pub struct Recording {
    pub kept: Arc<Mutex<Kept>>,
    pub tables: Vec<KeptTable>,
}

#[pymethods]
impl Recording {
    /// Times of the outputs, s.
    fn times(&self) -> Vec<f64> {
        locked(&self.kept)
            .frames
            .iter()
            .map(|frame| frame.time)
            .collect()
    }

    /// Steps of the outputs.
    fn steps(&self) -> Vec<u64> {
        locked(&self.kept)
            .frames
            .iter()
            .map(|frame| frame.step)
            .collect()
    }

    /// Names of the fields.
    fn names(&self) -> Vec<String> {
        let kept = locked(&self.kept);
        kept.fields
            .iter()
            .map(|field| field.name().to_lowercase())
            .collect()
    }

    /// A field of an output as a read-only view.
    fn field<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        output: usize,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let wanted = field_named(name)?;
        let kept = locked(&self.kept);
        let Some(place) = kept.fields.iter().position(|&field| field == wanted) else {
            return Ok(None);
        };
        let frame = kept
            .frames
            .get(output)
            .ok_or_else(|| plain("there is no such output"))?;
        let (values, count) = (
            Arc::clone(&frame.values[place]),
            components(wanted, kept.dimension),
        );
        drop(kept);
        squeezed(view(py, &values, count)?, name).map(Some)
    }

    /// Names of the tables.
    fn tables(&self) -> Vec<String> {
        self.tables.iter().map(|table| table.name.clone()).collect()
    }

    /// A table: names, units and columns.
    fn table<'py>(&self, py: Python<'py>, name: &str) -> Option<Vec<TableColumn<'py>>> {
        let table = self.tables.iter().find(|table| table.name == name)?;
        let rows = locked(&table.rows);
        let columns = rows.columns.iter().zip(&rows.values);
        let columns = columns.map(|(column, values)| {
            let array = PyArray1::from_slice(py, values);
            (column.name().to_owned(), column.unit().to_owned(), array)
        });
        Some(columns.collect())
    }
}
