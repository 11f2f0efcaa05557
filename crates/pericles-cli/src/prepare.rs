//! From a model to a simulation with all its observers, and the facts about it that reports need.

use std::collections::HashMap;
use std::sync::Arc;

use pericles::Simulation;
use pericles::cache::{Cache, NoCache};
use pericles::material::{BondMaterial, Fracture, FractureCalibration, SurfaceCorrection};
use pericles::observe::{CrackTracker, Schedule};
use pericles_deck::{
    Deck, ExactReference, FileError, LoadReport, Model, Picture, Precision, Resources, Scheme,
};
use pericles_io::observers::{
    Cracks, EnergyBoundColumns, ErrorColumns, ExtremeColumns, FieldSeries, FragmentCourse, History,
    InnerColumns, PictureOf, Pictures, Probes, Reactions, SurfaceCourse,
};
use pericles_io::{
    DiskCache, IoError, MeshError, OutputFolder, PointsError, RowsError, read_points, read_rows,
    read_surface,
};
use pericles_manifold::surface::Surface;
use pericles_manifold::{EnergyInequality, SurfaceMeasure};
use pericles_waves::absorbing::{EndReport, KernelMethod, Side};
use serde::Serialize;

use crate::args::Caching;
use crate::checkpoint;
use crate::console;
use crate::error::CliError;
use crate::refinement::RefinementFacts;
use crate::units::{bytes, count, quantity, significant};

/// What is known about a run before its first step; SI units.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct Facts {
    pub(crate) dimension: usize,
    pub(crate) points: usize,
    pub(crate) spacing: f64,
    pub(crate) horizon: f64,
    /// Bonds, each counted once, after pre-cutting.
    pub(crate) bonds: u64,
    pub(crate) directed_bonds: u64,
    pub(crate) precut_bonds: u64,
    /// How the bonds are kept: grid or list.
    pub(crate) operator: &'static str,
    pub(crate) youngs_modulus: f64,
    pub(crate) micromodulus: f64,
    /// None if bonds never break.
    pub(crate) critical_stretch: Option<f64>,
    pub(crate) fracture_energy: Option<f64>,
    /// How the critical stretch follows from the fracture energy; none if the deck gives no fracture energy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) fracture_calibration: Option<&'static str>,
    /// Cracks along the planes of the lattice, if bonds break and there is a lattice.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) crack_planes: Vec<PlaneFacts>,
    /// Bulk stiffness of the grid's interior over the continuum's, less one.
    pub(crate) stiffness_error: f64,
    /// Stiffness of the grid's interior against a shear along its axes over the continuum's, less one.
    pub(crate) shear_error: f64,
    pub(crate) dt: f64,
    pub(crate) steps: u64,
    /// The body's highest frequency from below, whatever the scheme, 1/s. None if nothing resists motion.
    pub(crate) highest_frequency: Option<f64>,
    /// The same from above, but for the probability below, 1/s.
    pub(crate) highest_frequency_bound: Option<f64>,
    pub(crate) highest_frequency_failure_probability: Option<f64>,
    /// Whether both agree to 2 %.
    pub(crate) frequency_converged: Option<bool>,
    /// The frequency that limits the step, from below and from above, 1/s: the highest, except for schemes with two time steps.
    pub(crate) limiting_frequency: Option<f64>,
    pub(crate) limiting_frequency_bound: Option<f64>,
    pub(crate) stable_step: Option<f64>,
    /// The estimated peak, files and pictures not counted, bytes.
    pub(crate) memory_estimate: u64,
    pub(crate) scheme: &'static str,
    /// None for schemes with one time step.
    pub(crate) refinement: Option<RefinementFacts>,
    /// The loads, in the order of the deck.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) loads: Vec<LoadFacts>,
    /// The absorbing ends.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) ends: Vec<EndFacts>,
    pub(crate) instruction_set: &'static str,
    pub(crate) warnings: Vec<String>,
    /// Defaults that this deck relies on and that have changed since the last release.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) changed_defaults: Vec<String>,
}

/// What a crack along a plane of the lattice costs.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct PlaneFacts {
    /// Miller indices, such as (110).
    pub(crate) plane: String,
    /// Energy per area over the fracture energy, less one.
    pub(crate) deviation: f64,
}

/// What a load comes to; SI units.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct LoadFacts {
    pub(crate) set: String,
    pub(crate) points: usize,
    /// None for body forces.
    pub(crate) area: Option<f64>,
    /// The resultant when it is largest in the run, an entry per dimension.
    pub(crate) force: Vec<f64>,
    /// When that is first so.
    pub(crate) force_time: f64,
}

impl LoadFacts {
    fn of(load: &LoadReport, dimension: usize) -> Self {
        Self {
            set: load.set.clone(),
            points: load.points,
            area: load.area,
            force: load.force[..dimension].to_vec(),
            force_time: load.at,
        }
    }

