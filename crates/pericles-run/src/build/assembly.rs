//! The assembled model: equation of motion, state, scheme and time step.

use std::path::PathBuf;
use std::sync::Arc;

use pericles::observe::{Probe as PointProbe, TrackedCrack};
use pericles::space::PointCloud;
use pericles::time::{DevicePlan, HighestFrequency, Integrator, State};
use pericles::{PericlesError, Simulation, StopWhen, System};
use pericles_deck::{Model, ModelWarning};
use pericles_heat::SharedField;
use pericles_manifold::surface::Surface;
use pericles_waves::ForceForm;
use pericles_waves::absorbing::{EndReport, Side};

use super::constants::MaterialConstants;
use super::discretisation::Sets;
use super::exact::ExactReference;
use super::loads::LoadReport;
use super::mesh_body::Meshes;
use super::open::OpenReport;
use super::property::PropertyRange;
use super::softening::MaterialSoftening;
use super::step::damped_step;
use crate::signals::SignalRegistry;

/// An assembled model, ready to run.
pub struct Assembly {
    /// The points; own points if the body is divided among several processes.
    pub cloud: Arc<PointCloud>,
    /// The sets of these points with their names, "all" first.
    pub sets: Sets,
    /// The surface, if the body is one.
    pub surface: Option<Arc<Surface>>,
    /// The meshes whose elements the points are.
    pub meshes: Arc<Meshes>,
    /// The constants of the material; `None` for a surface.
    pub constants: Option<MaterialConstants>,
    /// The constants of the other materials, in the order of [`Model::materials`](pericles_deck::Model::materials).
    pub other_materials: Vec<MaterialConstants>,
    /// Softening of all materials, the body's material first; `None` for bonds that do not soften, empty for other models.
    pub softening: Vec<Option<MaterialSoftening>>,
    /// The force kernel.
    pub form: ForceForm,
    /// Number of bonds cut by pre-cracks.
    pub precut_bonds: u64,
    /// The pre-cracks in the order of the deck, for tracking their tips.
    pub cracks: Vec<TrackedCrack>,
    /// The equation of motion with loads and prescribed motions.
    pub system: System,
    /// The initial state.
    pub state: State,
    /// The checkpoint of another run that the initial state comes from, and the time there, s.
    pub origin: Option<(PathBuf, f64)>,
    /// The scheme.
    pub integrator: Box<dyn Integrator>,
    /// What the processor of the steps needs, if it is not that of the machine.
    pub device: Option<DevicePlan>,
    /// The frequency that limits the step at the start: the highest, except for multirate schemes; `None` without
    /// stiffness, if the deck gives the step.
    pub frequency: Option<HighestFrequency>,
    /// The highest frequency of the body with its absorbing boundaries at the start, for any scheme.
    pub body_frequency: Option<HighestFrequency>,
    /// The time step, s.
    pub dt: f64,
    /// Number of steps.
    pub steps: u64,
    /// The highest frequency of a contact of two points, or of a point and an impactor, 1/s; `None` without contact.
    pub contact_frequency: Option<f64>,
    /// The probes.
    pub probes: Vec<PointProbe>,
    /// The scalars of the run by name.
    pub signals: Arc<SignalRegistry>,
    /// The absorbing boundaries.
    pub ends: Vec<(Side, EndReport)>,
    /// The open boundary.
    pub open: Option<OpenReport>,
    /// An exact solution for comparison.
    pub exact: Option<ExactReference>,
    /// Resultants of the loads, in the order of the deck.
    pub loads: Vec<LoadReport>,
    /// Conditions that end the run before its last step.
    pub stops: Vec<StopWhen>,
    /// The computed temperature; `None` without heat conduction.
    pub temperature: Option<SharedField>,
    /// Warnings of the assembly.
    pub warnings: Vec<ModelWarning>,
    /// Ranges of the properties of materials that are functions.
    pub properties: Vec<PropertyRange>,
    /// The strongest damping of layers, 1/s.
    pub(super) damping: f64,
    /// Whether the run continues if its energy grows.
    pub(super) allow_unstable: bool,
    /// The model with the mean values of properties that are functions; `None` without functions.
    pub(super) model: Option<Model>,
}

impl Assembly {
    /// Returns the assembled model with the mean values of properties that are functions.
    pub fn with_means<'a>(&'a self, model: &'a Model) -> &'a Model {
        self.model.as_ref().unwrap_or(model)
    }

    /// Returns the largest stable step of the scheme, without a safety factor, s.
    pub fn stable_step(&self) -> Option<f64> {
        let limit = self.integrator.stability_limit()?;
        let undamped = self.frequency?.stable_step(limit, 1.0);
        Some(damped_step(undamped, self.damping))
    }

    /// Converts the assembly into a simulation without observers.
    ///
    /// # Errors
    /// The parts of the assembly were changed and are inconsistent.
    pub fn simulation(self) -> Result<Simulation, PericlesError> {
        let (frequency, allow_unstable) = (self.frequency, self.allow_unstable);
        let mut simulation = Simulation::new(
            self.system,
            self.integrator,
            self.state,
            self.dt,
            self.steps,
        )?;
        for stop in self.stops {
            simulation.stop_when(stop)?;
        }
        if let Some(frequency) = frequency {
            simulation = simulation.with_frequency(frequency);
        }
        if allow_unstable {
            simulation = simulation.allowing_instability();
        }
        Ok(simulation)
    }
}
