//! Pictures of a field over time.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::space::PointCloud;
use pericles::{Archive, Checkpointed, PericlesError, Result, Values};
use pericles_manifold::surface::Surface;

use super::overlay::Overlay;
use super::rigid::{RigidMesh, rigid_meshes};
use crate::checkpoint::Container;
use crate::error::IoError;
use crate::picture::{CellSize, Extent, FieldPicture, write_animation};

/// Default width in pixels.
const WIDTH: u32 = 1200;

/// Settings of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOf {
    /// The field.
    pub field: Field,
    /// Component of a vector; `None` for the magnitude.
    pub component: Option<usize>,
    /// Magnification of displacements.
    pub scale: f64,
    /// Values at the ends of the colour bar; `None` for 0 and 1 for damage, and the [`Extent`] of the values of each picture
    /// for other fields.
    pub range: Option<[f64; 2]>,
    /// Title above the picture.
    pub title: String,
    /// Viewing direction for bodies in three dimensions; `None` for the front right and above.
    pub view: Option<[f64; 3]>,
    /// Surface whose vertices are the points: its triangles are drawn.
    pub surface: Option<Arc<Surface>>,
    /// Whether all pictures show the same region: the box of the body at rest plus a tenth of its longest
    /// side. Otherwise each picture shows the extent of the displaced body.
    pub steady: bool,
    /// Width in pixels.
    pub width: u32,
    /// Time at which all loads act, s; pictures of static states then show the load factor instead of the time.
    pub load_end: Option<f64>,
    /// Lines on a plane body.
    pub overlay: Option<Arc<Overlay>>,
}

/// A state of a body to draw, its points in the order of their cloud.
#[derive(Debug, Clone, Copy)]
pub struct DrawnState<'a> {
    /// The time, s.
    pub t: f64,
    /// Positions, component-major, m.
    pub displacement: &'a [f64],
    /// One value per point.
    pub values: &'a [f64],
    /// Range of the values; computed from them if `None`.
    pub extent: Option<Extent>,
    /// Impactors.
    pub impactors: &'a [RigidMesh],
}

/// Returns the name of a field or field component for a body of the given dimension: `Damage`, `Velocity_x`.
pub(super) fn name_of(field: Field, component: Option<usize>, dimension: usize) -> String {
    match component {
        Some(component) => {
            format!(
                "{}_{}",
                field.name(),
                field.components(dimension)[component]
            )
        }
        None => field.name().to_owned(),
    }
}

/// Returns one value per point of a component-major field: a component, the field itself if it is scalar, or
/// the norm.
pub(super) fn scalar_of(field: &[f64], points: usize, component: Option<usize>) -> Cow<'_, [f64]> {
    if let Some(component) = component {
        return Cow::Borrowed(&field[component * points..(component + 1) * points]);
    }
    if field.len() == points {
        return Cow::Borrowed(field);
    }
    let norm = |i: usize| {
        let squares = field.chunks(points).map(|component| component[i].powi(2));
        squares.sum::<f64>().sqrt()
    };
    Cow::Owned((0..points).map(norm).collect())
}

impl PictureOf {
    /// Shows a field on the displaced points, vectors by magnitude.
    pub fn new(field: Field) -> Self {
        Self {
            field,
            component: None,
            scale: 1.0,
            range: None,
            title: String::new(),
            view: None,
            surface: None,
            steady: false,
            width: WIDTH,
            load_end: None,
            overlay: None,
        }
    }

    /// Returns the name, such as `Damage`, `Velocity`, `Velocity_x` or `Stress_yy`, for a body of the given
    /// dimension.
    pub fn name(&self, dimension: usize) -> String {
        name_of(self.field, self.component, dimension)
    }

