//! From a deck to a model that can be run.

mod area;
mod boundary;
mod conditions;
mod content;
mod exact;
mod fields;
mod graded;
mod memory;
mod parts;
mod points;
mod resources;
mod scheme;
mod sense;
mod step;
mod surface;

pub use exact::ExactReference;

pub(crate) use memory::bytes;
pub use resources::{PointsReader, Resources, SurfaceReader};

use std::sync::Arc;

use pericles::boundary::absorbing::{EndReport, Side};
use pericles::material::BondConstants;
use pericles::observe::{Probe as PointProbe, TrackedCrack};
use pericles::operator::{AssembledBonds, BondBody, BondForm, CompositeBody};
use pericles::space::surface::Surface;
use pericles::space::{GradedCloud, PointCloud, PointSet};
use pericles::time::{HighestFrequency, Integrator, State};
use pericles::{PericlesError, PointScalar, Simulation, System};

use self::graded::Grids;
use self::parts::Composition;
use crate::caution::Caution;
use crate::deck::Deck;
use crate::error::DeckError;
use crate::fault::Fault;
use crate::finding::{Finding, Subject, Warning};
use crate::material::Inclusion;
use crate::reader::Path;
use crate::set::ALL;
use crate::surface::SurfaceDeck;

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
    pub form: BondForm,
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
    /// What is odd.
    pub warnings: Vec<Warning>,
}

/// What differs between bodies on a grid and surfaces.
struct Assembled {
    cloud: Arc<PointCloud>,
    surface: Option<Arc<Surface>>,
    sets: Sets,
    constants: BondConstants,
    parts: Vec<BondConstants>,
    bonds: AssembledBonds,
    cracks: Vec<TrackedCrack>,
    density: PointScalar,
}

impl Model {
    /// The largest stable step of the scheme, without a safety factor, s.
    pub fn stable_step(&self) -> Option<f64> {
        let limit = self.integrator.stability_limit()?;
        Some(self.frequency?.stable_step(limit, 1.0))
    }

    /// The run; observers are still to be added.
    pub fn simulation(self) -> Simulation {
        Simulation::new(
            self.system,
            self.integrator,
            self.state,
            self.dt,
            self.steps,
        )
    }
}

