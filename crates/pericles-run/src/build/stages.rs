//! The stages of an assembly: each one owns what the stages before it have built, and only it leads to the next one.
//!
//! [`Placed`] has the points, [`Forced`] the equation of motion of the free body with its initial state, [`Loaded`] all loads,
//! motions and contact, [`Timed`] the scheme, the time step and the boundaries that depend on it.

use std::sync::Arc;

use pericles::observe::{Probe, TrackedCrack};
use pericles::time::{Integrator, State};
use pericles::{PointScalar, System, check_compatibility};
use pericles_deck::{Body, BuildError, Fault};
use pericles_heat::{DiffusingField, SharedField};
use pericles_waves::ForceForm;
use pericles_waves::absorbing::{EndReport, Side};

use super::assembler::Assembler;
use super::assembly::Assembly;
use super::body::BodyParts;
use super::boundary::exterior_frequency;
use super::constants::MaterialConstants;
use super::contact::ContactFacts;
use super::damping::strongest;
use super::discretisation::Discretisation;
use super::exact::ExactReference;
use super::open::OpenReport;
use super::rejection::{at, at_path};
use super::resources::Resources;
use super::softening::MaterialSoftening;
use super::step::Steps;
use crate::signals::SignalRegistry;

/// A model with its points and sets.
pub(super) struct Placed<'a> {
    pub(super) assembler: Assembler<'a>,
    pub(super) place: Discretisation,
    pub(super) resources: &'a Resources<'a>,
}

/// The equation of motion of a body without conditions, and its initial state.
pub(super) struct Forced<'a> {
    placed: Placed<'a>,
    constants: Option<MaterialConstants>,
    others: Vec<MaterialConstants>,
    softening: Vec<Option<MaterialSoftening>>,
    density: PointScalar,
    cracks: Vec<TrackedCrack>,
    form: ForceForm,
    precut_bonds: u64,
    temperature: Option<SharedField>,
    exact: Option<ExactReference>,
    system: System,
    state: State,
}

/// A body with its loads, prescribed motions and contact.
pub(super) struct Loaded<'a> {
    body: Forced<'a>,
    /// The loaded areas of tractions, m².
    areas: Vec<Option<f64>>,
    contact: ContactFacts,
}

/// A body with its scheme, its time step, and the boundaries that depend on the step.
pub(super) struct Timed<'a> {
    loaded: Loaded<'a>,
    probes: Vec<Probe>,
    integrator: Box<dyn Integrator>,
    steps: Steps,
    ends: Vec<(Side, EndReport)>,
    open: Option<OpenReport>,
    /// The strongest damping of layers, 1/s.
    damping: f64,
}

impl<'a> Placed<'a> {
    /// Builds the forces, the computed temperature and the initial state.
    pub(super) fn forced(self) -> Result<Forced<'a>, BuildError> {
        let Self {
            assembler,
            ref place,
            resources,
        } = self;
        let mut parts = self.parts()?;
        let mut field = assembler.conduct(&parts, place, resources)?;
        assembler.heat(&mut parts, place, resources, field.as_ref())?;
        let temperature = field.as_ref().map(DiffusingField::shared);
        let computed = temperature.clone().map(|field| Arc::new(field) as _);
        assembler.vary(&mut parts, place, resources, computed)?;
        let activation = assembler.activation(place, resources, field.as_mut())?;
        let BodyParts {
            constants,
            others,
            bonds,
            cracks,
            density,
            softening,
        } = parts;
        assembler.check_cells(place)?;
        assembler.check_point_numbers(&place.sets)?;
        assembler
            .warnings
            .extend(assembler.check_names(&place.sets));
        assembler.warnings.extend(assembler.check_expansion());
        let cloud = &place.cloud;
        let mut system = System::new(Arc::clone(cloud), bonds.operator, density.clone())
            .map_err(|error| at("material.density", error))?;
        if let Some(field) = field {
            let added = system.add_field(Box::new(field));
            added.map_err(|error| at("thermal", error))?;
        }
        assembler.activate((&mut system, activation), resources)?;
        assembler.reject_fields(&system)?;
        let precut_bonds = bonds.cuts.iter().map(|cut| cut.bonds).sum();
        let state = assembler.first_state((&mut system, precut_bonds), cloud, resources);
        let mut state = place.agreed(state)?;
        let changed = assembler.add_initial(cloud, &place.sets, resources, &mut state);
        place.agreed(changed)?;
        place.conditions.start(&mut state)?;
        let exact = assembler.exact_reference(cloud, constants.as_ref())?;
        if let (Some(exact), Some(true)) = (&exact, assembler.model.exact.map(|exact| exact.start))
        {
            exact
                .solution
                .displacement_into(0.0, cloud.axis(0), &mut state.u);
        }
        Ok(Forced {
            constants,
            others,
            softening,
            density,
            cracks,
            form: bonds.form,
            precut_bonds,
            temperature,
            exact,
            system,
            state,
            placed: self,
        })
    }

    /// Builds the material and the force operator of the body.
    fn parts(&self) -> Result<BodyParts, BuildError> {
        let (assembler, place) = (self.assembler, &self.place);
        match (&assembler.model.body, &place.surface) {
            (Body::Surface(body), Some(surface)) => {
                assembler.surface_parts(body, surface, place, self.resources)
            }
            (Body::Surface(_), None) => {
                let reason = "the points do not belong to a surface".into();
                Err(at_path("body", Fault::BadDiscretisation { reason }))
            }
            (Body::Solid(solid), _) => assembler.grid_parts(solid, place),
        }
    }
}

