//! Observers that write the output requested by a model.

mod body_shape;
mod impactors;
mod result_body;
mod tables;

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use pericles::Simulation;
use pericles::family::Crack;
use pericles::observe::Schedule;
use pericles::space::PointCloud;
use pericles_deck::{
    FieldFormat, Model, Picture, PictureColours, PictureFormat, PictureLook, Precision, TimeStep,
};
use pericles_io::observers::{
    CellMesh, FieldSeries, History, PictureOf, Pictures, Profile, ResultFile, ResultFormat,
    TableTarget,
};
use pericles_io::{ColourMap, OutputFolder, PictureStyle, Print};
use pericles_manifold::surface::Surface;

use crate::build::{Assembly, Meshes, Sets, gathered, is_on_grid};
use crate::checkpoint;
use crate::error::RunError;
use crate::origin;
use crate::signals::{breaks_by_events, scales_loads};

use self::impactors::add_impactor_surfaces;
use self::tables::{TableParts, add_tables};

pub use self::body_shape::body_shape;
pub(crate) use self::result_body::field_selection;
pub use self::result_body::result_body;
pub use self::tables::{KeptTable, recorded};

/// A simulation with the observers of a model.
pub(crate) struct Observed {
    pub simulation: Simulation,
    /// The energy balance over time.
    pub history: Arc<Mutex<History>>,
}

/// Creates the simulation of an assembled model with observers that write to a folder.
///
/// # Errors
/// Subfolders cannot be created.
pub(crate) fn observed(
    model: &Model,
    mut assembly: Assembly,
    folder: &OutputFolder,
) -> Result<Observed, RunError> {
    let parts = TableParts::take(&mut assembly);
    let body = FieldBody::of(&assembly, needs_whole_body(model, &assembly));
    let cloud = Arc::clone(&body.cloud);
    let mut simulation = assembly.simulation()?.of_whole(body.whole());
    let mut names = [
        "run.json",
        "report.html",
        "fields.html",
        "checkpoints/step-*.chk",
    ]
    .map(String::from)
    .to_vec();
    names.extend([checkpoint::FAILED, origin::START].map(|name| format!("checkpoints/{name}")));
    let target = |name: &str| TableTarget::File(folder.file(name));
    let (history, tables) = add_tables(model, parts, &cloud, &target, &mut simulation)?;
    names.extend(tables);
    names.extend(add_impactor_surfaces(model, folder, &mut simulation)?);
    names.extend(add_fields(model, folder, &body, &mut simulation)?);
    names.extend(add_profiles(model, folder, &cloud, &mut simulation)?);
    names.extend(add_pictures(model, folder, &body, &mut simulation)?);
    folder.claim(&names)?;
    Ok(Observed {
        simulation,
        history,
    })
}

/// Returns a picture requested by a model.
pub fn picture_of(model: &Model, picture: &Picture, surface: Option<&Arc<Surface>>) -> PictureOf {
    PictureOf {
        style: style_of(&picture.look),
        crop: picture.look.crop,
        component: picture.component,
        scale: picture.scale,
        range: picture.range,
        title: model.title.clone().unwrap_or_default(),
        view: picture.view,
        surface: surface.cloned(),
        progress: progress(model),
        ..PictureOf::new(picture.field)
    }
}

/// Returns the size and style of a picture of a deck.
fn style_of(look: &PictureLook) -> PictureStyle {
    let sized = match look.width {
        None => PictureStyle::default(),
        Some(width) => {
            let (font_size, dpi) = (look.font_size, look.dpi);
            PictureStyle::printed(width, Print { font_size, dpi })
        }
    };
    PictureStyle {
        titled: look.title,
        transparent: look.transparent,
        edges: look.edges,
        colours: look.colour_map.map(|colours| match colours {
            PictureColours::Viridis => ColourMap::Viridis,
            PictureColours::CoolToWarm => ColourMap::Diverging,
            PictureColours::Grey => ColourMap::Grey,
        }),
        ..sized
    }
}

