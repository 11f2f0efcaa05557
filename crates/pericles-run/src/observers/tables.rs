//! Tables over time that a model requests, written to files or kept in memory.

use std::sync::{Arc, Mutex, PoisonError};

use pericles::Simulation;
use pericles::observe::{CrackTracker, Probe, Schedule, TrackedCrack};
use pericles::space::PointCloud;
use pericles_deck::Model;
use pericles_io::CsvData;
use pericles_io::observers::{
    Cracks, EnergyBoundColumns, ErrorColumns, ForceDisplacement, FragmentCourse, History,
    HistoryRows, ProbeSignals, ReactionSignals, SignalTable, Signals, SurfaceCourse, TableTarget,
};
use pericles_manifold::surface::Surface;
use pericles_manifold::{EnergyInequality, SurfaceMeasure};

use crate::build::{Assembly, ExactReference};
use crate::error::RunError;
use crate::signals::{
    QuantitySignals, SignalRegistry, breaks_by_events, history_signals, impactor_signals,
};

/// A table of a run in memory.
#[derive(Debug, Clone)]
pub struct KeptTable {
    /// Its name, that of its file without the ending.
    pub name: String,
    /// The rows so far.
    pub rows: Arc<Mutex<CsvData>>,
}

/// The parts of an assembly that its tables need.
pub(super) struct TableParts {
    probes: Vec<Probe>,
    signals: Arc<SignalRegistry>,
    cracks: Vec<TrackedCrack>,
    exact: Option<ExactReference>,
    surface: Option<Arc<Surface>>,
}

impl TableParts {
    /// Takes the parts from an assembly.
    pub(super) fn take(assembly: &mut Assembly) -> Self {
        Self {
            probes: assembly.probes.clone(),
            signals: Arc::clone(&assembly.signals),
            cracks: assembly.cracks.clone(),
            exact: assembly.exact.take(),
            surface: assembly.surface.clone(),
        }
    }
}

/// Creates the simulation of an assembled model whose tables are kept in memory. Observers of fields and pictures are not
/// added.
///
/// # Errors
/// The simulation cannot be created.
pub fn recorded(
    model: &Model,
    mut assembly: Assembly,
) -> Result<(Simulation, Vec<KeptTable>), RunError> {
    let parts = TableParts::take(&mut assembly);
    let cloud = Arc::clone(&assembly.cloud);
    let mut simulation = assembly.simulation()?;
    let tables = Mutex::new(Vec::new());
    let target = |name: &str| {
        let rows: Arc<Mutex<CsvData>> = Arc::default();
        let mut tables = tables.lock().unwrap_or_else(PoisonError::into_inner);
        tables.push(KeptTable {
            name: name.trim_end_matches(".csv").to_owned(),
            rows: Arc::clone(&rows),
        });
        TableTarget::Memory(rows)
    };
    add_tables(model, parts, &cloud, &target, &mut simulation)?;
    let tables = tables.into_inner();
    Ok((simulation, tables.unwrap_or_else(PoisonError::into_inner)))
}

