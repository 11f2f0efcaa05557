//! Pictures of the fields in an output folder. The points are built from the deck or model in `run.json`, so that the
//! pictures have the same cells and triangles as those of the run.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use pericles::observe::{Field, FieldKind};
use pericles::space::PointCloud;
use pericles_deck::Model;
use pericles_io::observers::{DrawnState, ImpactorSurfaces, PictureOf, leave_out_inactive};
use pericles_io::{Extent, FieldData, write_animation};
use pericles_run::{
    FieldFile, Resources, Results, RunError, body_shape, discretise, machine, picture_of, readers,
};

use crate::args::{Format, PlotArgs};
use crate::error::CliError;
use crate::frames::Frames;

/// Renders pictures into a folder; returns the files of pictures and animations.
pub(super) fn draw(
    results: &Results,
    args: &PlotArgs,
    place: &Path,
) -> Result<Vec<PathBuf>, CliError> {
    let states = results.fields()?;
    let Some(last) = states.last() else {
        if args.fields.is_empty() {
            return Ok(Vec::new());
        }
        let error = results.damaged("fields.pvd", "the run wrote no field files".into());
        return Err(error.into());
    };
    let source = results.source()?.read()?;
    let model = source.model();
    let resources = Resources {
        folder: source.folder(),
        memory: machine::memory(),
        ..readers()
    };
    let points = discretise(model, &resources);
    let points = points.map_err(|error| source.rejection(error))?;
    let cracks = points.cracks.into_iter().map(|(crack, _)| crack);
    let cracks: Vec<_> = cracks.collect();
    let (cloud, surface) = (points.cloud, points.surface);
    let shape = body_shape(model, &cloud, &points.sets, &points.meshes, &cracks).map(Arc::new);
    let body = Body {
        rows: (0..cloud.len()).map(|i| cloud.user_number(i)).collect(),
        cloud,
        folder: results.folder().to_path_buf(),
        impactors: model.impactors.iter().map(|one| one.name.clone()).collect(),
    };
    let dimension = body.cloud.dimension();
    let crop = args.style.crop(dimension)?;
    let mut pictures = Vec::new();
    for what in wanted(model, args, &last.read()?, dimension)? {
        pictures.push(PictureOf {
            surface: surface.clone(),
            shape: shape.clone(),
            steady: args.animation,
            style: args.style.style(what.style)?,
            crop: crop.or(what.crop),
            view: args.view.map(|view| view.vector()).or(what.view),
            scale: args.scale.unwrap_or(what.scale),
            ..what
        });
    }
    let all = Frames::All;
    let frames = match &args.time {
        Some(frames) => frames,
        None if args.animation => &all,
        None => &Frames::Last,
    };
    let numbers = frames.among(&states);
    for what in &mut pictures {
        if let Some(range) = &args.range {
            what.range = Some(range.0);
        } else if what.has_own_range() {
            // One range for all times, so that colours are comparable.
            what.range = body.common_range(what, &states, &numbers)?;
        }
    }
    let mut written = Vec::new();
    let mut stills: Vec<Vec<PathBuf>> = vec![Vec::new(); pictures.len()];
    for &number in &numbers {
        let data = states[number].read()?;
        for (what, stills) in pictures.iter().zip(&mut stills) {
            let name = format!("{}-{number:06}", what.name(body.cloud.dimension()));
            let path = place.join(format!("{name}.{}", args.format.ending()));
            body.draw(what, &states[number], &data, &path)?;
            stills.push(path);
        }
    }
    for (what, stills) in pictures.iter().zip(&stills) {
        if args.animation && args.format == Format::Png {
            let path = place.join(format!("{}.apng", what.name(body.cloud.dimension())));
            write_animation(stills, &path)?;
            written.push(path);
        }
    }
    Ok(stills.into_iter().flatten().chain(written).collect())
}

/// Returns the fields to render: the requested ones, else the fields of the deck's pictures, else the damage if there is any,
/// else the displacement.
fn wanted(
    model: &Model,
    args: &PlotArgs,
    data: &FieldData,
    dimension: usize,
) -> Result<Vec<PictureOf>, RunError> {
    let title = model.title.clone().unwrap_or_default();
    if args.fields.is_empty() {
        let own = model.output.pictures.iter();
        let own: Vec<PictureOf> = own
            .map(|picture| picture_of(model, picture, None))
            .collect();
        let written = |what: &PictureOf| {
            columns(what.field, dimension)
                .iter()
                .all(|name| data.field(name).is_some())
        };
        if own.iter().any(written) {
            return Ok(own.into_iter().filter(written).collect());
        }
        let damaged = data
            .field(Field::Damage.name())
            .is_some_and(|damage| damage.values.iter().any(|value| *value > 0.0));
        let field = if damaged {
            Field::Damage
        } else {
            Field::Displacement
        };
        let what = PictureOf {
            title,
            ..PictureOf::new(field)
        };
        return Ok(if written(&what) {
            vec![what]
        } else {
            Vec::new()
        });
    }
    let named = |name: &String| {
        let all = drawable(dimension);
        let has = |field: Field| {
            columns(field, dimension)
                .iter()
                .all(|name| data.field(name).is_some())
        };
        let written: Vec<&PictureOf> = all.iter().filter(|what| has(what.field)).collect();
        let found = written.iter().find(|what| what.name(dimension) == *name);
        let what = found.ok_or_else(|| {
            let names: Vec<String> = written.iter().map(|what| what.name(dimension)).collect();
            let listing = format!("the run wrote the fields {}", names.join(", "));
            let Some(left_out) = all.iter().find(|what| what.name(dimension) == *name) else {
                return RunError::unknown("field", name, &names, &listing);
            };
            let field = left_out.field.name();
            RunError::Unknown {
                kind: "field",
                name: name.clone(),
                hint: format!(
                    "{listing}; to write it, add \"{field}\" to the names of output.fields and run again"
                ),
            }
        })?;
        // If the deck has a picture of the field, use its view and range.
        let own = model
            .output
            .pictures
            .iter()
            .find(|picture| (picture.field, picture.component) == (what.field, what.component));
        Ok(match own {
            Some(own) => picture_of(model, own, None),
            None => PictureOf {
                title: title.clone(),
                ..(*what).clone()
            },
        })
    };
    args.fields.iter().map(named).collect()
}