/// Returns the name of the time of static states and the time of one unit (s): the load factor, which is one at the end, or the
/// load step if each step breaks a bond; none if the time is that of a controlled quantity.
fn progress(model: &Model) -> Option<(&'static str, f64)> {
    let end = model.time.end;
    match model.time.step {
        TimeStep::Equal(steps) if breaks_by_events(model) => {
            Some(("load step", end / steps as f64))
        }
        _ if scales_loads(model) => None,
        _ => model
            .time
            .scheme
            .is_static()
            .then_some(("load factor", end)),
    }
}

/// Returns the surfaces of the pre-cracks of an assembly.
pub(crate) fn cracks(assembly: &Assembly) -> Vec<Crack> {
    let cracks = assembly.cracks.iter();
    cracks.map(|tracked| tracked.crack.clone()).collect()
}

/// Returns whether the process that writes the output of a model needs the points of the whole body. For history, probes, reactions
/// and checkpoints it needs its own ones only.
fn needs_whole_body(model: &Model, assembly: &Assembly) -> bool {
    let output = &model.output;
    output.fields.schedule != Schedule::Never
        || !output.profiles.is_empty()
        || !output.pictures.is_empty()
        || !model.impactors.is_empty()
        || !assembly.cracks.is_empty()
        || model.exact.is_some()
}

/// Data of an assembly for field files: of the whole body on the process that writes them.
struct FieldBody {
    cloud: Arc<PointCloud>,
    /// Whether these are the points of a body divided among several processes.
    is_gathered: bool,
    sets: Sets,
    surface: Option<Arc<Surface>>,
    meshes: Arc<Meshes>,
    cracks: Vec<Crack>,
    dt: f64,
    steps: u64,
}

/// Cells of more points are written on request only, because their nodes double the size of a file of few fields.
const MOST_CELLS: usize = 1_000_000;

impl FieldBody {
    /// Collects the points and sets of the whole body on the process that writes the output, if it needs them. All processes must
    /// call it together.
    fn of(assembly: &Assembly, whole: bool) -> Self {
        let cloud = &assembly.cloud;
        let is_gathered = whole && cloud.domain().is_divided();
        let sets = assembly.sets.iter();
        Self {
            is_gathered: is_gathered && cloud.domain().is_first(),
            cloud: match is_gathered.then(|| cloud.gathered()).flatten() {
                Some(whole) => Arc::new(whole.into_owned()),
                None => Arc::clone(cloud),
            },
            sets: match is_gathered {
                true => sets
                    .map(|(name, set)| (name.clone(), gathered(cloud, set.clone())))
                    .collect(),
                false => assembly.sets.clone(),
            },
            surface: assembly.surface.clone(),
            meshes: Arc::clone(&assembly.meshes),
            cracks: cracks(assembly),
            dt: assembly.dt,
            steps: assembly.steps,
        }
    }
}

impl FieldBody {
    /// The points of the whole body, if it is divided and this process has them.
    fn whole(&self) -> Option<Arc<PointCloud>> {
        self.is_gathered.then(|| Arc::clone(&self.cloud))
    }

    /// The cells that fields are written on; none if they are written on points.
    fn cells(&self, model: &Model) -> Option<CellMesh> {
        let is_on_grid = is_on_grid(model, &self.cloud);
        let boxes = || is_on_grid.then(|| CellMesh::of_boxes(&self.cloud));
        match model.output.cells {
            Some(false) => None,
            Some(true) => self.meshes.cells_of_all(&self.cloud).or_else(boxes),
            None if self.cloud.len() > MOST_CELLS => None,
            None => boxes(),
        }
    }
}