    /// Returns the drawn value per point of a component-major field: a component, the field itself if it is
    /// scalar, or the norm.
    pub fn numbers<'a>(&self, field: &'a [f64], points: usize) -> Cow<'a, [f64]> {
        scalar_of(field, points, self.component)
    }

    /// Returns the range of the values drawn of a field, component-major; components are compared with the norm of the field.
    pub fn extent(&self, field: &[f64], values: &[f64]) -> Extent {
        let norm = match self.component {
            None => 0.0,
            Some(_) => {
                let points = values.len();
                let norms = scalar_of(field, points, None);
                norms
                    .iter()
                    .copied()
                    .filter(|x| x.is_finite())
                    .fold(0.0, f64::max)
            }
        };
        Extent::of(values, norm)
    }

    /// Returns whether the range of the colour bar depends on the values.
    pub fn has_own_range(&self) -> bool {
        self.range.is_none() && self.field != Field::Damage
    }

    /// Draws the picture of a state into a file, unless another process writes it.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written.
    pub fn draw(
        &self,
        snapshot: &Snapshot<'_>,
        path: impl AsRef<Path>,
    ) -> std::result::Result<(), IoError> {
        let (state, cloud) = (snapshot.state(), snapshot.whole_cloud());
        let (field, displacement) = (
            snapshot.whole(self.field),
            snapshot.whole(Field::Displacement),
        );
        let (Some(field), Some(displacement)) = (field, displacement) else {
            return Ok(());
        };
        let values = self.numbers(&field, cloud.len());
        let drawn = DrawnState {
            t: state.t,
            displacement: &displacement,
            values: &values,
            extent: Some(self.extent(&field, &values)),
            impactors: &rigid_meshes(snapshot),
        };
        self.draw_state(cloud, &drawn, path)
    }

    /// Draws values from any source.
    ///
    /// # Errors
    /// Returns an error if the file cannot be written or the number of values differs from the number of points.
    pub fn draw_state(
        &self,
        cloud: &PointCloud,
        state: &DrawnState<'_>,
        path: impl AsRef<Path>,
    ) -> std::result::Result<(), IoError> {
        let n = cloud.len();
        let sizes: Vec<f64>;
        let cell = if cloud.lattice().is_some() {
            CellSize::Uniform(cloud.spacing())
        } else {
            sizes = (0..n).map(|i| cloud.cell_size(i)).collect();
            CellSize::PerPoint(&sizes)
        };
        // Densities on a surface are per area.
        let unit = match &self.surface {
            Some(_) => self.field.unit().replace("/m³", "/m²"),
            None => self.field.unit().to_owned(),
        };
        let mut picture =
            FieldPicture::new(cloud.dimension(), cloud.positions(), state.values, cell)
                .label(self.name(cloud.dimension()), unit)
                .displacement(state.displacement, self.scale)
                .title(&self.title)
                .time(state.t)
                .width(self.width);
        let whole = (self.field == Field::Damage).then_some([0.0, 1.0]);
        if let Some(surface) = &self.surface {
            picture = picture.triangles(surface.triangles());
        }
        if self.steady {
            let (low, high) = surroundings(cloud);
            picture = picture.window(low, high);
        }
        if let Some(view) = self.view {
            picture = picture.view(view);
        }
        let own = state
            .extent
            .unwrap_or_else(|| Extent::of(state.values, 0.0));
        let [low, high] = self.range.or(whole).unwrap_or_else(|| {
            let [low, high] = own.ends();
            // The curve of a bar must not touch the frame.
            let margin = if cloud.dimension() == 1 { 0.04 } else { 0.0 };
            [low - margin * (high - low), high + margin * (high - low)]
        });
        picture = match self.field == Field::FragmentId {
            true => picture.categories(Vec::new()),
            false => picture.range(low, high),
        };
        if let Some(end) = self.load_end {
            picture = picture.load_factor(state.t / end);
        }
        if let Some(overlay) = &self.overlay {
            picture = picture.lines(overlay.lines(state.displacement, self.scale));
        }
        let outlines = state.impactors.iter().map(RigidMesh::outline);
        let corners = state.impactors.iter().flat_map(RigidMesh::corners);
        picture = picture.rigid(
            corners.collect(),
            outlines.filter(|one| !one.is_empty()).collect(),
        );
        picture.write(path)
    }
}

/// Returns the corners of the bounding box of the points, enlarged by a tenth of its longest side.
fn surroundings(cloud: &PointCloud) -> ([f64; 3], [f64; 3]) {
    let (mut low, mut high) = ([0.0; 3], [0.0; 3]);
    for c in 0..cloud.dimension() {
        let axis = cloud.axis(c).iter();
        low[c] = axis.clone().copied().fold(f64::INFINITY, f64::min);
        high[c] = axis.copied().fold(f64::NEG_INFINITY, f64::max);
    }
    let longest = (0..3).map(|c| high[c] - low[c]).fold(0.0, f64::max);
    let around = 0.1 * longest.max(cloud.spacing());
    (low.map(|x| x - around), high.map(|x| x + around))
}

