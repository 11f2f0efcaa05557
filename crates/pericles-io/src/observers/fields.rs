//! Fields on the points over time.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::space::PointCloud;
use pericles::{Archive, Checkpointed, Result, Values};
use pericles_manifold::surface::Surface;

use super::background::Background;
use super::cell_mesh::CellMesh;
use super::field_columns::{Column, FieldSelection, VtuColumn};
use super::table::misfit;
use crate::error::IoError;
use crate::numbering::Numbering;
use crate::vtk::{PvdSeries, VtkField, VtuFile};

const KEY: &str = "observer/fields";
const CELLS_KEY: &str = "observer/cells";

/// Fields as a VTK series: `fields.pvd` and `fields/fields_000000.vtu` …, in the user's order of points.
///
/// The files hold the reference positions; the filter "Warp By Vector" shows displaced ones. Their bytes depend on the state alone.
///
/// Points are written as such, as the vertices of the triangles of a surface, or as cells whose fields are cell data; the displacement is then also
/// written at the nodes, as the mean of the cells that meet there.
///
/// Files are compressed and written in a background thread while the run continues, one at a time.
pub struct FieldSeries {
    folder: PathBuf,
    single_precision: bool,
    series: Option<Arc<Mutex<PvdSeries>>>,
    /// Number of outputs, including the one in progress.
    outputs: usize,
    surface: Option<Arc<Surface>>,
    cells: Option<Arc<CellMesh>>,
    /// Name of the files, and of what a checkpoint holds.
    name: SeriesName,
    wanted: FieldSelection,
    /// Made at the first output.
    body: Option<Arc<FixedPart>>,
    background: Background,
}

impl FieldSeries {
    /// Creates a series in an output folder, whose sub-folder `fields` must exist.
    pub fn new(folder: impl Into<PathBuf>, single_precision: bool) -> Self {
        Self {
            folder: folder.into(),
            single_precision,
            series: None,
            outputs: 0,
            surface: None,
            cells: None,
            name: SeriesName::Fields,
            wanted: FieldSelection {
                fields: Field::USUAL.to_vec(),
                marks: Vec::new(),
            },
            body: None,
            background: Background::default(),
        }
    }

    /// Sets the fields. A tensor is written as one array with named components, and each component as an array of its own, `Stress_xx` …
    pub fn with(mut self, wanted: FieldSelection) -> Self {
        self.wanted = wanted;
        self
    }

    /// Writes the fields on cells; values of points without a cell are left out.
    pub fn on_cells(mut self, cells: Arc<CellMesh>) -> Self {
        self.cells = Some(cells);
        self
    }

    /// Names the files `cells.pvd` and `cells/cells_000000.vtu` …, for a second series of the same run.
    pub fn as_second(mut self) -> Self {
        self.name = SeriesName::Cells;
        self
    }

    /// Writes the triangles of a surface as cells.
    pub fn of_surface(mut self, surface: Arc<Surface>) -> Self {
        self.surface = Some(surface);
        self
    }

    fn write(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), IoError> {
        let Some(output) = self.output(snapshot) else {
            return Ok(());
        };
        let series = match &self.series {
            Some(series) => series,
            None => {
                let series = PvdSeries::create(self.series_file())?;
                self.series.insert(Arc::new(Mutex::new(series)))
            }
        };
        let series = Arc::clone(series);
        let name = self.name.file(self.outputs);
        let path = self.folder.join(&name);
        self.background.start(move || {
            output.write(&path)?;
            let mut series = series.lock().unwrap_or_else(PoisonError::into_inner);
            series.push(output.time, &name)
        })?;
        self.outputs += 1;
        Ok(())
    }

    fn series_file(&self) -> PathBuf {
        self.folder.join(self.name.series())
    }

    /// Returns the content of the next file; `None` if another process writes it.
    fn output(&mut self, snapshot: &Snapshot<'_>) -> Option<Output> {
        let (state, cloud) = (snapshot.state(), snapshot.whole_cloud());
        let surface = self.surface.as_deref();
        let body = self
            .body
            .get_or_insert_with(|| Arc::new(FixedPart::of(cloud, surface)));
        let columns = self.wanted.columns(snapshot, &body.numbering)?;
        let columns = columns.into_iter().map(|column| match &self.cells {
            Some(cells) if cells.points.len() < cloud.len() => {
                column.of_points(&cells.points, cloud.len())
            }
            _ => column,
        });
        Some(Output {
            body: Arc::clone(body),
            cells: self.cells.clone(),
            time: state.t,
            columns: columns.collect(),
            single_precision: self.single_precision,
        })
    }
}

