//! The fields that a run has written, in any of its formats.

use std::path::PathBuf;
use std::sync::Arc;

use pericles::observe::{Field, FieldKind};
use pericles_deck::{FieldFormat, Model, Precision};
use pericles_io::observers::{FieldSelection, RecordedFields, ResultFile, ResultFormat};
use pericles_io::{FieldColumn, FieldData, ResultBody};
use pericles_mesh::results::FieldSpec;

use crate::error::RunError;
use crate::results::{FieldFile, Results};

use super::Selection;

/// Number of components of vectors, whatever the dimension of the body is.
const VECTOR: usize = 3;

/// The outputs of the fields of a run.
pub(super) enum RunFields {
    /// A VTU file per output.
    Series {
        states: Vec<FieldFile>,
        first: FieldData,
        points: usize,
    },
    /// One file of all outputs.
    File {
        fields: RecordedFields,
        points: usize,
    },
}

impl RunFields {
    /// Opens the fields of a run; `None` if there are none.
    pub(super) fn open(
        results: &Results,
        model: &Model,
        body: &Arc<ResultBody>,
        selection: FieldSelection,
    ) -> Result<Option<Self>, RunError> {
        let points = body.volumes.len();
        let states = results.fields()?;
        if let Some(first) = states.first() {
            let mut first = first.read()?;
            // The components of a tensor are also there as scalars, which every format can keep.
            first.fields.retain(|field| field.components <= VECTOR);
            if first.points.len() != 3 * points {
                let reason = format!(
                    "it has {} points, but the body of the deck has {points}",
                    first.points.len() / 3,
                );
                return Err(results.damaged("fields.pvd", reason));
            }
            return Ok(Some(Self::Series {
                states,
                first,
                points,
            }));
        }
        let Some((path, format)) = one_file(results, model) else {
            return Ok(None);
        };
        let single = model.output.precision == Precision::Single;
        let file = ResultFile::new(path, format, Arc::clone(body), selection, single);
        let fields = file.recorded()?;
        Ok(Some(Self::File { fields, points }))
    }

    /// Returns the number of outputs.
    pub(super) fn outputs(&self) -> usize {
        match self {
            Self::Series { states, .. } => states.len(),
            Self::File { fields, .. } => fields.len(),
        }
    }

    /// Returns the fields; vectors have three components.
    pub(super) fn specs(&self) -> Vec<FieldSpec> {
        match self {
            Self::Series { first, .. } => {
                let spec = |field: &FieldColumn| FieldSpec::new(&field.name, field.components);
                first.fields.iter().map(spec).collect()
            }
            Self::File { fields, .. } => {
                let spec = |field: &FieldSpec| match is_vector(field) {
                    true => FieldSpec::new(&field.name, VECTOR),
                    false => field.clone(),
                };
                fields.specs().iter().map(spec).collect()
            }
        }
    }

    /// Returns the time of an output, s.
    pub(super) fn time(&mut self, output: usize) -> Result<f64, RunError> {
        match self {
            Self::Series { states, .. } => Ok(states[output].time),
            Self::File { .. } => Ok(self.read(output)?.0),
        }
    }

    /// Reads the time of an output, s, and its fields, component-major.
    pub(super) fn read(&mut self, output: usize) -> Result<(f64, Vec<Vec<f64>>), RunError> {
        match self {
            Self::Series {
                states,
                first,
                points,
            } => {
                let state = &states[output];
                let data = state.read()?;
                let fields = first.fields.iter();
                let values = fields.map(|field| component_major(state, &data, field, *points));
                Ok((state.time, values.collect::<Result<_, _>>()?))
            }
            Self::File { fields, points } => {
                let (time, mut all) = fields.read(output)?;
                for (values, field) in all.iter_mut().zip(fields.specs()) {
                    if is_vector(field) {
                        values.resize(VECTOR * *points, 0.0);
                    }
                }
                Ok((time, all))
            }
        }
    }
}

/// Selected outputs and fields of a run.
pub(super) struct SelectedFields {
    fields: RunFields,
    /// Numbers of the outputs.
    outputs: Vec<usize>,
    /// Numbers of the fields.
    columns: Vec<usize>,
    specs: Vec<FieldSpec>,
}