impl Deck {
    /// Makes points, bonds, operator and conditions, and finds the time step.
    ///
    /// With dt = "auto" the run ends at `time.end` exactly, in the fewest steps that are stable; with a given step it ends at the first step at or
    /// after it.
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
        let mut state = self.initial_state(&cloud, &sets)?;
        let exact = self.exact_reference(&cloud, constants.young, &mut warnings);
        if let (Some(exact), Some(true)) = (&exact, self.exact.map(|exact| exact.start)) {
            exact
                .solution
                .displacement_into(0.0, cloud.axis(0), &mut state.u);
        }
        self.add_loads(&mut system, &cloud, &sets)?;
        self.add_motions(&mut system, &state, &sets)?;
        self.judge_conditions(&system, &mut warnings);
        let probes = self.point_probes(&cloud, &sets, &mut warnings)?;
        let integrator = self.integrator(&system, &sets)?;
        let ends = self.ends(&system, &state, &sets, &*integrator, &resources)?;
        let exterior = boundary::exterior_frequency(&ends);
        let steps = self.steps(&system, &state, &*integrator, exterior, &mut warnings)?;
        self.judge_two_steps(&*integrator, &steps, &mut warnings);
        let ends = self.add_ends(&mut system, ends, &steps, &resources, &mut warnings)?;
        self.add_damping_layers(&mut system, &constants, &steps)?;
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
            dt: steps.dt,
            steps: steps.count,
            probes,
            ends,
            exact,
            warnings,
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
            None => Ok((self.points(&resources)?.cloud, None)),
        }
    }

    fn assemble_grid(
        &self,
        resources: &Resources<'_>,
        warnings: &mut Vec<Warning>,
    ) -> Result<Assembled, DeckError> {
        let GradedCloud {
            cloud,
            ratios,
            grid_of_point,
        } = self.points(resources)?;
        let cloud = Arc::new(cloud);
        let sets = self.select(&cloud)?;
        let material = &self.material.bonds;
        let constants = material
            .constants(&cloud, self.body.state)
            .map_err(|error| self.at_material(error))?;
        let no_fail = self.union_of(&sets, &self.material.no_fail)?;
        let stiffness = self.stiffness_of(&self.material.inclusions, &cloud, &sets)?;
        let Composition {
            classes,
            density,
            parts,
        } = self.parts(&cloud, &sets, &constants, warnings)?;
        let body = BondBody {
            cloud: &cloud,
            material,
            constants: &constants,
            cracks: &[],
            no_fail: &no_fail,
            stiffness: &stiffness,
            damage: self.material.damage,
        };
        let grids = Grids {
            ratios: &ratios,
            of_point: &grid_of_point,
        };
        let composite = CompositeBody {
            body,
            classes: classes.as_ref(),
            correction: self.material.surface_correction,
        };
        let (bonds, cracks) = self.bonds(composite, grids, warnings)?;
        if self.output.wants_tensors() && bonds.operator.as_bonds().is_none() {
            let error = PericlesError::FormNotUsable {
                form: bonds.form.name(),
                reason: "stress and strain are made of listed bonds: \"list\", or leave these fields out",
            };
            return Err(self.at("output", error));
        }
        Ok(Assembled {
            surface: None,
            sets,
            bonds,
            cracks,
            density,
            constants,
            parts,
            cloud,
        })
    }

    fn assemble_surface(
        &self,
        deck: &SurfaceDeck,
        resources: &Resources<'_>,
        warnings: &mut Vec<Warning>,
    ) -> Result<Assembled, DeckError> {
        let (surface, cloud) = self.surface_points(deck, resources)?;
        let cloud = Arc::new(cloud);
        let sets = self.select(&cloud)?;
        self.refuse_body_forces()?;
        let operator = self.surface_operator(deck, &surface, &cloud, &sets, resources.cache)?;
        let neighbours = operator.directed_bonds() as f64 / cloud.len() as f64;
        for caution in surface.cautions(deck.material.horizon, neighbours) {
            warnings.push(self.finding(&"material.horizon".into(), Caution::Surface(caution)));
        }
        Ok(Assembled {
            surface: Some(Arc::new(surface)),
            sets,
            bonds: AssembledBonds {
                operator,
                cuts: Vec::new(),
                form: BondForm::List,
            },
            cracks: Vec::new(),
            density: PointScalar::Uniform(deck.material.density),
            constants: BondConstants {
                young: f64::NAN,
                micromodulus: f64::NAN,
                critical_stretch: deck.material.critical_stretch,
                fracture_energy: f64::NAN,
                stiffness_error: f64::NAN,
            },
            parts: Vec::new(),
            cloud,
        })
    }

    fn select(&self, cloud: &PointCloud) -> Result<Sets, DeckError> {
        let mut sets = vec![(ALL.to_owned(), (0..cloud.len() as u32).collect())];
        let mut problems = Vec::new();
        for set in &self.sets {
            let points = set.members.of(cloud);
            if points.is_empty() {
                let fault = Fault::EmptySet {
                    set: set.name.clone(),
                };
                problems.push(self.finding(&Path::from("sets").key(&set.name), fault));
            }
            sets.push((set.name.clone(), points));
        }
        if problems.is_empty() {
            Ok(sets)
        } else {
            Err(DeckError::refused(problems))
        }
    }

    /// The points of the sets whose bonds never break.
    fn union_of(&self, sets: &Sets, names: &[String]) -> Result<PointSet, DeckError> {
        let mut points = PointSet::new();
        for name in names {
            points.extend(self.members(sets, name, &"material.no_fail".into())?);
        }
        points.sort_unstable();
        points.dedup();
        Ok(points)
    }

    /// Stiffness of each point over the material's; empty without inclusions.
    fn stiffness_of(
        &self,
        inclusions: &[Inclusion],
        cloud: &PointCloud,
        sets: &Sets,
    ) -> Result<Vec<f64>, DeckError> {
        let mut stiffness = vec![
            1.0;
            if inclusions.is_empty() {
                0
            } else {
                cloud.len()
            }
        ];
        for (k, inclusion) in inclusions.iter().enumerate() {
            let path = Path::from("material.inclusion").index(k);
            for &i in self.members(sets, &inclusion.set, &path)? {
                stiffness[i as usize] = inclusion.stiffness;
            }
        }
        Ok(stiffness)
    }

    /// The operator, and what the pre-cracks took from it.
    fn bonds(
        &self,
        composite: CompositeBody<'_>,
        grids: Grids<'_>,
        warnings: &mut Vec<Warning>,
    ) -> Result<(AssembledBonds, Vec<TrackedCrack>), DeckError> {
        let crack = |k| Path::from("crack").index(k);
        for (k, pre_crack) in self.cracks.iter().enumerate() {
            // The library tells what is wrong with a crack, not with which.
            pre_crack
                .surface
                .cutter(pre_crack.ends, 0.0)
                .map_err(|error| self.at_path(&crack(k), error.into()))?;
        }
        let cloud = composite.body.cloud;
        let surfaces: Vec<_> = self
            .cracks
            .iter()
            .map(|crack| (crack.surface.clone(), crack.ends))
            .collect();
        let composite = CompositeBody {
            body: BondBody {
                cracks: &surfaces,
                ..composite.body
            },
            ..composite
        };
        let assembled = if grids.ratios.len() > 1 {
            self.graded_bonds(&composite, grids)?
        } else {
            let form = match self.material.form {
                BondForm::Fastest if self.time.scheme.has_two_steps() && !self.body.periodic => {
                    composite.fastest_bonds()
                }
                BondForm::Fastest if self.output.wants_tensors() && !self.body.periodic => {
                    BondForm::List
                }
                BondForm::FloatGrid if !self.time.scheme.bears_rounding() => {
                    return Err(self.at_material(PericlesError::FormNotUsable {
                        form: BondForm::FloatGrid.name(),
                        reason: "this scheme needs forces in double precision; use \"grid\", or a Verlet or Runge–Kutta scheme with one step",
                    }));
                }
                form => form,
            };
            composite
                .operator(form)
                .map_err(|error| self.at_material(error))?
        };
        let mut tracked = Vec::new();
        for (k, ((surface, _), cut)) in surfaces.iter().zip(&assembled.cuts).enumerate() {
            if cut.bonds == 0 {
                let caution = Self::useless_crack(surface, cloud);
                warnings.push(self.finding(&crack(k), caution));
            }
            tracked.push(TrackedCrack {
                crack: surface.clone(),
                points: cut.points.clone(),
            });
        }
        Ok((assembled, tracked))
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
            PericlesError::BadConvolution { .. }
            | PericlesError::FormNotUsable { .. }
            | PericlesError::OneStencil => "material.bonds",
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