/// Names of the files of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SeriesName {
    Fields,
    Cells,
}

impl SeriesName {
    fn series(self) -> &'static str {
        match self {
            Self::Fields => "fields.pvd",
            Self::Cells => "cells.pvd",
        }
    }

    /// The file of an output.
    fn file(self, output: usize) -> String {
        match self {
            Self::Fields => PvdSeries::field_file(output),
            Self::Cells => format!("cells/cells_{output:06}.vtu"),
        }
    }

    /// The key of what a checkpoint holds.
    fn key(self) -> &'static str {
        match self {
            Self::Fields => KEY,
            Self::Cells => CELLS_KEY,
        }
    }
}

/// Data shared by all files of a run, in the user's order of points.
struct FixedPart {
    dimension: usize,
    positions: Vec<f64>,
    triangles: Option<Vec<[u32; 3]>>,
    numbering: Numbering,
}

impl FixedPart {
    fn of(cloud: &PointCloud, surface: Option<&Surface>) -> Self {
        let numbering = Numbering::of(cloud);
        let numbered = |surface: &Surface| {
            let number = |vertex: u32| surface.user_number(vertex as usize) as u32;
            let triangles = surface.triangles().iter();
            triangles.map(|triangle| triangle.map(number)).collect()
        };
        Self {
            dimension: cloud.dimension(),
            positions: numbering.apply(cloud.positions()).into_owned(),
            triangles: surface.map(numbered),
            numbering,
        }
    }
}

/// Content of one file, copied from a snapshot that does not outlive the step.
struct Output {
    body: Arc<FixedPart>,
    cells: Option<Arc<CellMesh>>,
    time: f64,
    columns: Vec<Column>,
    single_precision: bool,
}

impl Output {
    fn write(&self, path: &Path) -> std::result::Result<(), IoError> {
        let body = &*self.body;
        let mut file = match &self.cells {
            Some(mesh) => VtuFile::new(3, &mesh.nodes).on_cells(&mesh.cells),
            None => VtuFile::new(body.dimension, &body.positions),
        };
        file = file.time(self.time);
        if let Some(triangles) = &body.triangles {
            file = file.triangles(triangles);
        }
        let points = match &self.cells {
            Some(mesh) => mesh.cells.len(),
            None => body.positions.len() / body.dimension,
        };
        let arrays = self.columns.iter();
        let arrays: Vec<VtuColumn<'_>> = arrays
            .flat_map(|column| column.in_vtu(body.dimension, points))
            .collect();
        for array in &arrays {
            file = file.field(array.field(self.single_precision));
        }
        let displacement = self.cells.as_ref().and_then(|cells| {
            let name = Field::Displacement.name();
            let column = self.columns.iter().find(|column| column.name == name)?;
            Some(cells.at_nodes(column.values()))
        });
        if let Some(displacement) = &displacement {
            let field = VtkField::vector(Field::Displacement.name(), displacement);
            let field = field.unit(Field::Displacement.unit());
            file = file.node_field(match self.single_precision {
                true => field.in_single_precision(),
                false => field,
            });
        }
        file.write(path)
    }
}

impl Observer for FieldSeries {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        self.wanted.check(snapshot)?;
        Ok(self.write(snapshot)?)
    }

    fn observe_failed(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        self.observe(snapshot)
    }

    fn settle(&self) -> std::result::Result<(), ObserveError> {
        Ok(self.background.settle()?)
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        self.settle()
    }
}

impl Checkpointed for FieldSeries {
    fn save(&self, archive: &mut Archive) {
        let key = self.name.key();
        let Self {
            outputs,
            // The series is reopened.
            series: _,
            folder: _,
            single_precision: _,
            surface: _,
            cells: _,
            name: _,
            wanted: _,
            body: _,
            background: _,
        } = self;
        archive.put(key, Values::U64(vec![*outputs as u64]));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut entries = 0;
        archive.u64_into(self.name.key(), std::slice::from_mut(&mut entries))?;
        self.outputs = entries as usize;
        self.series = (entries > 0)
            .then(|| PvdSeries::reopen(self.series_file(), self.outputs))
            .transpose()
            .map_err(misfit)?
            .map(|series| Arc::new(Mutex::new(series)));
        Ok(())
    }
}
