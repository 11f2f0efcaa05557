//! Assembly of a model from its points and sets.

use pericles_deck::{BuildError, Deck, DeckError, Model};

use super::assembler::{Assembler, Warnings};
use super::assembly::Assembly;
use super::discretisation::Discretisation;
use super::discretise::discretise;
use super::property::CONSTANT;
use super::resources::Resources;
use super::stages::Placed;

/// Builds forces, conditions and scheme of a model on its points, and determines the time step. All processes that share a body
/// must call it together.
///
/// The run ends at `time.end` exactly: an automatic step is the largest stable one that divides the time; a given
/// step that does not divide it is reduced to the next one that does, with a warning. Expensive results are read from
/// the cache of the resources if available, and stored there otherwise.
///
/// # Errors
/// A value is out of range, the engine rejects a part of the model (reported at its key), the step is unstable, or
/// points, grids and sets are inconsistent.
pub fn assemble(
    model: &Model,
    discretisation: Discretisation,
    resources: &Resources<'_>,
) -> Result<Assembly, BuildError> {
    model.check()?;
    discretisation.check(&model.body)?;
    let cracks = discretisation.cracks.clone();
    let warnings = Warnings::default();
    let evaluated = Assembler::new(model, &warnings).properties(&discretisation, resources)?;
    let (properties, with_means) = match &evaluated {
        Some((properties, model)) => (properties, model),
        None => (&CONSTANT, model),
    };
    warnings.extend(discretisation.warnings.iter().cloned());
    let assembler = Assembler {
        model: with_means,
        cracks: &cracks,
        properties,
        warnings: &warnings,
    };
    let placed = Placed {
        assembler,
        place: discretisation,
        resources,
    };
    let assembly = placed.forced()?.loaded()?.timed()?.assembly()?;
    Ok(Assembly {
        model: evaluated.map(|(_, model)| model),
        ..assembly
    })
}

/// Discretises and assembles the model of a deck. Paths are relative to the folder of the deck, not the folder of the
/// resources.
///
/// # Errors
/// As [`discretise`] and [`assemble`], with locations in the text of the deck.
pub fn build(deck: &Deck, resources: &Resources<'_>) -> Result<Assembly, DeckError> {
    let resources = Resources {
        folder: deck.folder(),
        ..*resources
    };
    let assembly = discretise(&deck.model, &resources)
        .and_then(|discretisation| assemble(&deck.model, discretisation, &resources));
    assembly.map_err(|error| deck.rejection(error))
}
