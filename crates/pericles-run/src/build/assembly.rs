//! What is run: the equation of motion with its state, scheme and time step.

use std::sync::Arc;

use pericles::observe::{Probe as PointProbe, TrackedCrack};
use pericles::space::PointCloud;
use pericles::time::{HighestFrequency, Integrator, State};
use pericles::{PericlesError, Simulation, StopWhen, System};
use pericles_deck::ModelWarning;
use pericles_manifold::surface::Surface;
use pericles_waves::ForceForm;
use pericles_waves::absorbing::{EndReport, Side};

use super::constants::MaterialConstants;
use super::discretisation::Sets;
use super::exact::ExactReference;
use super::loads::LoadReport;
use super::mesh_body::MeshBody;
use super::step::damped_step;

/// A body ready to be run.
pub struct Assembly {
    /// The points.
    pub cloud: Arc<PointCloud>,
    /// The sets by name, "all" first.
    pub sets: Sets,
    /// The surface, if the body is one.
    pub surface: Option<Arc<Surface>>,
    /// The mesh, if the points are its elements.
    pub mesh: Option<Arc<MeshBody>>,
    /// The constants of the material; none for a surface, whose pair law has its own.
    pub constants: Option<MaterialConstants>,
    /// The constants of the materials beside the body's, in the order of [`Model::materials`](pericles_deck::Model::materials).
    pub other_materials: Vec<MaterialConstants>,
    /// How the bonds are kept.
    pub form: ForceForm,
    /// Bonds that pre-cracks cut.
    pub precut_bonds: u64,
    /// The pre-cracks in the order of the deck, for following their tips.
    pub cracks: Vec<TrackedCrack>,
    /// The equation of motion with loads and prescribed motions.
    pub system: System,
    /// The state at the start.
    pub state: State,
    /// The scheme.
    pub integrator: Box<dyn Integrator>,
    /// The frequency that limits the step at the start, the highest unless the scheme has two time steps; none if nothing resists motion, and the deck gives the step.
    pub frequency: Option<HighestFrequency>,
    /// The highest frequency of the body with its absorbing ends at the start, whatever the scheme.
    pub body_frequency: Option<HighestFrequency>,
    /// The time step, s.
    pub dt: f64,
    /// Number of steps.
    pub steps: u64,
    /// Where the motion is read.
    pub probes: Vec<PointProbe>,
    /// The absorbing ends.
    pub ends: Vec<(Side, EndReport)>,
    /// A known solution to compare with.
    pub exact: Option<ExactReference>,
    /// What the loads come to, in the order of the deck.
    pub loads: Vec<LoadReport>,
    /// Conditions that end the run before its last step.
    pub stops: Vec<StopWhen>,
    /// Warnings of the assembly.
    pub warnings: Vec<ModelWarning>,
    /// The strongest damping of layers, 1/s.
    pub(super) damping: f64,
    /// Whether the run goes on where its energy grows.
    pub(super) allow_unstable: bool,
}

impl Assembly {
    /// The largest stable step of the scheme, without a safety factor, s.
    pub fn stable_step(&self) -> Option<f64> {
        let limit = self.integrator.stability_limit()?;
        let undamped = self.frequency?.stable_step(limit, 1.0);
        Some(damped_step(undamped, self.damping))
    }

    /// The run; observers are still to be added.
    ///
    /// # Errors
    /// An assembly that was changed so that its parts no longer fit each other.
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
