//! From a deck to a model that can be run.

mod area;
mod assemble;
mod boundary;
mod breaking;
mod conditions;
mod content;
mod damping;
mod exact;
mod fields;
mod graded;
mod loads;
mod memory;
mod parts;
mod plausible;
mod points;
mod resources;
mod scheme;
mod sense;
mod step;
mod stop;
mod surface;

pub use content::{KernelQuality, PlaneWaves};
pub use exact::ExactReference;
pub use loads::LoadReport;
pub use resources::{FileError, PointsReader, Resources, SurfaceReader, TableReader};

use std::sync::Arc;

use pericles::material::BondConstants;
use pericles::observe::{Probe as PointProbe, TrackedCrack};
use pericles::space::{PointCloud, PointSet};
use pericles::time::{HighestFrequency, Integrator, State};
use pericles::{PericlesError, Simulation, StopWhen, System};
use pericles_manifold::surface::Surface;
use pericles_waves::ForceForm;
use pericles_waves::absorbing::{EndReport, Side};
use pericles_waves::linear::NoConvolution;

use self::assemble::Assembled;
use crate::deck::Deck;
use crate::error::DeckError;
use crate::fault::Fault;
use crate::finding::{Finding, Warning};
use crate::reader::Path;
use crate::subject::Subject;

/// Sets of points by name.
pub type Sets = Vec<(String, PointSet)>;

/// A body ready to be run: what a deck describes.
pub struct Model {
    /// The points.
    pub cloud: Arc<PointCloud>,
    /// The sets by name, "all" first.
    pub sets: Sets,
    /// The surface, if the body is one.
    pub surface: Option<Arc<Surface>>,
    /// The constants of the bonds; not numbers for a surface.
    pub constants: BondConstants,
    /// The constants of the other materials, in the order of `[[material.part]]`.
    pub parts: Vec<BondConstants>,
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
    /// What is odd.
    pub warnings: Vec<Warning>,
    /// The strongest damping of layers, 1/s.
    damping: f64,
    /// Whether the run goes on where its energy grows.
    allow_unstable: bool,
}

impl Model {
    /// The largest stable step of the scheme, without a safety factor, s.
    pub fn stable_step(&self) -> Option<f64> {
        let limit = self.integrator.stability_limit()?;
        let undamped = self.frequency?.stable_step(limit, 1.0);
        Some(step::damped_step(undamped, self.damping))
    }

    /// The run; observers are still to be added.
    pub fn simulation(self) -> Simulation {
        let (frequency, allow_unstable) = (self.frequency, self.allow_unstable);
        let mut simulation = Simulation::new(
            self.system,
            self.integrator,
            self.state,
            self.dt,
            self.steps,
        );
        for stop in self.stops {
            simulation.stop_when(stop);
        }
        if let Some(frequency) = frequency {
            simulation = simulation.with_frequency(frequency);
        }
        if allow_unstable {
            simulation = simulation.allowing_instability();
        }
        simulation
    }
}

impl Deck {
    /// Makes points, bonds, operator and conditions, and finds the time step.
    ///
    /// The run ends at `time.end` exactly: with dt = "auto" in the fewest steps that are stable; a given step that does not divide it is shortened to the next one that
    /// does, with a warning.
    ///
    /// # Errors
    /// What the library refuses, at the entry of the deck that caused it; sets without points; a step that is not stable.
    pub fn build(&self) -> Result<Model, DeckError> {
        self.build_with(Resources::default())
    }

