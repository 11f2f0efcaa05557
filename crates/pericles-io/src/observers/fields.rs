//! Fields on the points over time.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;

use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::space::PointCloud;
use pericles::space::surface::Surface;
use pericles::{Archive, Result, Saved, Values};

use super::table::misfit;
use crate::error::IoError;
use crate::vtk::{PvdSeries, VtkField, VtuFile};

const KEY: &str = "observer/fields";

/// Fields as a VTK series: `fields.pvd` and `fields/fields_000000.vtu` …, in the user's numbering of the points.
///
/// The files hold the reference positions; displaced ones are a "Warp By Vector" away. Their bytes depend on the state alone.
pub struct FieldSeries {
    folder: PathBuf,
    single_precision: bool,
    series: Option<PvdSeries>,
    surface: Option<Arc<Surface>>,
    wanted: Vec<Field>,
}

impl FieldSeries {
    /// A series in an output folder, whose sub-folder `fields` must be there.
    pub fn new(folder: impl Into<PathBuf>, single_precision: bool) -> Self {
        Self {
            folder: folder.into(),
            single_precision,
            series: None,
            surface: None,
            wanted: Field::USUAL.to_vec(),
        }
    }

    /// The same with these fields; of tensors each component is a field of its own, `Stress_xx` …
    pub fn with(mut self, fields: &[Field]) -> Self {
        self.wanted = fields.to_vec();
        self
    }

    /// The same for a surface, whose triangles become cells; its files hold the kinetic energy density besides.
    pub fn of_surface(mut self, surface: Arc<Surface>) -> Self {
        self.surface = Some(surface);
        self
    }

    fn write(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), IoError> {
        let series = match &mut self.series {
            Some(series) => series,
            none => none.insert(PvdSeries::create(self.folder.join("fields.pvd"))?),
        };
        let (state, cloud) = (snapshot.state(), snapshot.system().cloud());
        let numbering = Numbering::of(cloud);
        let positions = numbering.apply(cloud.positions());
        let columns: Vec<(String, bool, Cow<'_, [f64]>)> = self
            .wanted
            .iter()
            .flat_map(|&field| columns(field, snapshot))
            .map(|(name, vector, array)| (name, vector, numbering.apply(array)))
            .collect();
        let mut file = VtuFile::new(cloud.dimension(), &positions).time(state.t);
        for (name, vector, array) in &columns {
            let column = if *vector {
                VtkField::vector(name, array)
            } else {
                VtkField::scalar(name, array)
            };
            file = file.field(if self.single_precision {
                column.in_single_precision()
            } else {
                column
            });
        }
        let triangles: Vec<[u32; 3]>;
        let kinetic: Vec<f64>;
        if let Some(surface) = &self.surface {
            let number = |vertex: u32| surface.user_number(vertex as usize) as u32;
            triangles = surface
                .triangles()
                .iter()
                .map(|triangle| triangle.map(number))
                .collect();
            kinetic = numbering
                .apply(&snapshot.kinetic_energy_density())
                .into_owned();
            let column = VtkField::scalar("Kinetic_Energy_Density", &kinetic);
            file = file.triangles(&triangles).field(if self.single_precision {
                column.in_single_precision()
            } else {
                column
            });
        }
        let name = PvdSeries::field_file(series.len());
        file.write(self.folder.join(&name))?;
        series.push(state.t, &name)
    }
}

impl Observer for FieldSeries {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        Ok(self.write(snapshot)?)
    }
}

impl Saved for FieldSeries {
    fn save(&self, archive: &mut Archive) {
        let entries = self.series.as_ref().map_or(0, PvdSeries::len);
        archive.put(KEY, Values::U64(vec![entries as u64]));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut entries = 0;
        archive.u64_into(KEY, std::slice::from_mut(&mut entries))?;
        self.series = (entries > 0)
            .then(|| PvdSeries::reopen(self.folder.join("fields.pvd"), entries as usize))
            .transpose()
            .map_err(misfit)?;
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
