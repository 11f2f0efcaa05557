//! Results kept in memory.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use numpy::PyArray1;
use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::{Archive, Checkpointed};
use pericles_io::observers::HistoryRows;
use pericles_io::{Cell, in_user_order};
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

/// The rows of the history of a run.
pub struct Course {
    rows: HistoryRows,
    values: Vec<Vec<f64>>,
}

/// Keeps fields.
pub struct FieldKeeper(pub Arc<Mutex<Kept>>);

/// Keeps the history.
pub struct HistoryKeeper(pub Arc<Mutex<Course>>);

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

impl Course {
    /// Keeps rows.
    pub fn new(rows: HistoryRows) -> Self {
        Self {
            values: vec![Vec::new(); rows.columns().len()],
            rows,
        }
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

impl Observer for HistoryKeeper {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> Result<(), ObserveError> {
        let course = &mut *locked(&self.0);
        let step = snapshot.state().step as f64;
        let before = course.values[0].partition_point(|&earlier| earlier < step);
        for (column, cell) in course.values.iter_mut().zip(course.rows.row(snapshot)?) {
            column.truncate(before);
            column.push(match cell {
                Cell::Real(value) => value,
                Cell::Integer(value) => value as f64,
            });
        }
        Ok(())
    }
}

impl Checkpointed for HistoryKeeper {
    fn save(&self, archive: &mut Archive) {
        locked(&self.0).rows.save(archive);
    }

    fn restore(&mut self, archive: &Archive) -> pericles::Result<()> {
        locked(&self.0).rows.restore(archive)
    }
}

/// Results in memory.
#[pyclass(frozen, module = "pericles._pericles")]
pub struct Recording {
    pub kept: Arc<Mutex<Kept>>,
    pub course: Option<Arc<Mutex<Course>>>,
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

    /// The history: names, units and columns.
    fn history<'py>(&self, py: Python<'py>) -> Vec<TableColumn<'py>> {
        let Some(course) = &self.course else {
            return Vec::new();
        };
        let course = locked(course);
        let columns = course.rows.columns().iter().zip(&course.values);
        columns
            .map(|(column, values)| {
                let array = PyArray1::from_slice(py, values);
                (column.name().to_owned(), column.unit().to_owned(), array)
            })
            .collect()
    }
}
