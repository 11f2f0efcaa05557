//! A field as a picture, time after time.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pericles::observe::{Field, ObserveError, Observer, Snapshot};
use pericles::space::PointCloud;
use pericles::{Archive, PericlesError, Result, Saved, Values};
use pericles_manifold::surface::Surface;

use crate::error::IoError;
use crate::picture::{CellSize, ColourMap, FieldPicture, write_animation};

/// Pixels across if nobody says otherwise.
const WIDTH: u32 = 1200;

/// What a picture shows.
#[derive(Debug, Clone, PartialEq)]
pub struct PictureOf {
    /// The field.
    pub field: Field,
    /// Which component of a vector; its magnitude if none.
    pub component: Option<usize>,
    /// By how much displacements are enlarged.
    pub scale: f64,
    /// Values at the ends of the colour bar; if none, 0 and 1 for damage and those of each picture for other fields.
    pub range: Option<[f64; 2]>,
    /// The line above the picture.
    pub title: String,
    /// The direction from which a body in space is seen; if none, from the front right and above.
    pub view: Option<[f64; 3]>,
    /// The surface whose vertices the points are: its triangles are drawn.
    pub surface: Option<Arc<Surface>>,
    /// Whether all pictures show the same part of space, the box of the body at rest and a tenth of its longest side around it. Otherwise each shows what
    /// the displaced body fills.
    pub steady: bool,
    /// Pixels across.
    pub width: u32,
}

/// A state of a body as it is drawn, its points in the order of their cloud.
#[derive(Debug, Clone, Copy)]
pub struct DrawnState<'a> {
    /// The time, s.
    pub t: f64,
    /// x of all points, then y …, m.
    pub displacement: &'a [f64],
    /// A number per point.
    pub values: &'a [f64],
}

/// The name of a field or of a component of it, in a body of a dimension: `Damage`, `Velocity_x`.
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

/// One number for each point of a field, component after component: a component, the field itself if it has only one, or the norm of all.
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
    /// A field, vectors by magnitude, on the points as they are displaced.
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
        }
    }

    /// `Damage`, `Velocity`, `Velocity_x`, `Stress_yy` … in a body of a dimension.
    pub fn name(&self, dimension: usize) -> String {
        name_of(self.field, self.component, dimension)
    }

    /// What is drawn of a field, component after component: one number per point, the field itself, a component, or the norm of all.
    pub fn numbers<'a>(&self, field: &'a [f64], points: usize) -> Cow<'a, [f64]> {
        scalar_of(field, points, self.component)
    }

    /// Draws the picture of a state into a file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn draw(
        &self,
        snapshot: &Snapshot<'_>,
        path: impl AsRef<Path>,
    ) -> std::result::Result<(), IoError> {
        let (state, cloud) = (snapshot.state(), snapshot.system().cloud());
        let field = snapshot.field(self.field);
        let values = self.numbers(field, cloud.len());
        let drawn = DrawnState {
            t: state.t,
            displacement: &state.u,
            values: &values,
        };
        self.draw_state(cloud, &drawn, path)
    }

    /// The same for numbers that come from elsewhere.
    ///
    /// # Errors
    /// A file that cannot be written; numbers that are not as many as the points.
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
        let colours = if self.component.is_some() {
            ColourMap::Diverging
        } else {
            ColourMap::Viridis
        };
        // On a surface densities are per area.
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
                .colours(colours)
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
        if let Some([low, high]) = self.range.or(whole) {
            picture = picture.range(low, high);
        }
        picture.write(path)
    }
}

/// Corners of the box of the points and a tenth of its longest side around it.
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

/// Pictures `<stem>-000000.png`, `<stem>-000001.png` … in a folder, and at the end of the run `<stem>.apng` with all of them that are still there if asked for.
pub struct Pictures {
    folder: PathBuf,
    stem: String,
    what: PictureOf,
    animated: bool,
    drawn: u64,
}

impl Pictures {
    /// Pictures in a folder that is there; the stem tells them from those of other observers.
    pub fn new(folder: impl Into<PathBuf>, stem: impl Into<String>, what: PictureOf) -> Self {
        Self {
            folder: folder.into(),
            stem: stem.into(),
            what,
            animated: false,
            drawn: 0,
        }
    }

    /// The same, put into one animated picture at the end; all of them then show the same part of space.
    pub fn animated(mut self) -> Self {
        self.animated = true;
        self.what.steady = true;
        self
    }

    fn still(&self, number: u64) -> PathBuf {
        self.folder.join(format!("{}-{number:06}.png", self.stem))
    }

    fn key(&self) -> String {
        format!("observer/pictures/{}", self.stem)
    }
}

impl Observer for Pictures {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        snapshot.check(self.what.field)?;
        self.what.draw(snapshot, self.still(self.drawn))?;
        self.drawn += 1;
        Ok(())
    }

    fn finish(&mut self) -> std::result::Result<(), ObserveError> {
        if !self.animated {
            return Ok(());
        }
        // A long run's user may have taken some away: the others still make an animation.
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

impl Saved for Pictures {
    fn save(&self, archive: &mut Archive) {
        let Self {
            drawn,
            folder: _,
            stem: _,
            what: _,
            animated: _,
        } = self;
        archive.put(self.key(), Values::U64(vec![*drawn]));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let mut drawn = [0];
        archive.u64_into(&self.key(), &mut drawn)?;
        let last = drawn[0].checked_sub(1).map(|last| self.still(last));
        if let Some(missing) = last.filter(|last| !last.exists()) {
            let reason = format!(
                "it knows of {} pictures, and {} is not there",
                drawn[0],
                missing.display()
            );
            return Err(PericlesError::BadArchive { reason });
        }
        self.drawn = drawn[0];
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_become_scalars() {
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
