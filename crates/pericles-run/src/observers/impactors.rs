//! Files of impactors.

use pericles::Simulation;
use pericles::observe::Schedule;
use pericles_deck::{FieldFormat, Model};
use pericles_io::OutputFolder;
use pericles_io::observers::ImpactorSurfaces;

use crate::error::RunError;
use crate::signals::impactor_signals;

/// Adds the surfaces of impactors over time; returns their names relative to the folder.
pub(super) fn add_impactor_surfaces(
    model: &Model,
    folder: &OutputFolder,
    simulation: &mut Simulation,
) -> Result<Vec<String>, RunError> {
    let output = &model.output;
    let Some(signals) = impactor_signals(model, simulation.system().cloud()) else {
        return Ok(Vec::new());
    };
    let impactors = signals.names;
    let mut names = Vec::new();
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
