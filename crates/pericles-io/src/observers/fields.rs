//! Fields on the points over time.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::space::PointCloud;
use pericles::{Archive, Result, Saved, Values};
use pericles_manifold::surface::Surface;

use super::background::Background;
use super::table::misfit;
use crate::error::IoError;
use crate::vtk::{PvdSeries, VtkField, VtuFile};

const KEY: &str = "observer/fields";

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

    /// The same for a surface, whose triangles become cells.
    pub fn of_surface(mut self, surface: Arc<Surface>) -> Self {
        self.surface = Some(surface);
        self
    }

    fn write(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), IoError> {
        let series = match &self.series {
            Some(series) => series,
            None => {
                let series = PvdSeries::create(self.folder.join("fields.pvd"))?;
                self.series.insert(Arc::new(Mutex::new(series)))
            }
        };
        let series = Arc::clone(series);
        let output = self.output(snapshot);
        let name = PvdSeries::field_file(self.outputs);
        let path = self.folder.join(&name);
        self.background.start(move || {
            output.write(&path)?;
            let mut series = series.lock().unwrap_or_else(PoisonError::into_inner);
            series.push(output.time, &name)
        })?;
        self.outputs += 1;
        Ok(())
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
            time: state.t,
            columns,
            single_precision: self.single_precision,
        }
    }
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
    time: f64,
    columns: Vec<Column>,
    single_precision: bool,
}

impl Output {
    fn write(&self, path: &Path) -> std::result::Result<(), IoError> {
        let body = &*self.body;
        let mut file = VtuFile::new(body.dimension, &body.positions).time(self.time);
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
        let Self {
            outputs,
            // Opened again.
            series: _,
            folder: _,
            single_precision: _,
            surface: _,
            wanted: _,
            body: _,
            background: _,
        } = self;
        archive.put(KEY, Values::U64(vec![*outputs as u64]));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut entries = 0;
        archive.u64_into(KEY, std::slice::from_mut(&mut entries))?;
        self.outputs = entries as usize;
        self.series = (entries > 0)
            .then(|| PvdSeries::reopen(self.folder.join("fields.pvd"), self.outputs))
            .transpose()
            .map_err(misfit)?
            .map(|series| Arc::new(Mutex::new(series)));
        Ok(())
    }
}

/// A field as columns of a file: name, whether it is a vector, numbers.
fn columns<'a>(field: Field, snapshot: &'a Snapshot<'_>) -> Vec<(String, bool, &'a [f64])> {
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

/// The way from the cloud's order of points to the user's; none if they are the same.
struct Numbering(Option<Vec<usize>>);

impl Numbering {
    fn of(cloud: &PointCloud) -> Self {
        let numbers: Vec<usize> = (0..cloud.len()).map(|i| cloud.user_number(i)).collect();
        let same = numbers.iter().enumerate().all(|(i, &number)| i == number);
        Self((!same).then_some(numbers))
    }

    /// A component-major array in the user's order.
    fn apply<'a>(&self, array: &'a [f64]) -> Cow<'a, [f64]> {
        let Some(numbers) = &self.0 else {
            return Cow::Borrowed(array);
        };
        let n = numbers.len();
        let mut ordered = vec![0.0; array.len()];
        for (from, to) in array.chunks(n).zip(ordered.chunks_mut(n)) {
            for (&value, &number) in from.iter().zip(numbers) {
                to[number] = value;
            }
        }
        Cow::Owned(ordered)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_written_in_the_user_s_order() {
        let numbering = Numbering(Some(vec![2, 0, 1]));
        let ordered = numbering.apply(&[10.0, 20.0, 30.0, 1.0, 2.0, 3.0]);
        assert_eq!(*ordered, [20.0, 30.0, 10.0, 2.0, 3.0, 1.0]);
    }
}
