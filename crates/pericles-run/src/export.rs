//! Export of the fields of a run to other formats.

mod contents;
mod page;
mod run_fields;

use std::fs;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;

use pericles_io::write_error;
use pericles_io::{Column, CsvTable, IoError, NpzWriter, ResultBody};
use pericles_mesh::results::{ExodusWriter, FieldSpec, VtkHdfWriter, WriteError};

use crate::build::{Resources, discretise};
use crate::error::RunError;
use crate::observers::{field_selection, result_body};
use crate::results::Results;
use crate::{machine, readers};

use self::run_fields::{RunFields, SelectedFields};

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
    /// A stand-alone page for browsers, which shows the fields over time; their values are rounded to 16 bits.
    Html,
}

impl ExportFormat {
    /// All formats.
    pub const ALL: [Self; 5] = [Self::Exodus, Self::VtkHdf, Self::Csv, Self::Npz, Self::Html];

    /// Returns the word that selects the format.
    pub fn word(self) -> &'static str {
        match self {
            Self::Exodus => "exodus",
            Self::VtkHdf => "vtkhdf",
            Self::Csv => "csv",
            Self::Npz => "npz",
            Self::Html => "html",
        }
    }

    /// Returns the usual name of the exported file or folder.
    pub fn file_name(self) -> &'static str {
        match self {
            Self::Exodus => "fields.exo",
            Self::VtkHdf => "fields.vtkhdf",
            Self::Csv => "fields-csv",
            Self::Npz => "fields.npz",
            Self::Html => "fields.html",
        }
    }
}

/// The outputs and fields to export.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Selection {
    /// Every how many outputs one is exported, and the last one; all if `None`.
    pub every: Option<NonZeroUsize>,
    /// Largest size of the fields of a page, bytes; 200 MB if `None`. A page of a larger series has fewer outputs, unless
    /// `every` is given. Other formats have no limit.
    pub size: Option<u64>,
    /// Names of the fields, such as `Damage` or `Stress` for all its components; all fields if empty.
    pub fields: Vec<String>,
}

/// The exported series.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Exported {
    /// Number of exported outputs.
    pub outputs: usize,
    /// What was left out, in sentences.
    pub notes: Vec<String>,
}

/// Writes fields of a run to a new file or folder, in the user's order of points. A page replaces a file of this name.
///
/// # Errors
/// The run has no field files or not the selected fields, the points cannot be built from its deck, or files cannot be
/// read or written.
pub fn export(
    results: &Results,
    format: ExportFormat,
    selection: &Selection,
    path: &Path,
) -> Result<Exported, RunError> {
    let source = results.source()?.read()?;
    let model = source.model();
    let resources = Resources {
        folder: source.folder(),
        memory: machine::memory(),
        ..readers()
    };
    let points = discretise(model, &resources);
    let points = points.map_err(|error| source.rejection(error))?;
    let body = result_body(model, &points.cloud, &points.sets, &points.meshes);
    let body = Arc::new(body);
    let arrays = field_selection(model, &points.cloud, &points.sets);
    let fields = RunFields::open(results, model, &body, arrays)?;
    let Some(fields) = fields.filter(|fields| fields.outputs() > 0) else {
        return Err(results.damaged("run.json", "the run wrote no field files".into()));
    };
    let mut fields = SelectedFields::new(fields, selection)?;
    let outputs = fields.outputs();
    let specs = fields.specs();
    let mut export = Export {
        fields: &mut fields,
        specs,
        body: &body,
        path,
    };
    match format {
        ExportFormat::Exodus => export.exodus(),
        ExportFormat::VtkHdf => export.vtkhdf(),
        ExportFormat::Csv => export.csv(),
        ExportFormat::Npz => export.npz(),
        ExportFormat::Html => {
            let run = page::RunToShow {
                results,
                model,
                points: &points,
                body: &body,
            };
            return page::write(&run, fields, selection, path);
        }
    }?;
    Ok(Exported {
        outputs,
        notes: Vec::new(),
    })
}

struct Export<'a> {
    fields: &'a mut SelectedFields,
    specs: Vec<FieldSpec>,
    body: &'a ResultBody,
    path: &'a Path,
}

impl Export<'_> {
    fn outputs(&self) -> usize {
        self.fields.outputs()
    }

    fn written<T>(&self, result: Result<T, WriteError>) -> Result<T, IoError> {
        result.map_err(|error| write_error(self.path, error))
    }

    fn exodus(&mut self) -> Result<(), RunError> {
        let layout = self.body.exodus(self.specs.clone(), false);
        let mut writer = self.written(ExodusWriter::create(self.path, &layout))?;
        for output in 0..self.outputs() {
            let (time, values) = self.fields.read(output)?;
            let values: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
            self.written(writer.append(time, &[], &values))?;
        }
        Ok(())
    }

    fn vtkhdf(&mut self) -> Result<(), RunError> {
        let layout = self.body.vtkhdf(self.specs.clone(), self.outputs(), false);
        let mut writer = self.written(VtkHdfWriter::create(self.path, &layout))?;
        for output in 0..self.outputs() {
            let (time, values) = self.fields.read(output)?;
            let values: Vec<&[f64]> = values.iter().map(Vec::as_slice).collect();
            self.written(writer.append(time, &values))?;
        }
        Ok(())
    }

    fn csv(&mut self) -> Result<(), RunError> {
        let made = fs::create_dir(self.path);
        made.map_err(|error| IoError::writing(self.path, error))?;
        let axes = ["x", "y", "z"];
        let dimension = self.body.dimension;
        let mut columns: Vec<Column> = axes[..dimension]
            .iter()
            .map(|axis| Column::real(*axis, "m"))
            .collect();
        columns.push(Column::real("volume", "m3"));
        for field in &self.specs {
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
        for number in 0..self.outputs() {
            let path = self.path.join(format!("fields_{number:06}.csv"));
            let mut table = CsvTable::create(&path, &columns)?;
            let (_, values) = self.fields.read(number)?;
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

    fn npz(&mut self) -> Result<(), RunError> {
        let (n, outputs) = (self.body.volumes.len(), self.outputs());
        let dimension = self.body.dimension;
        let mut archive = NpzWriter::create(self.path)?;
        archive.begin("time", &[outputs])?;
        for output in 0..outputs {
            archive.write(&[self.fields.time(output)?])?;
        }
        archive.begin("position", &[n, dimension])?;
        let position = |k: usize| self.body.positions[k % dimension * n + k / dimension];
        let positions: Vec<f64> = (0..n * dimension).map(position).collect();
        archive.write(&positions)?;
        archive.begin("volume", &[n])?;
        archive.write(&self.body.volumes)?;
        // Field by field, because an array over all outputs may not fit into memory.
        for (number, field) in self.specs.iter().enumerate() {
            match field.components {
                1 => archive.begin(&field.name, &[outputs, n])?,
                several => archive.begin(&field.name, &[outputs, n, several])?,
            }
            let components = field.components;
            for output in 0..outputs {
                let values = self.fields.read(output)?.1.swap_remove(number);
                let value = |k: usize| values[k % components * n + k / components];
                let rows: Vec<f64> = (0..values.len()).map(value).collect();
                archive.write(&rows)?;
            }
        }
        Ok(archive.finish()?)
    }
}