impl<'a> Forced<'a> {
    /// Adds loads, prescribed motions and contact.
    pub(super) fn loaded(mut self) -> Result<Loaded<'a>, BuildError> {
        let Placed {
            assembler,
            ref place,
            resources,
        } = self.placed;
        let (system, state) = (&mut self.system, &self.state);
        let areas = assembler.add_loads(system, place)?;
        place.conditions.add_loads(system)?;
        let continues = resources.start.continues();
        assembler.add_motions(system, place, state, continues)?;
        place.conditions.add_motions(system, &state.u)?;
        assembler.check_conditions(system, &place.cloud);
        assembler.warnings.extend(assembler.check_idle_keys(system));
        assembler
            .warnings
            .extend(assembler.check_dissipation(system));
        if place.conditions.is_empty() && !continues {
            let still = assembler.check_rest(system.domain(), state);
            assembler.warnings.extend(still);
        }
        let constants = (self.constants.as_ref(), &self.others[..]);
        let contact = assembler.add_contact(system, (place, state), constants, resources)?;
        Ok(Loaded {
            body: self,
            areas,
            contact,
        })
    }
}

impl<'a> Loaded<'a> {
    /// Adds the scheme, the time step, and boundaries and damping.
    pub(super) fn timed(mut self) -> Result<Timed<'a>, BuildError> {
        let Forced {
            placed:
                Placed {
                    assembler,
                    ref place,
                    resources,
                },
            ref constants,
            ref density,
            ref mut system,
            ref state,
            ..
        } = self.body;
        let (cloud, sets, constants) = (&place.cloud, &place.sets, constants.as_ref());
        let probes = assembler.point_probes(place)?;
        let integrator = assembler.integrator(system, sets, &probes)?;
        let ends = assembler.ends(system, state, sets, &*integrator, resources)?;
        assembler.check_open(cloud, &*integrator)?;
        let exterior = exterior_frequency(&ends);
        let layers = assembler.damping_layers(density, constants)?;
        let damping = strongest(&layers, cloud);
        let steps = assembler.steps(system, state, &*integrator, (exterior, damping))?;
        let longest = (steps.dt, system.longest_contact_step());
        assembler.check_contact_step(longest, self.contact, constants, cloud.spacing());
        assembler.check_thermal_steps(system, steps.dt)?;
        assembler.check_outputs(steps.dt, steps.count)?;
        assembler.check_two_steps(&*integrator, &steps);
        assembler.check_initial_files(system, state)?;
        assembler.check_breaking(system, state, constants, &steps);
        let ends = assembler.add_ends(system, ends, state, &steps, resources)?;
        assembler.add_damping_layers(system, layers, integrator.step_kind(), &steps)?;
        let open = assembler.add_open(system, state, &steps)?;
        assembler.add_rayleigh_damping(system, &*integrator)?;
        check_compatibility(system, &*integrator, steps.count)
            .map_err(|error| at("time.scheme", error))?;
        place.agreed(assembler.reject_lost_values(system, &steps))?;
        if !system.domain().is_divided() {
            assembler.check_supports(system, steps.count as f64 * steps.dt);
        }
        Ok(Timed {
            loaded: self,
            probes,
            integrator,
            steps,
            ends,
            open,
            damping,
        })
    }
}

impl Timed<'_> {
    /// Adds the scalars over time and the conditions that end the run.
    pub(super) fn assembly(self) -> Result<Assembly, BuildError> {
        let Self {
            loaded:
                Loaded {
                    body,
                    areas,
                    contact,
                },
            probes,
            integrator,
            steps,
            ..
        } = self;
        let Placed {
            assembler,
            place,
            resources,
        } = body.placed;
        let model = assembler.model;
        let system = body.system;
        let signals = SignalRegistry::of(model, (&system, &*integrator), &probes, &body.cracks)?;
        let signals = Arc::new(signals);
        let stops = assembler.stops(&system, &place.sets, &signals)?;
        let loads = assembler.load_reports(&system, areas, steps.count as f64 * steps.dt);
        let origin = resources.start.origin();
        Ok(Assembly {
            cloud: place.cloud,
            surface: place.surface,
            meshes: place.meshes,
            sets: place.sets,
            constants: body.constants,
            other_materials: body.others,
            softening: body.softening,
            form: body.form,
            precut_bonds: body.precut_bonds,
            cracks: body.cracks,
            system,
            state: body.state,
            origin: origin.map(|origin| (origin.path().to_path_buf(), origin.time())),
            integrator,
            device: None,
            frequency: steps.frequency,
            body_frequency: steps.body_frequency,
            dt: steps.dt,
            steps: steps.count,
            contact_frequency: (contact.frequency > 0.0).then_some(contact.frequency),
            probes,
            signals,
            ends: self.ends,
            open: self.open,
            exact: body.exact,
            stops,
            loads,
            temperature: body.temperature,
            warnings: assembler.warnings.taken(),
            properties: assembler.properties.ranges(),
            damping: self.damping,
            allow_unstable: model.time.allow_unstable,
            model: None,
        })
    }
}