/// Returns all fields, whole and by component.
fn drawable(dimension: usize) -> Vec<PictureOf> {
    let with = |field: Field, component| PictureOf {
        component,
        ..PictureOf::new(field)
    };
    let parts = |field: Field| {
        let components = 0..field.components(dimension).len();
        std::iter::once(with(field, None)).chain(components.map(move |c| with(field, Some(c))))
    };
    Field::ALL.into_iter().flat_map(parts).collect()
}

/// Returns the arrays of the files that hold a field.
fn columns(field: Field, dimension: usize) -> Vec<String> {
    if field.kind() != FieldKind::Tensor {
        return vec![field.name().to_owned()];
    }
    let components = field.components(dimension).iter();
    components
        .map(|component| format!("{}_{component}", field.name()))
        .collect()
}

/// The points, and the row of each point in the files.
struct Body {
    cloud: Arc<PointCloud>,
    rows: Vec<usize>,
    /// The output folder.
    folder: PathBuf,
    /// Names of the impactors.
    impactors: Vec<String>,
}

impl Body {
    fn draw(
        &self,
        what: &PictureOf,
        state: &FieldFile,
        data: &FieldData,
        path: &Path,
    ) -> Result<(), RunError> {
        let n = self.cloud.len();
        let displacement = match data.field(Field::Displacement.name()) {
            Some(_) => self.field(Field::Displacement, state, data)?,
            // Without a written displacement, points are shown in the reference configuration.
            None => vec![0.0; n * self.cloud.dimension()],
        };
        let field = self.field(what.field, state, data)?;
        let damage = match data.field(Field::Damage.name()) {
            Some(_) => Some(self.field(Field::Damage, state, data)?),
            None => None,
        };
        let drawn = DrawnState {
            t: state.time,
            displacement: &displacement,
            values: &what.numbers(&field, n),
            damage: damage.as_deref(),
            extent: None,
            impactors: &ImpactorSurfaces::read(&self.folder, &self.impactors, state.time)?,
        };
        Ok(what.draw_state(&self.cloud, &drawn, path)?)
    }

    /// Returns a field in the order of the points, component-major.
    fn field(
        &self,
        field: Field,
        state: &FieldFile,
        data: &FieldData,
    ) -> Result<Vec<f64>, RunError> {
        let damaged = |reason: String| RunError::Damaged {
            path: state.path.clone(),
            reason,
        };
        let (n, dimension) = (self.cloud.len(), self.cloud.dimension());
        if data.points.len() != 3 * n {
            return Err(damaged(format!(
                "it has {} points, but the body of the deck has {n}",
                data.points.len() / 3
            )));
        }
        let mut values = Vec::new();
        for name in columns(field, dimension) {
            let column = data
                .field(&name)
                .ok_or_else(|| damaged(format!("it has no array {name}")))?;
            let components = if column.components == 1 { 1 } else { dimension };
            for c in 0..components {
                let entries = self.rows.iter().map(|row| row * column.components + c);
                values.extend(entries.map(|entry| column.values[entry]));
            }
        }
        if let Some(active) = data.field(Field::Active.name()) {
            let active: Vec<f64> = self.rows.iter().map(|&row| active.values[row]).collect();
            leave_out_inactive(&mut values, &active);
        }
        Ok(values)
    }

    /// Returns the range of the values of several pictures, or `None` if they are constant.
    fn common_range(
        &self,
        what: &PictureOf,
        states: &[FieldFile],
        numbers: &[usize],
    ) -> Result<Option<[f64; 2]>, RunError> {
        let mut whole: Option<Extent> = None;
        for &number in numbers {
            let field = self.field(what.field, &states[number], &states[number].read()?)?;
            let extent = what.extent(&field, &what.numbers(&field, self.cloud.len()));
            whole = Some(whole.map_or(extent, |whole| whole.union(extent)));
        }
        Ok(whole.map(Extent::ends).filter(|[low, high]| low < high))
    }
}
