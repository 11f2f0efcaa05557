//! The picture of a field at one time.

use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

use pericles::observe::{Field, Snapshot};
use pericles::space::PointCloud;
use pericles_manifold::surface::Surface;

use super::body_shape::BodyShape;
use super::rigid::{RigidMesh, rigid_meshes};
use crate::error::IoError;
use crate::picture::{CellSize, Extent, FieldPicture, PictureStyle};

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
    /// Size and style.
    pub style: PictureStyle,
    /// Lowest and highest coordinates of the region shown, m; `None` for the whole body.
    pub crop: Option<[[f64; 3]; 2]>,
    /// Name of the time of static states, such as the load factor, and the time of one unit, s; `None` shows the time.
    pub progress: Option<(&'static str, f64)>,
    /// Cells of the body and lines on it; `None` for squares or cubes around the points.
    pub shape: Option<Arc<BodyShape>>,
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
    /// Damage of the points, if bonds can break: cells beside a crack are then drawn apart.
    pub damage: Option<&'a [f64]>,
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
            style: PictureStyle::default(),
            crop: None,
            progress: None,
            shape: None,
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
            whole_shown(snapshot, self.field),
            whole_shown(snapshot, Field::Displacement),
        );
        let damage = whole_damage(snapshot);
        let (Some(field), Some(displacement)) = (field, displacement) else {
            return Ok(());
        };
        let values = self.numbers(&field, cloud.len());
        let drawn = DrawnState {
            t: state.t,
            displacement: &displacement,
            values: &values,
            damage: damage.as_deref(),
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
                .style(self.style);
        let whole = (self.field == Field::Damage).then_some([0.0, 1.0]);
        if let Some(surface) = &self.surface {
            picture = picture.triangles(surface.triangles());
        }
        if self.steady {
            let (low, high) = surroundings(cloud);
            picture = picture.window(low, high);
        }
        if let Some([low, high]) = self.crop {
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
        if let Some((name, unit)) = self.progress {
            picture = picture.progress(name, state.t / unit);
        }
        if let Some(shape) = &self.shape {
            let drawn = shape.drawn(cloud, state.displacement, state.damage, self.scale);
            picture = picture.polygons(drawn.polygons).lines(drawn.lines);
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

/// Returns the damage of the points of the whole body, if bonds can break, on the process that writes the results. All
/// processes must call it together.
pub(super) fn whole_damage<'a>(snapshot: &'a Snapshot<'_>) -> Option<Cow<'a, [f64]>> {
    let can_break = snapshot.system().operator().can_break();
    can_break.then(|| snapshot.whole(Field::Damage)).flatten()
}

/// Returns a field of the whole body, without points that are not active, on the process that writes the results. All
/// processes must call it together.
pub(super) fn whole_shown<'a>(snapshot: &'a Snapshot<'_>, field: Field) -> Option<Cow<'a, [f64]>> {
    let values = snapshot.whole(field);
    if !snapshot.system().has_activation() {
        return values;
    }
    let active = snapshot.whole(Field::Active);
    let mut values = values?.into_owned();
    leave_out_inactive(&mut values, &active?);
    Some(values.into())
}

/// Sets the values of points that are not active to NaN, which pictures do not show; `active` is
/// [`Field::Active`] of the points, `values` one field, component-major.
pub fn leave_out_inactive(values: &mut [f64], active: &[f64]) {
    for component in values.chunks_mut(active.len().max(1)) {
        for (value, active) in component.iter_mut().zip(active) {
            if *active == 0.0 {
                *value = f64::NAN;
            }
        }
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