/// Adds the requested field files; returns their names relative to the folder.
fn add_fields(
    model: &Model,
    folder: &OutputFolder,
    body: &FieldBody,
    simulation: &mut Simulation,
) -> Result<Vec<String>, RunError> {
    let output = &model.output;
    let mut names = Vec::new();
    if output.fields.schedule == Schedule::Never {
        return Ok(names);
    }
    let single = output.precision == Precision::Single;
    let selection = field_selection(model, &body.cloud, &body.sets);
    let mut one_file = |name: &str, format: ResultFormat| {
        let points = result_body(model, &body.cloud, &body.sets, &body.meshes);
        let path = folder.file(name);
        let file = ResultFile::new(path, format, Arc::new(points), selection.clone(), single);
        simulation.observe(output.fields.schedule, Box::new(file));
    };
    for format in &output.fields.formats {
        match format {
            FieldFormat::Vtu => {}
            FieldFormat::Exodus => {
                names.push("fields.exo".into());
                one_file("fields.exo", ResultFormat::Exodus);
            }
            FieldFormat::Vtkhdf => {
                names.extend(["fields.vtkhdf".into(), "fields.vtkhdf.part".into()]);
                let outputs = output.fields.schedule.most(body.dt, body.steps) as usize;
                one_file("fields.vtkhdf", ResultFormat::VtkHdf { outputs });
            }
        }
    }
    if output.fields.formats.contains(&FieldFormat::Vtu) {
        names.extend(["fields.pvd".into(), "fields/fields_*.vtu".into()]);
        folder.subfolder("fields")?;
        let mut fields = FieldSeries::new(folder.path(), single).with(selection.clone());
        if let Some(surface) = &body.surface {
            fields = fields.of_surface(surface.clone());
        }
        if let Some(cells) = body.cells(model) {
            fields = fields.on_cells(Arc::new(cells));
        }
        simulation.observe(output.fields.schedule, Box::new(fields));
    }
    if let (true, Some(cells)) = (output.fields.cells, body.meshes.cells()) {
        names.extend(["cells.pvd".into(), "cells/cells_*.vtu".into()]);
        folder.subfolder("cells")?;
        let fields = FieldSeries::new(folder.path(), single).with(selection.clone());
        let fields = fields.on_cells(Arc::new(cells)).as_second();
        simulation.observe(output.fields.schedule, Box::new(fields));
    }
    Ok(names)
}

/// Adds the requested profiles; returns their names relative to the folder.
fn add_profiles(
    model: &Model,
    folder: &OutputFolder,
    cloud: &PointCloud,
    simulation: &mut Simulation,
) -> Result<Vec<String>, RunError> {
    let mut names = Vec::new();
    for wanted in &model.output.profiles {
        let files = ["csv", "png"].map(|end| format!("profile_{}.{end}", wanted.name));
        let mut profile = Profile::new(
            files.each_ref().map(|file| folder.file(file)),
            model.title.clone().unwrap_or_default(),
            (wanted.field, wanted.component),
            [wanted.from, wanted.to],
            cloud,
        )?;
        if let Some(reference) = wanted.reference.clone() {
            profile = profile.with_reference(Box::new(move |x, t| reference.value(x, t)));
        }
        simulation.observe(Schedule::Count(1), Box::new(profile));
        names.extend(files);
    }
    Ok(names)
}

/// Adds the requested pictures; returns their names relative to the folder.
fn add_pictures(
    model: &Model,
    folder: &OutputFolder,
    body: &FieldBody,
    simulation: &mut Simulation,
) -> Result<Vec<String>, RunError> {
    if model.output.pictures.is_empty() {
        return Ok(Vec::new());
    }
    let mut names = Vec::new();
    let place = folder.subfolder("pictures")?;
    let FieldBody {
        cloud,
        sets,
        surface,
        meshes,
        cracks,
        ..
    } = body;
    let dimension = cloud.dimension();
    let shape = body_shape(model, cloud, sets, meshes, cracks).map(Arc::new);
    let mut uses: HashMap<String, u32> = HashMap::new();
    for picture in &model.output.pictures {
        let what = PictureOf {
            shape: shape.clone(),
            ..picture_of(model, picture, surface.as_ref())
        };
        // Several pictures of one field get distinct names.
        let uses = uses.entry(what.name(dimension)).or_default();
        *uses += 1;
        let stem = match *uses {
            1 => what.name(dimension),
            number => format!("{}_{number}", what.name(dimension)),
        };
        let ending = picture.look.format.ending();
        // Animations consist of PNG files.
        let is_animated = picture.animation && picture.look.format == PictureFormat::Png;
        names.push(format!("pictures/{stem}-*.{ending}"));
        if is_animated {
            names.push(format!("pictures/{stem}.apng"));
        }
        if what.has_own_range() {
            names.push(format!("pictures/.{stem}-*.state"));
        }
        let pictures = Pictures::new(&place, stem, what).with_ending(ending);
        let mut pictures = pictures.with_common_range(cloud.clone());
        if is_animated {
            pictures = pictures.animated();
        }
        simulation.observe(picture.schedule, Box::new(pictures));
    }
    Ok(names)
}
