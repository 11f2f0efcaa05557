//! The observers that a model asks for: what a simulation writes into its folder.

use std::collections::HashMap;
use std::sync::Arc;

use pericles::Simulation;
use pericles::observe::{CrackTracker, Schedule};
use pericles_deck::{Model, Picture, Precision, Scheme};
use pericles_io::OutputFolder;
use pericles_io::observers::{
    Cracks, EnergyBoundColumns, ErrorColumns, ExtremeColumns, FieldSeries, FragmentCourse, History,
    InnerColumns, PictureOf, Pictures, Probes, Reactions, SurfaceCourse,
};
use pericles_manifold::surface::Surface;
use pericles_manifold::{EnergyInequality, SurfaceMeasure};

use crate::build::{Assembly, ExactReference};
use crate::checkpoint;
use crate::error::RunError;

/// The simulation of an assembled model with the observers it asks for, writing into a folder.
///
/// # Errors
/// Sub-folders that cannot be made.
pub fn simulation(
    model: &Model,
    mut assembly: Assembly,
    folder: &OutputFolder,
) -> Result<Simulation, RunError> {
    let (cloud, output) = (assembly.cloud.clone(), &model.output);
    let dimension = cloud.dimension();
    let can_break = assembly.system.operator().can_break();
    let reactions = (!assembly.system.motions().is_empty())
        .then(|| Reactions::new(folder.file("reactions.csv"), assembly.system.motions()));
    let (probes, cracks) = (assembly.probes.clone(), assembly.cracks.clone());
    let exact = assembly.exact.take();
    let surface = assembly.surface.clone();
    let mut simulation = assembly.simulation()?;
    let mut names = [
        "run.json",
        "report.html",
        "history.csv",
        "checkpoints/step-*.chk",
    ]
    .map(String::from)
    .to_vec();
    names.push(format!("checkpoints/{}", checkpoint::FAILED));

    let mut history = History::new(folder.file("history.csv"), dimension);
    if simulation.integrator().inner_iterations().is_some() {
        history = history.with(match model.time.scheme {
            Scheme::Relaxation(_) => InnerColumns::Residual,
            _ => InnerColumns::Velocity,
        });
    }
    if let Some(ExactReference { solution, points }) = exact {
        history = history.with(ErrorColumns::new(solution, points));
    }
    if let Some(rate) = output.energy_bound {
        history = history.with(EnergyBoundColumns(EnergyInequality::new(rate)));
    }
    if !output.extremes.is_empty() {
        history = history.with(ExtremeColumns::new(output.extremes.clone(), dimension));
    }
    simulation.observe(output.history, Box::new(history));
    if let Some(reactions) = reactions {
        names.push("reactions.csv".into());
        simulation.observe(output.history, Box::new(reactions));
    }
    if !probes.is_empty() {
        names.push("probes.csv".into());
        let probes = Probes::new(folder.file("probes.csv"), probes, dimension);
        simulation.observe(output.history, Box::new(probes));
    }
    if can_break && !cracks.is_empty() {
        names.push("cracks.csv".into());
        let tracker = CrackTracker::new(&cloud, cracks, output.cracks().threshold)?;
        let cracks = Cracks::new(folder.file("cracks.csv"), tracker, dimension);
        simulation.observe(output.cracks().schedule, Box::new(cracks));
    }
    if can_break && output.fragments.schedule != Schedule::Never {
        names.push("fragments.csv".into());
        let smallest = output.fragments.smallest;
        let course = FragmentCourse::new(folder.file("fragments.csv"), smallest);
        simulation.observe(output.fragments.schedule, Box::new(course));
    }
    if let Some(surface) = &surface {
        names.push("surface.csv".into());
        let measure = SurfaceMeasure::new(surface.clone());
        let course = SurfaceCourse::new(folder.file("surface.csv"), measure);
        simulation.observe(output.history, Box::new(course));
    }
    if output.fields != Schedule::Never {
        names.extend(["fields.pvd".into(), "fields/fields_*.vtu".into()]);
        folder.subfolder("fields")?;
        let single = output.precision == Precision::Single;
        let mut fields = FieldSeries::new(folder.path(), single).with(&output.names);
        if let Some(surface) = &surface {
            fields = fields.of_surface(surface.clone());
        }
        simulation.observe(output.fields, Box::new(fields));
    }
    names.extend(add_pictures(
        model,
        folder,
        surface.as_ref(),
        &mut simulation,
    )?);
    folder.claim(&names)?;
    Ok(simulation)
}

/// A picture that a model asks for.
pub fn picture_of(model: &Model, picture: &Picture, surface: Option<&Arc<Surface>>) -> PictureOf {
    PictureOf {
        component: picture.component,
        scale: picture.scale,
        range: picture.range,
        title: model.title.clone().unwrap_or_default(),
        view: picture.view,
        surface: surface.cloned(),
        ..PictureOf::new(picture.field)
    }
}

/// Adds the pictures that a model asks for; their files, relative to the folder.
fn add_pictures(
    model: &Model,
    folder: &OutputFolder,
    surface: Option<&Arc<Surface>>,
    simulation: &mut Simulation,
) -> Result<Vec<String>, RunError> {
    if model.output.pictures.is_empty() {
        return Ok(Vec::new());
    }
    let mut names = Vec::new();
    let place = folder.subfolder("pictures")?;
    let dimension = simulation.system().dimension();
    let mut uses: HashMap<String, u32> = HashMap::new();
    for picture in &model.output.pictures {
        let what = picture_of(model, picture, surface);
        // Two pictures of one field get two names.
        let uses = uses.entry(what.name(dimension)).or_default();
        *uses += 1;
        let stem = match *uses {
            1 => what.name(dimension),
            number => format!("{}_{number}", what.name(dimension)),
        };
        names.push(format!("pictures/{stem}-*.png"));
        if picture.animation {
            names.push(format!("pictures/{stem}.apng"));
        }
        let mut pictures = Pictures::new(&place, stem, what);
        if picture.animation {
            pictures = pictures.animated();
        }
        simulation.observe(picture.schedule, Box::new(pictures));
    }
    Ok(names)
}
