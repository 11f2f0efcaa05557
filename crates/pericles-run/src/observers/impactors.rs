//! Table and files of impactors.

use pericles::Simulation;
use pericles::observe::Schedule;
use pericles_deck::{FieldFormat, Model};
use pericles_io::OutputFolder;
use pericles_io::observers::{ImpactorSurfaces, SignalTable};

use crate::error::RunError;
use crate::signals::impactor_signals;

/// Adds the table and the files of impactors; returns their names relative to the folder.
pub(super) fn add_impactors(
    model: &Model,
    folder: &OutputFolder,
    simulation: &mut Simulation,
) -> Result<Vec<String>, RunError> {
    let output = &model.output;
    let Some(signals) = impactor_signals(model, simulation.system().cloud()) else {
        return Ok(Vec::new());
    };
    let impactors = signals.names.clone();
    let table = SignalTable::new(folder.file("impactors.csv"), "observer/impactors", signals);
    simulation.observe(output.history.schedule, Box::new(table));
    let mut names = vec!["impactors.csv".to_owned()];
    if output.fields.schedule != Schedule::Never
        && output.fields.formats.contains(&FieldFormat::Vtu)
    {
        let place = ImpactorSurfaces::FOLDER;
        folder.subfolder(place)?;
        for name in ImpactorSurfaces::file_names(&impactors) {
            names.extend([format!("{name}.pvd"), format!("{place}/{name}_*.vtp")]);
        }
        let surfaces = ImpactorSurfaces::new(folder.path(), &impactors);
        simulation.observe(output.fields.schedule, Box::new(surfaces));
    }
    Ok(names)
}
