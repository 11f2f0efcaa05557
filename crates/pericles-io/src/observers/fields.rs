//! Fields on the points over time.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::space::PointCloud;
use pericles::{Archive, Result, Saved, Values};
use pericles_manifold::surface::Surface;

use super::background::Background;
use super::table::misfit;
use crate::error::IoError;
use crate::numbering::Numbering;
use crate::vtk::{PvdSeries, VtkField, VtuCells, VtuFile};

const KEY: &str = "observer/fields";
const CELLS_KEY: &str = "observer/cells";

/// Fields as a VTK series: `fields.pvd` and `fields/fields_000000.vtu` …, in the user's numbering of the points.
///
/// The files hold the reference positions; displaced ones are a "Warp By Vector" away. Their bytes depend on the state alone.
///
/// Files are compressed and written by a thread of their own while the run goes on, one at a time.
pub struct FieldSeries {
    folder: PathBuf,
    single_precision: bool,
    series: Option<Arc<Mutex<PvdSeries>>>,
    /// Outputs so far, the one under way among them.
    outputs: usize,
    surface: Option<Arc<Surface>>,
    cells: Option<Arc<MeshCells>>,
    wanted: Vec<Field>,
    /// Made at the first output.
    body: Option<Arc<FixedPart>>,
    background: Background,
}

impl FieldSeries {
    /// A series in an output folder, whose sub-folder `fields` must be there.
    pub fn new(folder: impl Into<PathBuf>, single_precision: bool) -> Self {
        Self {
            folder: folder.into(),
            single_precision,
            series: None,
            outputs: 0,
            surface: None,
            cells: None,
            wanted: Field::USUAL.to_vec(),
            body: None,
            background: Background::default(),
        }
    }

    /// The same with these fields; of tensors each component is a field of its own, `Stress_xx` …
    pub fn with(mut self, fields: &[Field]) -> Self {
        self.wanted = fields.to_vec();
        self
    }

    /// The same on the cells of a mesh, one for each point: `cells.pvd` and `cells/cells_000000.vtu` …
    pub fn on_cells(mut self, cells: Arc<MeshCells>) -> Self {
        self.cells = Some(cells);
        self
    }

    /// The same for a surface, whose triangles become cells.
    pub fn of_surface(mut self, surface: Arc<Surface>) -> Self {
        self.surface = Some(surface);
        self
    }

    fn write(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), IoError> {
        let series = match &self.series {
            Some(series) => series,
            None => {
                let series = PvdSeries::create(self.series_file())?;
                self.series.insert(Arc::new(Mutex::new(series)))
            }
        };
        let series = Arc::clone(series);
        let output = self.output(snapshot);
        let name = match self.cells {
            Some(_) => format!("cells/cells_{:06}.vtu", self.outputs),
            None => PvdSeries::field_file(self.outputs),
        };
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
        let name = match self.cells {
            Some(_) => "cells.pvd",
            None => "fields.pvd",
        };
        self.folder.join(name)
    }

    /// The key of what a checkpoint holds.
    fn key(&self) -> &'static str {
        match self.cells {
            Some(_) => CELLS_KEY,
            None => KEY,
        }
    }

    fn output(&mut self, snapshot: &Snapshot<'_>) -> Output {
        let (state, cloud) = (snapshot.state(), snapshot.system().cloud());
        let surface = self.surface.as_deref();
        let body = self
            .body
            .get_or_insert_with(|| Arc::new(FixedPart::of(cloud, surface)));
        let numbering = &body.numbering;
        let columns: Vec<Column> = self
            .wanted
            .iter()
            .flat_map(|&field| columns(field, snapshot))
            .map(|(name, vector, array)| Column {
                name,
                vector,
                values: numbering.apply(array).into_owned(),
            })
            .collect();
        Output {
            body: Arc::clone(body),
            cells: self.cells.clone(),
            time: state.t,
            columns,
            single_precision: self.single_precision,
        }
    }
}

/// The cells of a mesh, one for each point in the user's order.
#[derive(Debug, Clone)]
pub struct MeshCells {
    /// Positions of the nodes, m: x of all, then y, then z.
    pub nodes: Vec<f64>,
    /// The cells.
    pub cells: VtuCells,
}

/// A named field in the user's order of points.
struct Column {
    name: String,
    vector: bool,
    values: Vec<f64>,
}

/// What all files of a run share, in the user's order of points.
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

/// What a file holds, taken from a snapshot that will not wait.
struct Output {
    body: Arc<FixedPart>,
    cells: Option<Arc<MeshCells>>,
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
        for column in &self.columns {
            let field = if column.vector {
                VtkField::vector(&column.name, &column.values)
            } else {
                VtkField::scalar(&column.name, &column.values)
            };
            file = file.field(if self.single_precision {
                field.in_single_precision()
            } else {
                field
            });
        }
        file.write(path)
    }
}

impl Observer for FieldSeries {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        for field in &self.wanted {
            snapshot.check(*field)?;
        }
        Ok(self.write(snapshot)?)
    }

    fn settle(&self) -> std::result::Result<(), ObserveError> {
        Ok(self.background.settle()?)
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        self.settle()
    }
}

impl Saved for FieldSeries {
    fn save(&self, archive: &mut Archive) {
        let key = self.key();
        let Self {
            outputs,
            // Opened again.
            series: _,
            folder: _,
            single_precision: _,
            surface: _,
            cells: _,
            wanted: _,
            body: _,
            background: _,
        } = self;
        archive.put(key, Values::U64(vec![*outputs as u64]));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut entries = 0;
        archive.u64_into(self.key(), std::slice::from_mut(&mut entries))?;
        self.outputs = entries as usize;
        self.series = (entries > 0)
            .then(|| PvdSeries::reopen(self.series_file(), self.outputs))
            .transpose()
            .map_err(misfit)?
            .map(|series| Arc::new(Mutex::new(series)));
        Ok(())
    }
}

/// A field as columns of a file: name, whether it is a vector, numbers.
pub(super) fn columns<'a>(
    field: Field,
    snapshot: &'a Snapshot<'_>,
) -> Vec<(String, bool, &'a [f64])> {
    let array = snapshot.field(field);
    if !field.is_tensor() {
        return vec![(field.name().to_owned(), field.is_vector(), array)];
    }
    let cloud = snapshot.system().cloud();
    let components = field.components(cloud.dimension()).iter();
    components
        .zip(array.chunks(cloud.len()))
        .map(|(component, array)| (format!("{}_{component}", field.name()), false, array))
        .collect()
}