    /// In a line.
    pub(crate) fn line(&self) -> String {
        let force: Vec<String> = self.force.iter().map(|f| quantity(*f, "N")).collect();
        let area = self.area.map_or_else(String::new, |area| {
            format!(" on {} mm²", significant(1e6 * area, 4))
        });
        format!(
            "{}: {} points{area}; total force ({}), largest at t = {}",
            self.set,
            count(self.points as u64),
            force.join(", "),
            quantity(self.force_time, "s")
        )
    }
}

/// How an absorbing end is made.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct EndFacts {
    pub(crate) side: &'static str,
    pub(crate) method: &'static str,
    pub(crate) history: &'static str,
    pub(crate) memory: u64,
    /// None for exact histories.
    pub(crate) exponentials: Option<usize>,
    /// Error of the fit on its samples.
    pub(crate) residual: Option<f64>,
    /// Distance from the exact kernels, where `verify` asks for it.
    pub(crate) distance: Option<f64>,
}

impl EndFacts {
    fn of((side, report): &(Side, EndReport)) -> Self {
        Self {
            side: side.name(),
            method: report.method.name(),
            history: report.history,
            memory: report.bytes as u64,
            exponentials: report.exponentials,
            residual: report.residual,
            distance: report.distance,
        }
    }

    /// In a line.
    pub(crate) fn line(&self) -> String {
        let mut line = format!("{}: {}, {}", self.side, self.history, bytes(self.memory));
        if self.method != KernelMethod::Discrete.name() {
            line += &format!(", {} kernels", self.method);
        }
        if let (Some(count), Some(residual)) = (self.exponentials, self.residual) {
            line += &format!(", {count} terms, error {residual:.1e}");
        }
        if let Some(distance) = self.distance {
            line += &format!(", {distance:.1e} from the exact kernels");
        }
        line
    }
}

impl Facts {
    /// The facts about a model of a deck.
    pub(crate) fn of(deck: &Deck, model: &Model) -> Self {
        let operator = model.system.operator();
        let (points, dimension) = (model.cloud.len(), model.cloud.dimension());
        let directed_bonds = operator.directed_bonds();
        let constants = &model.constants;
        let finite = |x: f64| x.is_finite().then_some(x);
        Self {
            dimension,
            points,
            spacing: model.cloud.spacing(),
            horizon: deck
                .surface
                .as_ref()
                .map_or(deck.material.bonds.horizon, |surface| {
                    surface.material.horizon
                }),
            bonds: directed_bonds / 2,
            directed_bonds,
            precut_bonds: model.precut_bonds,
            operator: model.form.name(),
            youngs_modulus: constants.young,
            micromodulus: constants.micromodulus,
            critical_stretch: finite(constants.critical_stretch),
            fracture_energy: finite(constants.fracture_energy),
            fracture_calibration: constants.fracture_calibration.map(|given| given.name()),
            crack_planes: constants
                .crack_planes
                .iter()
                .map(|plane| PlaneFacts {
                    plane: plane.to_string(),
                    deviation: plane.energy() / constants.fracture_energy - 1.0,
                })
                .collect(),
            stiffness_error: constants.stiffness_error,
            shear_error: constants.shear_error,
            dt: model.dt,
            steps: model.steps,
            highest_frequency: model.body_frequency.map(|f| f.estimate),
            highest_frequency_bound: model.body_frequency.map(|f| f.bound),
            highest_frequency_failure_probability: model
                .body_frequency
                .map(|f| f.failure_probability),
            frequency_converged: model.body_frequency.map(|f| f.converged),
            limiting_frequency: model.frequency.map(|f| f.estimate),
            limiting_frequency_bound: model.frequency.map(|f| f.bound),
            stable_step: model.stable_step(),
            memory_estimate: deck.memory_estimate(model),
            scheme: model.integrator.name(),
            refinement: RefinementFacts::of(deck, model),
            loads: model
                .loads
                .iter()
                .map(|load| LoadFacts::of(load, dimension))
                .collect(),
            ends: model.ends.iter().map(EndFacts::of).collect(),
            instruction_set: operator.instruction_set().name(),
            warnings: model
                .warnings
                .iter()
                .chain(&deck.judge_waves(model))
                .map(|w| w.line())
                .collect(),
            changed_defaults: changed_defaults(deck, model),
        }
    }
}