impl SelectedFields {
    /// Selects outputs and fields.
    ///
    /// # Errors
    /// The run has not written a selected field.
    pub(super) fn new(fields: RunFields, selection: &Selection) -> Result<Self, RunError> {
        let specs = fields.specs();
        let mut columns: Vec<usize> = Vec::new();
        for name in &selection.fields {
            let found = (0..specs.len()).filter(|&k| is_named(&specs[k].name, name));
            let found: Vec<usize> = found.collect();
            if found.is_empty() {
                let names: Vec<&str> = specs.iter().map(|spec| spec.name.as_str()).collect();
                let listing = format!("the run wrote the fields {}", names.join(", "));
                return Err(RunError::unknown("field", name, &names, &listing));
            }
            columns.extend(found);
        }
        if selection.fields.is_empty() {
            columns = (0..specs.len()).collect();
        }
        columns.sort_unstable();
        columns.dedup();
        let mut selected = Self {
            outputs: (0..fields.outputs()).collect(),
            specs: columns.iter().map(|&k| specs[k].clone()).collect(),
            columns,
            fields,
        };
        if let Some(every) = selection.every {
            selected.keep_every(every.get());
        }
        Ok(selected)
    }

    /// Adds a field, if the run has written it.
    pub(super) fn add(&mut self, name: &str) {
        let specs = self.fields.specs();
        let found = specs.iter().position(|spec| spec.name == name);
        if let Some(k) = found.filter(|k| !self.columns.contains(k)) {
            self.columns.push(k);
            self.specs.push(specs[k].clone());
        }
    }

    /// Keeps every n-th of the outputs, and the last one.
    pub(super) fn keep_every(&mut self, n: usize) {
        let last = self.outputs.len().saturating_sub(1);
        let kept = self.outputs.iter().enumerate();
        let kept = kept.filter(|(k, _)| k % n.max(1) == 0 || *k == last);
        self.outputs = kept.map(|(_, output)| *output).collect();
    }

    /// Returns the number of selected outputs.
    pub(super) fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// Returns the number of outputs of the run.
    pub(super) fn all_outputs(&self) -> usize {
        self.fields.outputs()
    }

    /// Returns the selected fields; vectors have three components.
    pub(super) fn specs(&self) -> Vec<FieldSpec> {
        self.specs.clone()
    }

    /// Returns the time of a selected output, s.
    pub(super) fn time(&mut self, output: usize) -> Result<f64, RunError> {
        self.fields.time(self.outputs[output])
    }

    /// Reads the time of a selected output, s, and the selected fields, component-major.
    pub(super) fn read(&mut self, output: usize) -> Result<(f64, Vec<Vec<f64>>), RunError> {
        let (time, mut all) = self.fields.read(self.outputs[output])?;
        let values = self.columns.iter().map(|&k| std::mem::take(&mut all[k]));
        Ok((time, values.collect()))
    }
}

/// Returns whether an array of a file has a name, or is a component of the tensor of this name; capitals do not matter.
fn is_named(array: &str, name: &str) -> bool {
    let (array, name) = (array.to_lowercase(), name.to_lowercase());
    let mut tensors = Field::ALL
        .into_iter()
        .filter(|field| field.kind() == FieldKind::Tensor);
    array == name
        || tensors.any(|tensor| {
            let part = array.strip_prefix(&name);
            let part = part.and_then(|end| end.strip_prefix('_'));
            tensor.name().to_lowercase() == name
                && part.is_some_and(|part| (1..=3).any(|d| tensor.components(d).contains(&part)))
        })
}

/// Returns whether the components of a field form a vector.
fn is_vector(spec: &FieldSpec) -> bool {
    let mut fields = Field::ALL.into_iter();
    let field = fields.find(|field| field.name() == spec.name);
    field.is_some_and(|field| matches!(field.kind(), FieldKind::Vector | FieldKind::List))
}

/// Returns the values of a field in a state, as many as in the first one.
fn component_major(
    state: &FieldFile,
    data: &FieldData,
    field: &FieldColumn,
    n: usize,
) -> Result<Vec<f64>, RunError> {
    let found = data.field(&field.name);
    let found = found.filter(|found| found.values.len() == field.values.len());
    let found = found.ok_or_else(|| RunError::Damaged {
        path: state.path.clone(),
        reason: format!("the field {} on {n} points is missing", field.name),
    })?;
    let components = field.components;
    let mut values = vec![0.0; found.values.len()];
    for (k, &value) in found.values.iter().enumerate() {
        values[k % components * n + k / components] = value;
    }
    Ok(values)
}

/// Returns the file that holds all outputs of a run, with its format.
fn one_file(results: &Results, model: &Model) -> Option<(PathBuf, ResultFormat)> {
    let mut formats = model.output.fields.formats.iter();
    formats.find_map(|format| {
        let (name, format) = match format {
            FieldFormat::Vtu => return None,
            FieldFormat::Exodus => ("fields.exo", ResultFormat::Exodus),
            FieldFormat::Vtkhdf => {
                let dt = results.number("/model/dt")?;
                let outputs = model
                    .output
                    .fields
                    .schedule
                    .most(dt, results.count("/model/steps"));
                let outputs = outputs as usize;
                ("fields.vtkhdf", ResultFormat::VtkHdf { outputs })
            }
        };
        let path = results.folder().join(name);
        path.exists().then_some((path, format))
    })
}
