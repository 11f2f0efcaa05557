//! The observers that a model asks for: what a simulation writes into its folder.

use std::collections::HashMap;
use std::sync::Arc;

use pericles::Simulation;
use pericles::observe::{CrackTracker, Schedule};
use pericles::space::PointCloud;
use pericles_deck::{ALL, FieldBlocks, FieldFormat, Model, Picture, Precision, Scheme};
use pericles_io::observers::{
    Cracks, EnergyBoundColumns, ErrorColumns, ExtremeColumns, FieldSeries, ForceDisplacement,
    FragmentCourse, History, InnerColumns, PictureOf, Pictures, Probes, Reactions, ResultFile,
    ResultFormat, SurfaceCourse,
};
use pericles_io::{OutputFolder, ResultBody};
use pericles_manifold::surface::Surface;
use pericles_manifold::{EnergyInequality, SurfaceMeasure};

use crate::build::{Assembly, ExactReference, MeshBody, Sets};
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
    let curve = (model.time.scheme.is_static() && reactions.is_some()).then(|| {
        ForceDisplacement::new(
            folder.file("force_displacement.csv"),
            folder.file("force_displacement.png"),
            model.title.clone().unwrap_or_default(),
            assembly.system.motions(),
        )
    });
    let (probes, cracks) = (assembly.probes.clone(), assembly.cracks.clone());
    let exact = assembly.exact.take();
    let surface = assembly.surface.clone();
    let body = FieldBody::of(&assembly);
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
            Scheme::Relaxation(_) | Scheme::Static(_) => InnerColumns::Residual,
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
    if let Some(curve) = curve {
        names.extend(["force_displacement.csv", "force_displacement.png"].map(String::from));
        simulation.observe(Schedule::Every(1), Box::new(curve));
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
    names.extend(add_fields(model, folder, &body, &mut simulation)?);
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

/// What files of fields need of an assembly.
struct FieldBody {
    cloud: Arc<PointCloud>,
    sets: Sets,
    surface: Option<Arc<Surface>>,
    mesh: Option<Arc<MeshBody>>,
    dt: f64,
    steps: u64,
}

impl FieldBody {
    fn of(assembly: &Assembly) -> Self {
        Self {
            cloud: assembly.cloud.clone(),
            sets: assembly.sets.clone(),
            surface: assembly.surface.clone(),
            mesh: assembly.mesh.clone(),
            dt: assembly.dt,
            steps: assembly.steps,
        }
    }
}

/// Adds the files of fields that a model asks for; their names, relative to the folder.
fn add_fields(
    model: &Model,
    folder: &OutputFolder,
    body: &FieldBody,
    simulation: &mut Simulation,
) -> Result<Vec<String>, RunError> {
    let output = &model.output;
    let mut names = Vec::new();
    if output.fields == Schedule::Never {
        return Ok(names);
    }
    let single = output.precision == Precision::Single;
    let mut one_file = |name: &str, format: ResultFormat| {
        let points = result_body(model, &body.cloud, &body.sets, body.mesh.as_deref());
        let path = folder.file(name);
        let file = ResultFile::new(path, format, Arc::new(points), &output.names, single);
        simulation.observe(output.fields, Box::new(file));
    };
    for format in &output.formats {
        match format {
            FieldFormat::Vtu => {}
            FieldFormat::Exodus => {
                names.push("fields.exo".into());
                one_file("fields.exo", ResultFormat::Exodus);
            }
            FieldFormat::Vtkhdf => {
                names.extend(["fields.vtkhdf".into(), "fields.vtkhdf.part".into()]);
                let outputs = output.fields.most(body.dt, body.steps) as usize;
                one_file("fields.vtkhdf", ResultFormat::VtkHdf { outputs });
            }
        }
    }
    if output.formats.contains(&FieldFormat::Vtu) {
        names.extend(["fields.pvd".into(), "fields/fields_*.vtu".into()]);
        folder.subfolder("fields")?;
        let mut fields = FieldSeries::new(folder.path(), single).with(&output.names);
        if let Some(surface) = &body.surface {
            fields = fields.of_surface(surface.clone());
        }
        simulation.observe(output.fields, Box::new(fields));
    }
    if let (true, Some(mesh)) = (output.cells, &body.mesh) {
        names.extend(["cells.pvd".into(), "cells/cells_*.vtu".into()]);
        folder.subfolder("cells")?;
        let fields = FieldSeries::new(folder.path(), single).with(&output.names);
        let fields = fields.on_cells(Arc::new(mesh.cells()));
        simulation.observe(output.fields, Box::new(fields));
    }
    Ok(names)
}

/// A body as files of results describe it, with the blocks that the model asks for.
pub fn result_body(
    model: &Model,
    cloud: &PointCloud,
    sets: &Sets,
    mesh: Option<&MeshBody>,
) -> ResultBody {
    let named = sets.iter().filter(|(name, _)| name != ALL);
    let named = named.map(|(name, points)| (name.as_str(), points.as_slice()));
    let title = model.title.clone().unwrap_or_default();
    match (model.output.blocks, model.body.solid()) {
        (FieldBlocks::Materials, Some(solid)) => {
            let own = solid.material.name();
            let (numbers, names) = material_blocks(model, own, cloud, sets);
            let name = |block: u32| names[block as usize - 1].to_owned();
            ResultBody::new(title, cloud, named, |i| numbers[i], name)
        }
        _ => {
            let name = |block: u32| {
                let group = mesh.and_then(|mesh| mesh.block_name(block));
                group.map_or_else(|| format!("block_{block}"), String::from)
            };
            ResultBody::new(title, cloud, named, |i| cloud.block(i), name)
        }
    }
}

/// The material of each point by its number, counted from 1, and the names of the materials, that of the body first.
fn material_blocks<'m>(
    model: &'m Model,
    own: &'m str,
    cloud: &PointCloud,
    sets: &Sets,
) -> (Vec<u32>, Vec<&'m str>) {
    let others = model.materials.iter().map(|other| other.name.as_str());
    let names: Vec<&str> = std::iter::once(own).chain(others).collect();
    let mut numbers = vec![1; cloud.len()];
    for assignment in &model.assignments {
        let material = assignment.material.as_deref();
        let Some(place) = names.iter().position(|name| Some(*name) == material) else {
            continue;
        };
        let is_assigned = |name: &String| assignment.sets.contains(name);
        for (_, points) in sets.iter().filter(|(name, _)| is_assigned(name)) {
            for &i in points {
                numbers[i as usize] = place as u32 + 1;
            }
        }
    }
    (numbers, names)
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