/// What this deck leaves to defaults that differ from those of the last release.
fn changed_defaults(deck: &Deck, model: &Model) -> Vec<String> {
    let mut changed = Vec::new();
    let (material, constants) = (&deck.material.bonds, &model.constants);
    let lattice = constants.fracture_calibration == Some(FractureCalibration::Lattice);
    if lattice && !deck.gives("material.fracture_calibration") {
        let continuum = BondMaterial {
            fracture: Fracture::Energy {
                energy: constants.fracture_energy,
                calibration: FractureCalibration::Continuum,
            },
            ..material.clone()
        };
        let before = continuum.constants(&model.cloud, deck.body.state);
        let before = before.map_or(f64::NAN, |constants| constants.critical_stretch);
        changed.push(format!(
            "fracture_calibration = \"lattice\" gives the critical stretch {}; \"continuum\", the former default, gives {}",
            significant(constants.critical_stretch, 4),
            significant(before, 4)
        ));
    }
    if deck.material.surface_correction == SurfaceCorrection::Energy {
        changed.push(
            "surface_correction = \"energy\" has factors for three directions at each point; formerly it had one for all directions"
                .into(),
        );
    }
    changed
}

/// What a model may be made with.
pub(crate) struct Means<'a> {
    pub(crate) caching: &'a Caching,
    /// Bytes.
    pub(crate) memory: u64,
}

/// The model of a deck; what is dear to compute comes from the cache if it is there.
///
/// # Errors
/// A deck that is refused.
pub(crate) fn model(deck: &Deck, means: &Means<'_>) -> Result<Model, CliError> {
    let cache = means.caching.cache();
    let cache = cache.map(|cache| cache.within(means.memory));
    let model = deck.build_with(Resources {
        cache: cache.as_ref().map_or(&NoCache as &dyn Cache, |cache| cache),
        memory: means.memory,
        ..readers()
    });
    for note in cache.iter().flat_map(DiskCache::notes) {
        console::note(format_args!("{note}"));
    }
    Ok(model?)
}

/// The simulation of a model with the observers the deck asks for, writing into a folder.
///
/// # Errors
/// Sub-folders that cannot be made.
pub(crate) fn simulation(
    deck: &Deck,
    mut model: Model,
    folder: &OutputFolder,
) -> Result<Simulation, CliError> {
    let (cloud, output) = (model.cloud.clone(), &deck.output);
    let dimension = cloud.dimension();
    let can_break = model.system.operator().can_break();
    let reactions = (!model.system.motions().is_empty())
        .then(|| Reactions::new(folder.file("reactions.csv"), model.system.motions()));
    let (probes, cracks) = (model.probes.clone(), model.cracks.clone());
    let exact = model.exact.take();
    let surface = model.surface.clone();
    let mut simulation = model.simulation();
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
        history = history.with(match deck.time.scheme {
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
        let tracker = CrackTracker::new(&cloud, cracks, output.cracks.threshold);
        let cracks = Cracks::new(folder.file("cracks.csv"), tracker, dimension);
        simulation.observe(output.cracks.schedule, Box::new(cracks));
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
        deck,
        folder,
        surface.as_ref(),
        &mut simulation,
    )?);
    folder.claim(&names)?;
    Ok(simulation)
}

/// A picture that a deck asks for.
pub(crate) fn picture_of(
    deck: &Deck,
    picture: &Picture,
    surface: Option<&Arc<Surface>>,
) -> PictureOf {
    PictureOf {
        component: picture.component,
        scale: picture.scale,
        range: picture.range,
        title: deck.title.clone().unwrap_or_default(),
        view: picture.view,
        surface: surface.cloned(),
        ..PictureOf::new(picture.field)
    }
}

/// What files beside a deck are read with.
pub(crate) fn readers() -> Resources<'static> {
    Resources {
        cache: &NoCache,
        read_surface: &|path, memory| {
            read_surface(path, memory).map_err(|error| match &error {
                MeshError::Io(IoError::TooLarge { .. }) => FileError::TooLarge(error.to_string()),
                _ => FileError::Wrong(error.to_string()),
            })
        },
        read_points: &|path, dimension, memory| {
            read_points(path, dimension, memory).map_err(|error| match &error {
                PointsError::Io(IoError::TooLarge { .. }) => FileError::TooLarge(error.to_string()),
                _ => FileError::Wrong(error.to_string()),
            })
        },
        read_table: &|path, rows, columns, memory| {
            read_rows(path, rows, columns, memory).map_err(|error| match &error {
                RowsError::Io(IoError::TooLarge { .. }) => FileError::TooLarge(error.to_string()),
                _ => FileError::Wrong(error.to_string()),
            })
        },
        ..Resources::default()
    }
}

/// Adds the pictures that a deck asks for; their files, relative to the folder.
fn add_pictures(
    deck: &Deck,
    folder: &OutputFolder,
    surface: Option<&Arc<Surface>>,
    simulation: &mut Simulation,
) -> Result<Vec<String>, CliError> {
    if deck.output.pictures.is_empty() {
        return Ok(Vec::new());
    }
    let mut names = Vec::new();
    let place = folder.subfolder("pictures")?;
    let dimension = simulation.system().dimension();
    let mut uses: HashMap<String, u32> = HashMap::new();
    for picture in &deck.output.pictures {
        let what = picture_of(deck, picture, surface);
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