/// Pictures `<stem>-000000.png`, `<stem>-000001.png` … in a folder and, if requested, an animation
/// `<stem>.apng` of the existing pictures at the end of the run.
pub struct Pictures {
    folder: PathBuf,
    stem: String,
    what: PictureOf,
    animated: bool,
    drawn: u64,
    /// The points of the body, for pictures with a common range.
    cloud: Option<Arc<PointCloud>>,
    /// Range of the values of all pictures so far.
    extent: Option<Extent>,
}

/// A drawn state in a file.
struct DrawnFile {
    t: f64,
    size: f64,
    displacement: Vec<f64>,
    values: Vec<f64>,
    impactors: Vec<RigidMesh>,
}

impl DrawnFile {
    /// Returns the state of a snapshot; `None` if another process writes it.
    fn of(what: &PictureOf, snapshot: &Snapshot<'_>) -> Option<Self> {
        let (field, displacement) = (
            snapshot.whole(what.field),
            snapshot.whole(Field::Displacement),
        );
        let field = field?;
        let values = what.numbers(&field, snapshot.whole_cloud().len());
        Some(Self {
            t: snapshot.state().t,
            size: what.extent(&field, &values).size(),
            displacement: displacement?.into_owned(),
            values: values.into_owned(),
            impactors: rigid_meshes(snapshot),
        })
    }

    fn write(self, path: &Path) -> std::result::Result<(), IoError> {
        let mut archive = Archive::default();
        archive.put("t", Values::F64(vec![self.t]));
        archive.put("size", Values::F64(vec![self.size]));
        archive.put("displacement", Values::F64(self.displacement));
        archive.put("values", Values::F64(self.values));
        let impactors = self.impactors.iter().flat_map(RigidMesh::to_numbers);
        archive.put("impactors", Values::F64(impactors.collect()));
        Container::from_archive(serde_json::Value::Null, archive).write(path)
    }

    fn read(path: &Path) -> std::result::Result<Self, IoError> {
        let damaged = |reason: String| IoError::damaged(path, reason);
        let container = Container::read(path, u64::MAX)?;
        let (_, archive) = container.into_archive().map_err(damaged)?;
        let array = |name: &str| -> std::result::Result<Vec<f64>, IoError> {
            let values = archive
                .f64s(name)
                .map_err(|error| damaged(error.to_string()))?;
            Ok(values.to_vec())
        };
        let number = |name: &str| -> std::result::Result<f64, IoError> {
            let values = array(name)?;
            values
                .first()
                .copied()
                .ok_or_else(|| damaged(format!("{name} is empty")))
        };
        Ok(Self {
            t: number("t")?,
            size: number("size")?,
            displacement: array("displacement")?,
            values: array("values")?,
            impactors: RigidMesh::from_numbers(&array("impactors")?)
                .ok_or_else(|| damaged("impactors are incomplete".into()))?,
        })
    }

    fn extent(&self) -> Extent {
        Extent::of(&self.values, self.size)
    }

    fn state(&self) -> DrawnState<'_> {
        DrawnState {
            t: self.t,
            displacement: &self.displacement,
            values: &self.values,
            extent: None,
            impactors: &self.impactors,
        }
    }
}

impl Pictures {
    /// Creates pictures in an existing folder; `stem` distinguishes them from those of other observers.
    pub fn new(folder: impl Into<PathBuf>, stem: impl Into<String>, what: PictureOf) -> Self {
        Self {
            folder: folder.into(),
            stem: stem.into(),
            what,
            animated: false,
            drawn: 0,
            cloud: None,
            extent: None,
        }
    }

    /// Adds an animation at the end of the run; all pictures then show the same region.
    pub fn animated(mut self) -> Self {
        self.animated = true;
        self.what.steady = true;
        self
    }

    fn still(&self, number: u64) -> PathBuf {
        self.folder.join(format!("{}-{number:06}.png", self.stem))
    }

