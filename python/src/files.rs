//! Results in files, and the command line.

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

use numpy::ndarray::ArrayView2;
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pericles_io::{FieldData, read_csv, read_fields};
use pericles_run::diff::Comparison;
use pericles_run::{ExportFormat, Results, RunError, Selection, export, machine};
use pyo3::prelude::*;

use crate::arrays::{Block, TableColumn};
use crate::entry::waiting;
use crate::errors;

/// The fields of an output file.
#[pyclass(frozen, module = "pericles._pericles")]
pub struct OutputFile {
    fields: Vec<Column>,
    time: Option<f64>,
}

struct Column {
    name: String,
    components: usize,
    values: Arc<Vec<f64>>,
}

impl OutputFile {
    fn of(data: FieldData) -> Self {
        let points = Column {
            name: "Points".into(),
            components: 3,
            values: Arc::new(data.points),
        };
        let fields = data.fields.into_iter().map(|field| Column {
            name: field.name,
            components: field.components,
            values: Arc::new(field.values),
        });
        Self {
            time: data.time,
            fields: std::iter::once(points).chain(fields).collect(),
        }
    }
}

#[pymethods]
impl OutputFile {
    /// Reads a file.
    #[new]
    fn new(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let data = py.detach(|| read_fields(&path, machine::memory()));
        let data = data.map_err(|error| errors::of_run(RunError::from(error)))?;
        Ok(Self::of(data))
    }

    /// The time, s.
    #[getter]
    fn time(&self) -> Option<f64> {
        self.time
    }

    /// Names of the fields, "Points" first.
    fn names(&self) -> Vec<&str> {
        self.fields
            .iter()
            .map(|field| field.name.as_str())
            .collect()
    }

    /// A field as a read-only array of shape (points, components) that shares the values read.
    fn field<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let Some(field) = self.fields.iter().find(|field| field.name == name) else {
            return Ok(None);
        };
        let rows = field.values.len() / field.components.max(1);
        let array = ArrayView2::from_shape((rows, field.components), &field.values[..]);
        let array = array.map_err(|error| errors::plain(&error.to_string()))?;
        let owner = Bound::new(py, Block(Arc::clone(&field.values)))?.into_any();
        // SAFETY: the owner keeps the values alive, and nothing writes them.
        let array = unsafe { PyArray2::borrow_from_array(&array, owner) };
        array.readwrite().make_nonwriteable();
        Ok(Some(array))
    }
}

/// Reads a table: names, units and columns.
#[pyfunction]
pub fn read_table<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Vec<TableColumn<'py>>> {
    let data = py.detach(|| read_csv(&path)).map_err(errors::of_io)?;
    let columns = data.columns.iter().zip(data.values);
    Ok(columns
        .map(|(column, values)| {
            let array = PyArray1::from_vec(py, values);
            (column.name().to_owned(), column.unit().to_owned(), array)
        })
        .collect())
}

/// Compares two results; returns the comparison as JSON.
#[pyfunction]
pub fn compare(py: Python<'_>, a: PathBuf, b: PathBuf, tolerance: f64) -> PyResult<String> {
    waiting(py, move || {
        let made = || {
            let (a, b) = (Results::open(&a)?, Results::open(&b)?);
            let comparison = Comparison::of(&a, &b, tolerance)?;
            Ok::<_, RunError>(serde_json::to_string(&comparison)?)
        };
        made().map_err(errors::of_run)
    })
}

/// The words of the formats of exported fields, with the usual names of the files.
#[pyfunction]
pub fn export_formats() -> Vec<(&'static str, &'static str)> {
    let formats = ExportFormat::ALL.into_iter();
    formats.map(|one| (one.word(), one.file_name())).collect()
}

/// Writes the fields of a run in a format; returns what was left out, in sentences.
#[pyfunction]
pub fn export_fields(
    py: Python<'_>,
    folder: PathBuf,
    format: &str,
    path: PathBuf,
    every: Option<NonZeroUsize>,
    fields: Vec<String>,
) -> PyResult<Vec<String>> {
    let format = ExportFormat::ALL
        .into_iter()
        .find(|one| one.word() == format);
    let format = format.ok_or_else(|| errors::plain("there is no such format"))?;
    waiting(py, move || {
        let made = || {
            let results = Results::open(&folder)?;
            let selection = Selection {
                every,
                size: None,
                fields,
            };
            let exported = export(&results, format, &selection, &path)?;
            Ok::<_, RunError>(exported.notes)
        };
        made().map_err(errors::of_run)
    })
}

/// Runs the command line of the program and returns its exit status.
#[pyfunction]
pub fn command_line(py: Python<'_>, arguments: Vec<OsString>) -> PyResult<u8> {
    #[cfg(feature = "command-line")]
    return Ok(py.detach(|| pericles_cli::command(arguments)));
    #[cfg(not(feature = "command-line"))]
    {
        let _ = (py, arguments);
        Err(errors::plain(
            "this package was built without the command line",
        ))
    }
}
