//! Assembly of a model from its points and sets.

use std::sync::Arc;

use pericles::{System, check_compatibility};
use pericles_deck::{Body, BuildError, Deck, DeckError, Fault, Model};
use pericles_heat::DiffusingField;

use super::assembler::Assembler;
use super::assembly::Assembly;
use super::body::BodyParts;
use super::boundary::exterior_frequency;
use super::damping::strongest;
use super::discretisation::Discretisation;
use super::discretise::discretise;
use super::property::CONSTANT;
use super::rejection::{at, at_path};
use super::resources::Resources;
use crate::signals::SignalRegistry;

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
    let evaluated = Assembler::new(model).properties(&discretisation, resources)?;
    let (properties, model) = match &evaluated {
        Some((properties, model)) => (properties, model),
        None => (&CONSTANT, model),
    };
    let assembler = Assembler {
        model,
        cracks: &cracks,
        properties,
    };
    let mut warnings = discretisation.warnings.clone();
    let Discretisation {
        cloud,
        surface,
        sets,
        ..
    } = &discretisation;
    let mut parts = match (&model.body, surface) {
        (Body::Surface(body), Some(surface)) => {
            assembler.surface_parts(body, surface, &discretisation, resources, &mut warnings)?
        }
        (Body::Surface(_), None) => {
            let reason = "the points do not belong to a surface".into();
            return Err(at_path("body", Fault::BadDiscretisation { reason }));
        }
        (Body::Solid(solid), _) => assembler.grid_parts(solid, &discretisation, &mut warnings)?,
    };
    let place = &discretisation;
    let field = assembler.conduct(&parts, place, resources, &mut warnings)?;
    assembler.heat(&mut parts, place, resources, field.as_ref())?;
    let computed = field.as_ref().map(|field| Arc::new(field.shared()) as _);
    assembler.vary(&mut parts, place, resources, computed)?;
    let BodyParts {
        constants,
        others,
        bonds,
        cracks: tracked,
        density,
        softening,
    } = parts;
    assembler.check_cells(&discretisation)?;
    assembler.check_point_numbers(sets)?;
    warnings.extend(assembler.check_names(sets));
    warnings.extend(assembler.check_expansion());
    let mut system = System::new(Arc::clone(cloud), bonds.operator, density.clone())
        .map_err(|error| at("material.density", error))?;
    let temperature = field.as_ref().map(DiffusingField::shared);
    if let Some(field) = field {
        let added = system.add_field(Box::new(field));
        added.map_err(|error| at("thermal", error))?;
    }
    assembler.reject_fields(&system)?;
    let precut_bonds = bonds.cuts.iter().map(|cut| cut.bonds).sum();
    let state = assembler.first_state((&mut system, precut_bonds), cloud, resources);
    let mut state = discretisation.agreed(state)?;
    let changed = assembler.add_initial(cloud, sets, resources, &mut state);
    discretisation.agreed(changed)?;
    discretisation.conditions.start(&mut state)?;
    let exact = assembler.exact_reference(cloud, constants.as_ref(), &mut warnings)?;
    if let (Some(exact), Some(true)) = (&exact, model.exact.map(|exact| exact.start)) {
        exact
            .solution
            .displacement_into(0.0, cloud.axis(0), &mut state.u);
    }
    let areas = assembler.add_loads(&mut system, place, &mut warnings)?;
    discretisation.conditions.add_loads(&mut system)?;
    let continues = resources.start.continues();
    assembler.add_motions(&mut system, place, &state, continues)?;
    discretisation
        .conditions
        .add_motions(&mut system, &state.u)?;
    assembler.check_conditions(&system, cloud, &mut warnings);
    warnings.extend(assembler.check_idle_keys(&system));
    warnings.extend(assembler.check_dissipation(&system));
    if discretisation.conditions.is_empty() && !continues {
        warnings.extend(assembler.check_rest(system.domain(), &state));
    }
    let contact = assembler.add_contact(
        &mut system,
        (&discretisation, &state),
        (constants.as_ref(), &others),
        resources,
        &mut warnings,
    )?;
    let probes = assembler.point_probes(place, &mut warnings)?;
    let integrator = assembler.integrator(&system, sets, &probes)?;
    let ends = assembler.ends(&system, &state, sets, &*integrator, resources)?;
    assembler.check_open(cloud, &*integrator)?;
    let exterior = exterior_frequency(&ends);
    let layers = assembler.damping_layers(&density, constants.as_ref())?;
    let damping = strongest(&layers, cloud);
    let steps = assembler.steps(
        &system,
        &state,
        &*integrator,
        (exterior, damping),
        &mut warnings,
    )?;
    assembler.check_contact_step(
        (steps.dt, system.longest_contact_step()),
        contact,
        constants.as_ref(),
        cloud.spacing(),
        &mut warnings,
    );
    assembler.check_thermal_steps(&system, steps.dt)?;
    assembler.check_outputs(steps.dt, steps.count)?;
    assembler.check_two_steps(&*integrator, &steps, &mut warnings);
    assembler.check_initial_files(&system, &state, &mut warnings)?;
    assembler.check_breaking(&system, &state, constants.as_ref(), &steps, &mut warnings);
    let ends = assembler.add_ends(&mut system, ends, &state, &steps, resources, &mut warnings)?;
    assembler.add_damping_layers(&mut system, layers, integrator.step_kind(), &steps)?;
    let open = assembler.add_open(&mut system, &state, &steps)?;
    assembler.add_rayleigh_damping(&mut system, &*integrator)?;
    check_compatibility(&system, &*integrator, steps.count)
        .map_err(|error| at("time.scheme", error))?;
    discretisation.agreed(assembler.reject_lost_values(&system, &steps))?;
    if !system.domain().is_divided() {
        assembler.check_supports(&system, steps.count as f64 * steps.dt, &mut warnings);
    }
    let signals = SignalRegistry::of(model, (&system, &*integrator), &probes, &tracked)?;
    let signals = Arc::new(signals);
    let stops = assembler.stops(&system, sets, &signals)?;
    let loads = assembler.load_reports(&system, areas, steps.count as f64 * steps.dt);
    let Discretisation {
        cloud,
        surface,
        meshes,
        sets,
        ..
    } = discretisation;
    Ok(Assembly {
        cloud,
        surface,
        meshes,
        sets,
        constants,
        other_materials: others,
        softening,
        form: bonds.form,
        precut_bonds,
        cracks: tracked,
        system,
        state,
        origin: resources
            .start
            .origin()
            .map(|origin| (origin.path().to_path_buf(), origin.time())),
        integrator,
        frequency: steps.frequency,
        body_frequency: steps.body_frequency,
        dt: steps.dt,
        steps: steps.count,
        contact_frequency: (contact.frequency > 0.0).then_some(contact.frequency),
        probes,
        signals,
        ends,
        open,
        exact,
        stops,
        loads,
        temperature,
        warnings,
        properties: properties.ranges(),
        damping,
        allow_unstable: model.time.allow_unstable,
        model: evaluated.map(|(_, model)| model),
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