    /// The same; what is dear to compute and depends on few inputs is taken from the cache if it is there, and stored there if it is not, and surfaces are read from files.
    ///
    /// # Errors
    /// As [`Deck::build`].
    pub fn build_with(&self, resources: Resources<'_>) -> Result<Model, DeckError> {
        let mut warnings = Vec::new();
        let Assembled {
            cloud,
            surface,
            sets,
            constants,
            parts,
            bonds,
            cracks,
            density,
        } = match &self.surface {
            Some(deck) => self.assemble_surface(deck, &resources, &mut warnings)?,
            None => self.assemble_grid(&resources, &mut warnings)?,
        };
        let mut system = System::new(Arc::clone(&cloud), bonds.operator, density)
            .map_err(|error| self.at("material.density", error))?;
        let mut state = self.initial_state(&cloud, &sets, &resources)?;
        let exact = self.exact_reference(&cloud, constants.young, &mut warnings)?;
        if let (Some(exact), Some(true)) = (&exact, self.exact.map(|exact| exact.start)) {
            exact
                .solution
                .displacement_into(0.0, cloud.axis(0), &mut state.u);
        }
        let areas = self.add_loads(&mut system, &cloud, &sets, &mut warnings)?;
        self.add_motions(&mut system, &state, &sets)?;
        self.judge_conditions(&system, &mut warnings);
        warnings.extend(self.judge_idle_keys(&system));
        warnings.extend(self.judge_rest(&state));
        let probes = self.point_probes(&cloud, &sets, &mut warnings)?;
        let integrator = self.integrator(&system, &sets)?;
        let ends = self.ends(&system, &state, &sets, &*integrator, &resources)?;
        let exterior = boundary::exterior_frequency(&ends);
        let layers = self.damping_layers(&system, &constants)?;
        let damping = damping::strongest(&layers, &cloud);
        let integrated = &*integrator;
        let steps = self.steps(
            &system,
            &state,
            integrated,
            exterior,
            damping,
            &mut warnings,
        )?;
        self.judge_two_steps(&*integrator, &steps, &mut warnings);
        self.judge_breaking(&system, &state, &constants, &steps, &mut warnings);
        let ends = self.add_ends(&mut system, ends, &state, &steps, &resources, &mut warnings)?;
        self.add_damping_layers(&mut system, layers, &steps)?;
        self.refuse_lost_values(&system, &steps)?;
        let stops = self.stops(&system, &sets)?;
        let loads = self.load_reports(&system, areas, steps.count as f64 * steps.dt);
        Ok(Model {
            cloud,
            surface,
            sets,
            constants,
            parts,
            form: bonds.form,
            precut_bonds: bonds.cuts.iter().map(|cut| cut.bonds).sum(),
            cracks,
            system,
            state,
            integrator,
            frequency: steps.frequency,
            body_frequency: steps.body_frequency,
            dt: steps.dt,
            steps: steps.count,
            probes,
            ends,
            exact,
            stops,
            loads,
            warnings,
            damping,
            allow_unstable: self.time.allow_unstable,
        })
    }

    /// The points of the body alone, with the surface if it is one: what is needed to draw results again.
    ///
    /// # Errors
    /// As [`Deck::build_with`].
    pub fn body_points(
        &self,
        resources: Resources<'_>,
    ) -> Result<(PointCloud, Option<Surface>), DeckError> {
        match &self.surface {
            Some(deck) => {
                let (surface, cloud) = self.surface_points(deck, &resources)?;
                Ok((cloud, Some(surface)))
            }
            None => Ok((self.points(&resources, &mut Vec::new())?.cloud, None)),
        }
    }

    /// The points of a set. A deck read from a text names only sets it defines; one changed by a program may not.
    fn members<'s>(
        &self,
        sets: &'s Sets,
        name: &str,
        path: &Path,
    ) -> Result<&'s PointSet, DeckError> {
        let found = sets.iter().find(|(known, _)| known == name);
        found.map(|(_, points)| points).ok_or_else(|| {
            let allowed = sets.iter().map(|(known, _)| known.clone()).collect();
            self.at_path(
                path,
                Fault::UnknownWord {
                    what: "set",
                    value: name.into(),
                    nearest: None,
                    allowed,
                },
            )
        })
    }

    fn at_material(&self, error: PericlesError) -> DeckError {
        let path = match &error {
            PericlesError::BadInfluence { .. } => "material.influence",
            PericlesError::FormNotUsable { .. } | PericlesError::OneStencil => "material.bonds",
            _ if error.extension::<NoConvolution>().is_some() => "material.bonds",
            PericlesError::HorizonTooSmall { .. } | PericlesError::HorizonTooLarge { .. } => {
                self.horizon_key()
            }
            _ => "material",
        };
        self.at(path, error)
    }

    fn horizon_key(&self) -> &'static str {
        let [length, ratio] = ["material.horizon", "material.horizon_ratio"];
        if self.record.value(&length.into()).is_some() {
            length
        } else {
            ratio
        }
    }

    fn at(&self, path: &str, error: PericlesError) -> DeckError {
        self.at_path(&path.into(), error.into())
    }

    fn at_path(&self, path: &Path, fault: Fault) -> DeckError {
        DeckError::refused(vec![self.finding(path, fault)])
    }

    fn finding<S: Subject>(&self, path: &Path, subject: S) -> Finding<S> {
        let place = self.record.place(path);
        Finding::new(subject, self.record.sources.locate(place))
    }
}