    /// Draws all pictures again at the end of the run with one range of the colour bar, unless the range is fixed.
    pub fn with_common_range(mut self, cloud: Arc<PointCloud>) -> Self {
        self.cloud = self.what.has_own_range().then_some(cloud);
        self
    }

    /// The file of the state that a picture shows, kept until the run has ended.
    fn state(&self, number: u64) -> PathBuf {
        self.folder
            .join(format!(".{}-{number:06}.state", self.stem))
    }

    /// Draws all pictures again with one range, so that equal colours are equal values, and removes the files of the states.
    fn redraw(&self, cloud: &PointCloud) -> std::result::Result<(), IoError> {
        let Some(whole) = self.extent else {
            return Ok(());
        };
        // States are missing if the run was killed after it had removed them: these pictures have the common range already.
        let states = (0..self.drawn).filter(|&number| self.state(number).exists());
        for number in states {
            let path = self.state(number);
            let file = DrawnFile::read(&path)?;
            // A picture that the user has removed stays removed.
            if self.still(number).exists() && whole != file.extent() {
                let state = DrawnState {
                    extent: Some(whole),
                    ..file.state()
                };
                self.what.draw_state(cloud, &state, self.still(number))?;
            }
            std::fs::remove_file(&path).map_err(|error| IoError::writing(&path, error))?;
        }
        Ok(())
    }

    fn extent_key(&self) -> String {
        format!("observer/pictures/{}/extent", self.stem)
    }

    fn key(&self) -> String {
        format!("observer/pictures/{}", self.stem)
    }
}

impl Observer for Pictures {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        snapshot.check(self.what.field)?;
        self.what.draw(snapshot, self.still(self.drawn))?;
        if self.cloud.is_some()
            && let Some(drawn) = DrawnFile::of(&self.what, snapshot)
        {
            let extent = drawn.extent();
            self.extent = Some(self.extent.map_or(extent, |whole| whole.union(extent)));
            drawn.write(&self.state(self.drawn))?;
        }
        self.drawn += u64::from(snapshot.is_written());
        Ok(())
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        if let Some(cloud) = &self.cloud {
            self.redraw(cloud)?;
        }
        if !self.animated {
            return Ok(());
        }
        // The user may have deleted some pictures of a long run: the others still make an animation.
        let stills: Vec<PathBuf> = (0..self.drawn)
            .map(|number| self.still(number))
            .filter(|still| still.exists())
            .collect();
        if stills.is_empty() {
            return Ok(());
        }
        let path = self.folder.join(format!("{}.apng", self.stem));
        Ok(write_animation(&stills, path)?)
    }
}

impl Checkpointed for Pictures {
    fn save(&self, archive: &mut Archive) {
        let Self {
            drawn,
            folder: _,
            stem: _,
            what: _,
            animated: _,
            cloud: _,
            extent,
        } = self;
        archive.put(self.key(), Values::U64(vec![*drawn]));
        if let Some(extent) = extent {
            archive.put(self.extent_key(), Values::F64(extent.parts().to_vec()));
        }
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut drawn = [0];
        archive.u64_into(&self.key(), &mut drawn)?;
        let last = drawn[0].checked_sub(1).map(|last| self.still(last));
        if let Some(missing) = last.filter(|last| !last.exists()) {
            let reason = format!(
                "it lists {} pictures, but {} is missing",
                drawn[0],
                missing.display()
            );
            return Err(PericlesError::BadArchive { reason });
        }
        self.drawn = drawn[0];
        // Checkpoints of earlier releases have no extent.
        let parts = archive.f64s(&self.extent_key()).ok();
        let parts = parts.and_then(|parts| <[f64; 3]>::try_from(parts).ok());
        self.extent = parts.map(Extent::from_parts);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_are_reduced_to_scalars() {
        let field = [3.0, 0.0, -4.0, 2.0];
        let magnitude = PictureOf::new(Field::Velocity);
        let second = PictureOf {
            component: Some(1),
            ..magnitude.clone()
        };
        assert_eq!(*magnitude.numbers(&field, 2), [5.0, 2.0]);
        assert_eq!(*second.numbers(&field, 2), [-4.0, 2.0]);
        assert_eq!(*magnitude.numbers(&field[..2], 2), [3.0, 0.0]);
    }
}
