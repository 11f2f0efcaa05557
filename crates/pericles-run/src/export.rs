//! Export of the fields of a run to other formats.

use std::fs;
use std::path::Path;

use pericles_io::write_error;
use pericles_io::{Column, CsvTable, FieldColumn, FieldData, IoError, NpzWriter, ResultBody};
use pericles_mesh::results::{
    ExodusLayout, ExodusWriter, FieldSpec, VtkHdfLayout, VtkHdfWriter, WriteError,
};

use crate::build::{Resources, discretise};
use crate::error::RunError;
use crate::observers::result_body;
use crate::results::{FieldFile, Results};
use crate::{machine, readers};

/// A format of exported fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportFormat {
    /// One Exodus II file.
    Exodus,
    /// One VTKHDF file.
    VtkHdf,
    /// A folder with a table per output time, `fields_000000.csv`, ..., with a row per point.
    Csv,
    /// A NumPy archive: `time` (outputs), `position` (points × dimension), `volume` (points), and each field
    /// (outputs × points, vectors × 3).
    Npz,
}

/// Writes all fields of a run to a new file or folder, in the user's order of points; returns the number of output
/// times.
///
/// # Errors
/// The run has no field files, the points cannot be built from its deck, or files cannot be read or written.
pub fn export(results: &Results, format: ExportFormat, path: &Path) -> Result<usize, RunError> {
    let states = results.fields()?;
    let Some(first) = states.first() else {
        return Err(results.damaged("fields.pvd", "the run wrote no field files".into()));
    };
    let source = results.source()?.read()?;
    let resources = Resources {
        folder: source.folder(),
        memory: machine::memory(),
        ..readers()
    };
    let points = discretise(source.model(), &resources);
    let points = points.map_err(|error| source.refusal(error))?;
    let mesh = points.mesh.as_deref();
    let body = result_body(source.model(), &points.cloud, &points.sets, mesh);
    let mut first = first.read()?;
    // The components of a tensor are also there as scalars, which every format can keep.
    first.fields.retain(|field| field.components <= 3);
    if first.points.len() != 3 * body.volumes.len() {
        let reason = format!(
            "it has {} points, but the body of the deck has {}",
            first.points.len() / 3,
            body.volumes.len()
        );
        return Err(results.damaged("fields.pvd", reason));
    }
    let outputs = Outputs {
        states: &states,
        first: &first,
        body: &body,
        path,
    };
    match format {
        ExportFormat::Exodus => outputs.exodus(),
        ExportFormat::VtkHdf => outputs.vtkhdf(),
        ExportFormat::Csv => outputs.csv(),
        ExportFormat::Npz => outputs.npz(),
    }?;
    Ok(states.len())
}

struct Outputs<'a> {
    states: &'a [FieldFile],
    first: &'a FieldData,
    body: &'a ResultBody,
    path: &'a Path,
}

impl Outputs<'_> {
    fn specs(&self) -> Vec<FieldSpec> {
        let fields = self.first.fields.iter();
        let spec = |field: &FieldColumn| FieldSpec::new(&field.name, field.components);
        fields.map(spec).collect()
    }

    /// Returns the fields of a state, component-major, in the order of the first one.
    fn values(&self, state: &FieldFile) -> Result<Vec<Vec<f64>>, RunError> {
        let data = state.read()?;
        let n = self.body.volumes.len();
        let one = |field: &FieldColumn| {
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
        };
        self.first.fields.iter().map(one).collect()
    }

    fn written<T>(&self, result: Result<T, WriteError>) -> Result<T, IoError> {
        result.map_err(|error| write_error(self.path, error))
    }

    fn exodus(&self) -> Result<(), RunError> {
        let body = self.body;
        let layout = ExodusLayout {
            title: body.title.clone(),
            dimension: body.dimension,
            positions: &body.positions,
            volumes: &body.volumes,
            blocks: body.blocks.clone(),
            sets: body.sets.clone(),
            globals: Vec::new(),
            fields: self.specs(),
            is_single: false,
        };
        let mut writer = self.written(ExodusWriter::create(self.path, &layout))?;
        for state in self.states {
            let values = self.values(state)?;
            let values: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
            self.written(writer.append(state.time, &[], &values))?;
        }
        Ok(())
    }

    fn vtkhdf(&self) -> Result<(), RunError> {
        let layout = VtkHdfLayout {
            dimension: self.body.dimension,
            positions: &self.body.positions,
            fields: self.specs(),
            constants: vec![(FieldSpec::new("Volume", 1), &self.body.volumes)],
            outputs: self.states.len(),
            is_single: false,
        };
        let mut writer = self.written(VtkHdfWriter::create(self.path, &layout))?;
        for state in self.states {
            let values = self.values(state)?;
            let values: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
            self.written(writer.append(state.time, &values))?;
        }
        Ok(())
    }

    fn csv(&self) -> Result<(), RunError> {
        let made = fs::create_dir(self.path);
        made.map_err(|error| IoError::writing(self.path, error))?;
        let axes = ["x", "y", "z"];
        let dimension = self.body.dimension;
        let mut columns: Vec<Column> = axes[..dimension]
            .iter()
            .map(|axis| Column::real(*axis, "m"))
            .collect();
        columns.push(Column::real("volume", "m3"));
        for field in &self.first.fields {
            match field.components {
                1 => columns.push(Column::real(&field.name, "")),
                several => columns.extend((0..several).map(|c| {
                    let part = axes
                        .get(c)
                        .map_or_else(|| c.to_string(), |axis| (*axis).into());
                    Column::real(format!("{}_{part}", field.name), "")
                })),
            }
        }
        let n = self.body.volumes.len();
        for (number, state) in self.states.iter().enumerate() {
            let path = self.path.join(format!("fields_{number:06}.csv"));
            let mut table = CsvTable::create(&path, &columns)?;
            let values = self.values(state)?;
            let positions = self.body.positions.chunks(n);
            let fields = values.iter().flat_map(|values| values.chunks(n));
            let arrays: Vec<&[f64]> = positions
                .chain([self.body.volumes.as_slice()])
                .chain(fields)
                .collect();
            for i in 0..n {
                let row: Vec<_> = arrays.iter().map(|array| array[i].into()).collect();
                table.append(&row)?;
            }
            table.flush()?;
        }
        Ok(())
    }

    fn npz(&self) -> Result<(), RunError> {
        let (n, outputs) = (self.body.volumes.len(), self.states.len());
        let dimension = self.body.dimension;
        let mut archive = NpzWriter::create(self.path)?;
        archive.begin("time", &[outputs])?;
        let times: Vec<f64> = self.states.iter().map(|state| state.time).collect();
        archive.write(&times)?;
        archive.begin("position", &[n, dimension])?;
        let position = |k: usize| self.body.positions[k % dimension * n + k / dimension];
        let positions: Vec<f64> = (0..n * dimension).map(position).collect();
        archive.write(&positions)?;
        archive.begin("volume", &[n])?;
        archive.write(&self.body.volumes)?;
        // Field by field, because an array over all outputs may not fit into memory.
        for field in &self.first.fields {
            match field.components {
                1 => archive.begin(&field.name, &[outputs, n])?,
                several => archive.begin(&field.name, &[outputs, n, several])?,
            }
            for state in self.states {
                let data = state.read()?;
                let found = data.field(&field.name);
                let found = found.filter(|found| found.values.len() == field.values.len());
                let Some(found) = found else {
                    return Err(RunError::Damaged {
                        path: state.path.clone(),
                        reason: format!("the field {} is missing", field.name),
                    });
                };
                archive.write(&found.values)?;
            }
        }
        Ok(archive.finish()?)
    }
}