/// Adds the tables that a model requests; `target` returns the target of the table with a file name, and `cloud` are the points of
/// the whole body. Returns the history and the names of the files.
pub(super) fn add_tables(
    model: &Model,
    parts: TableParts,
    cloud: &PointCloud,
    target: &dyn Fn(&str) -> TableTarget,
    simulation: &mut Simulation,
) -> Result<(Arc<Mutex<History>>, Vec<String>), RunError> {
    let output = &model.output;
    let dimension = cloud.dimension();
    let can_break = simulation.system().operator().can_break();
    let rows = history_rows(model, simulation, parts.exact);
    let history = History::new(target("history.csv"), rows);
    let history = Arc::new(Mutex::new(history));
    simulation.observe(output.history.schedule, Box::new(Arc::clone(&history)));
    let mut names = vec!["history.csv".to_owned()];
    for (name, key, signals) in signal_tables(model, simulation, parts.probes, parts.signals) {
        names.push(name.into());
        let table = SignalTable::new(target(name), key, signals);
        simulation.observe(output.history.schedule, Box::new(table));
    }
    let loaded: Vec<String> = model.loads.iter().map(|load| load.set.clone()).collect();
    let acts = !simulation.system().motions().is_empty() || !loaded.is_empty();
    if model.time.scheme.is_static() && acts {
        names.extend(["force_displacement.csv", "force_displacement.png"].map(String::from));
        let title = model.title.clone().unwrap_or_default();
        let table = target("force_displacement.csv");
        let curve = ForceDisplacement::new(table, title, simulation.system(), &loaded);
        let curve = match breaks_by_events(model) {
            true => curve.event_driven(),
            false => curve,
        };
        simulation.observe(Schedule::Every(1), Box::new(curve));
    }
    if can_break && !parts.cracks.is_empty() {
        names.push("cracks.csv".into());
        let tracker = CrackTracker::new(cloud, parts.cracks, output.cracks.threshold)?;
        let cracks = Cracks::new(target("cracks.csv"), tracker, dimension);
        simulation.observe(output.cracks.schedule, Box::new(cracks));
    }
    if can_break && output.fragments.schedule != Schedule::Never {
        names.push("fragments.csv".into());
        let course = FragmentCourse::new(
            target("fragments.csv"),
            output.fragments.smallest,
            cloud.body_units(),
        );
        simulation.observe(output.fragments.schedule, Box::new(course));
    }
    if let Some(surface) = parts.surface {
        names.push("surface.csv".into());
        let course = SurfaceCourse::new(target("surface.csv"), SurfaceMeasure::new(surface));
        simulation.observe(output.history.schedule, Box::new(course));
    }
    Ok((history, names))
}

/// Returns the tables of signals: file, name of the length in checkpoints, content.
fn signal_tables(
    model: &Model,
    simulation: &Simulation,
    probes: Vec<Probe>,
    registry: Arc<SignalRegistry>,
) -> Vec<(&'static str, &'static str, Box<dyn Signals>)> {
    let mut tables: Vec<(_, _, Box<dyn Signals>)> = Vec::new();
    let system = simulation.system();
    let dimension = system.dimension();
    if let Some(impactors) = impactor_signals(model, system.cloud()) {
        tables.push(("impactors.csv", "observer/impactors", Box::new(impactors)));
    }
    if !system.motions().is_empty() {
        let reactions = ReactionSignals::new(system);
        tables.push(("reactions.csv", "observer/reactions", Box::new(reactions)));
    }
    if !probes.is_empty() {
        let probes = ProbeSignals { probes, dimension };
        tables.push(("probes.csv", "observer/probes", Box::new(probes)));
    }
    if registry.has_quantities() {
        let quantities = Box::new(QuantitySignals(registry));
        tables.push(("quantities.csv", "observer/quantities", quantities));
    }
    tables
}

/// Returns the rows of the history that a model requests; `exact` is the exact solution of its assembly, if it has one.
fn history_rows(
    model: &Model,
    simulation: &Simulation,
    exact: Option<ExactReference>,
) -> HistoryRows {
    let (output, cloud) = (&model.output, simulation.system().cloud());
    let [of_scheme, of_state] =
        history_signals(model, simulation.system(), simulation.integrator());
    let mut rows = HistoryRows::new(cloud);
    for signals in of_scheme {
        rows = rows.with_signals(signals);
    }
    if let Some(ExactReference { solution, points }) = exact {
        rows = rows.with(ErrorColumns::new(solution, points));
    }
    if let Some(time) = output.energy_bound {
        rows = rows.with(EnergyBoundColumns {
            inequality: EnergyInequality::new(1.0 / time),
            units: cloud.body_units(),
        });
    }
    for signals in of_state {
        rows = rows.with_signals(signals);
    }
    rows
}
