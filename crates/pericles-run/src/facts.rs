//! Properties of a run before its first step, for reports, `check` and `run.json`.

use pericles::time::DevicePlan;
use pericles::units::BodyUnits;
use pericles_deck::{Body, Deck, LoadControl, Model, ModelWarning, Scheme};
use pericles_waves::absorbing::{EndReport, KernelMethod, Side};
use serde::Serialize;

use crate::build::{Assembly, LoadReport, MaterialConstants, PropertyRange, shown};
use crate::heat::HeatFacts;
use crate::open_facts::OpenFacts;
use crate::refinement::RefinementFacts;
use crate::strength::{SofteningFacts, StrengthFacts};
use crate::units::{bytes, count, quantity, significant, unit_per};

/// Properties of a run before its first step; SI units.
#[derive(Debug, Clone, Serialize)]
pub struct Facts {
    /// Dimension of the body.
    pub dimension: usize,
    /// Thickness, `m`, or area, `m2`, by which forces, energies, momenta and masses of the body are divided: if the deck gives
    /// none, they are those per metre or square metre.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub units_per: Option<&'static str>,
    /// Number of points.
    pub points: usize,
    /// Spacing of the points, m.
    pub spacing: f64,
    /// Horizon, m.
    pub horizon: f64,
    /// Mass of the body, kg.
    pub mass: f64,
    /// Number of bonds, each counted once, without those cut by pre-cracks.
    pub bonds: u64,
    /// Number of bonds, each counted from both ends.
    pub directed_bonds: u64,
    /// Number of bonds cut by pre-cracks, each counted once.
    pub precut_bonds: u64,
    /// Force kernel: grid or list.
    pub operator: &'static str,
    /// Young's modulus, Pa; `None` for a surface.
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio of state-based materials in two and three dimensions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poisson_ratio: Option<f64>,
    /// Bulk modulus, Pa, of state-based materials in two and three dimensions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bulk_modulus: Option<f64>,
    /// Shear modulus, Pa, of state-based materials in two and three dimensions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shear_modulus: Option<f64>,
    /// Bond constant c; `None` for surfaces and state-based materials.
    pub micromodulus: Option<f64>,
    /// Critical stretch; `None` if bonds do not break, or not by their stretch.
    pub critical_stretch: Option<f64>,
    /// Critical bond energy, J/m⁶; `None` if bonds do not break by their energy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub critical_bond_energy: Option<f64>,
    /// Fracture energy, J/m²; `None` if bonds do not break.
    pub fracture_energy: Option<f64>,
    /// Calibration of the critical stretch by the fracture energy; `None` if the deck has no fracture energy.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fracture_calibration: Option<&'static str>,
    /// Energies of cracks along lattice planes, if bonds break and the points form a lattice.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub crack_planes: Vec<PlaneFacts>,
    /// Softening and strengths of the materials whose bonds soften, the body's material first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub softening: Vec<SofteningFacts>,
    /// Strengths of the materials whose bonds are elastic until the stress reaches the strength, the body's material first.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub strength_failure: Vec<StrengthFacts>,
    /// Relative error of the bulk stiffness in the interior of the grid; zero for state-based materials, `None` for
    /// surfaces.
    pub stiffness_error: Option<f64>,
    /// Relative error of the stiffness in shear along the axes in the interior of the grid; `None` for surfaces.
    pub shear_error: Option<f64>,
    /// The same in shear along the diagonals, for state-based materials on square and cubic cells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub diagonal_shear_error: Option<f64>,
    /// Time step, s.
    pub dt: f64,
    /// Number of steps of the whole run.
    pub steps: u64,
    /// Quantity that controls the loads of a static run, and its rate, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control: Option<LoadControl>,
    /// Lower estimate of the highest frequency of the body, for any scheme, 1/s; `None` without stiffness.
    pub highest_frequency: Option<f64>,
    /// Upper bound of the highest frequency, which fails with the probability below, 1/s.
    pub highest_frequency_bound: Option<f64>,
    /// Probability that the bound fails.
    pub highest_frequency_failure_probability: Option<f64>,
    /// Whether estimate and bound agree to 2 %.
    pub frequency_converged: Option<bool>,
    /// Lower estimate of the frequency that limits the time step, 1/s: the highest, except for multirate schemes.
    pub limiting_frequency: Option<f64>,
    /// Upper bound of the limiting frequency, 1/s.
    pub limiting_frequency_bound: Option<f64>,
    /// Largest stable time step, s; `None` for unconditionally stable schemes.
    pub stable_step: Option<f64>,
    /// Estimated peak memory without output, bytes.
    pub memory_estimate: u64,
    /// Time integration scheme.
    pub scheme: &'static str,
    /// Properties of multirate schemes; `None` for other schemes.
    pub refinement: Option<RefinementFacts>,
    /// The loads, in the order of the deck.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub loads: Vec<LoadFacts>,
    /// Number of pieces that no bond joins.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pieces: Option<usize>,
    /// The highest frequency of a contact of two points, or of a point and an impactor, 1/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_frequency: Option<f64>,
    /// Heat conduction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heat: Option<HeatFacts>,
    /// Names of the impactors.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub impactors: Vec<String>,
    /// The absorbing boundaries.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ends: Vec<EndFacts>,
    /// The open boundary.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub open: Option<OpenFacts>,
    /// The state of another run from which the run starts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub start: Option<StartFacts>,
    /// The device that computes the steps, if it is not the processor of the machine.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device: Option<DeviceFacts>,
    /// Vector instruction set of the force loops.
    pub instruction_set: &'static str,
    /// Properties of materials that are functions.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub properties: Vec<PropertyFacts>,
    /// Warnings about the run.
    pub warnings: Vec<String>,
}

/// The device that computes the steps.
#[derive(Debug, Clone, Serialize)]
pub struct DeviceFacts {
    /// Name.
    pub name: String,
    /// Interface to the driver.
    pub interface: String,
    /// Precision: double or mixed.
    pub precision: &'static str,
    /// Why this precision.
    pub reason: &'static str,
    /// Memory that the run needs on it, bytes.
    pub memory: u64,
}

impl DeviceFacts {
    fn of(plan: &DevicePlan) -> Self {
        let DevicePlan {
            name,
            interface,
            precision,
            reason,
            memory,
        } = plan.clone();
        Self {
            name,
            interface,
            precision,
            reason,
            memory,
        }
    }

    /// Returns a summary line.
    pub fn line(&self) -> String {
        format!(
            "{} ({}), {} precision ({}), {} of its memory",
            self.name,
            self.interface,
            self.precision,
            self.reason,
            bytes(self.memory)
        )
    }
}

/// The state of another run from which a run starts.
#[derive(Debug, Clone, Serialize)]
pub struct StartFacts {
    /// The checkpoint.
    pub checkpoint: String,
    /// The time in the other run, s.
    pub t: f64,
}

impl StartFacts {
    /// Returns a summary line.
    pub fn line(&self) -> String {
        format!(
            "state of {} at t = {}",
            self.checkpoint,
            quantity(self.t, "s")
        )
    }
}

/// A property of a material that is a function; SI units.
#[derive(Debug, Clone, Serialize)]
pub struct PropertyFacts {
    /// The material; `None` if the body has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// The key.
    pub property: &'static str,
    /// Smallest value over the points of the material, at the temperatures of the start.
    pub least: f64,
    /// Mean value over these points.
    pub mean: f64,
    /// Largest value.
    pub most: f64,
    #[serde(skip)]
    unit: &'static str,
    #[serde(skip)]
    is_heated: bool,
}

impl PropertyFacts {
    fn of(range: &PropertyRange) -> Self {
        Self {
            material: range.material.clone(),
            property: range.key,
            least: range.least,
            mean: range.mean,
            most: range.most,
            unit: range.unit,
            is_heated: range.is_heated,
        }
    }

    /// Returns a summary line.
    pub fn line(&self) -> String {
        let [least, mean, most] =
            [self.least, self.mean, self.most].map(|value| shown(value, self.unit));
        let material = self.material.as_ref();
        let of = material.map_or_else(String::new, |name| format!(" of {name}"));
        let at = match self.is_heated {
            true => ", at the temperatures of the start",
            false => "",
        };
        format!("{}{of}: {least} to {most}, mean {mean}{at}", self.property)
    }
}

/// The energy of a crack along a lattice plane.
#[derive(Debug, Clone, Serialize)]
pub struct PlaneFacts {
    /// Miller indices, such as (110).
    pub plane: String,
    /// Relative deviation of the energy per area from the fracture energy.
    pub deviation: f64,
}

/// Resultant of a load; SI units.
#[derive(Debug, Clone, Serialize)]
pub struct LoadFacts {
    /// The loaded set.
    pub set: String,
    /// Number of points of the set.
    pub points: usize,
    /// Loaded area; `None` for body forces.
    pub area: Option<f64>,
    /// Largest resultant in the run, an entry per dimension.
    pub force: Vec<f64>,
    /// Time of the largest resultant.
    pub force_time: f64,
    #[serde(skip)]
    units: BodyUnits,
}

impl LoadFacts {
    fn of(load: &LoadReport, dimension: usize, units: BodyUnits) -> Self {
        Self {
            set: load.set.clone(),
            points: load.points,
            area: load.area,
            force: load.force[..dimension].to_vec(),
            force_time: load.at,
            units,
        }
    }

    /// Returns a summary line.
    pub fn line(&self) -> String {
        let force: Vec<String> = self
            .force
            .iter()
            .map(|f| self.units.quantity(*f, "N"))
            .collect();
        let area = self.area.map_or_else(String::new, |area| {
            format!(" on {} mm²", significant(1e6 * area, 4))
        });
        format!(
            "{}: {} points{area}; total force ({}), largest at t = {}",
            self.set,
            count(self.points as u64),
            force.join(", "),
            quantity(self.force_time, "s")
        )
    }
}

/// Properties of an absorbing boundary.
#[derive(Debug, Clone, Serialize)]
pub struct EndFacts {
    /// Side of the body.
    pub side: &'static str,
    /// Method for the kernels.
    pub method: &'static str,
    /// Representation of the history.
    pub history: &'static str,
    /// Memory of the history, bytes.
    pub memory: u64,
    /// Number of exponentials; `None` for exact histories.
    pub exponentials: Option<usize>,
    /// Error of the fit at its samples.
    pub residual: Option<f64>,
    /// Deviation from the exact kernels, with `verify`.
    pub distance: Option<f64>,
}

impl EndFacts {
    fn of((side, report): &(Side, EndReport)) -> Self {
        Self {
            side: side.name(),
            method: report.method.name(),
            history: report.history,
            memory: report.bytes as u64,
            exponentials: report.exponentials,
            residual: report.residual,
            distance: report.distance,
        }
    }

    /// Returns a summary line.
    pub fn line(&self) -> String {
        let mut line = format!("{}: {}, {}", self.side, self.history, bytes(self.memory));
        if self.method != KernelMethod::Discrete.name() {
            line += &format!(", {} kernels", self.method);
        }
        if let (Some(count), Some(residual)) = (self.exponentials, self.residual) {
            line += &format!(", {count} terms, error {}", significant(residual, 2));
        }
        if let Some(distance) = self.distance {
            line += &format!(
                ", deviation {} from the exact kernels",
                significant(distance, 2)
            );
        }
        line
    }
}

impl Facts {
    /// Returns the properties of an assembled model. Warnings name their keys. All processes that share the body must call it
    /// together.
    pub fn of(model: &Model, assembly: &Assembly) -> Self {
        let waves = assembly.check_waves(model);
        let warnings = assembly.warnings.iter().chain(&waves);
        Self::with(model, assembly, warnings.map(ModelWarning::line).collect())
    }

    fn with(model: &Model, assembly: &Assembly, warnings: Vec<String>) -> Self {
        let model = assembly.with_means(model);
        let operator = assembly.system.operator();
        let (domain, dimension) = (assembly.cloud.domain(), assembly.cloud.dimension());
        let points = domain.whole_points();
        let directed_bonds = domain.count(operator.directed_bonds());
        let units = assembly.cloud.body_units();
        let constants = assembly.constants.as_ref();
        let finite = |x: f64| x.is_finite().then_some(x);
        let bonds = constants.and_then(MaterialConstants::bonds);
        let state_based = constants.and_then(MaterialConstants::state_based);
        let elastic = state_based
            .filter(|_| dimension > 1)
            .map(|constants| constants.elastic);
        let shear = state_based.and_then(|constants| constants.lattice_shear);
        Self {
            dimension,
            units_per: units.per(),
            points,
            spacing: assembly.cloud.spacing(),
            horizon: model.body.horizon(),
            mass: assembly.system.mass(),
            bonds: directed_bonds / 2,
            directed_bonds,
            precut_bonds: assembly.precut_bonds,
            operator: assembly.form.name(),
            youngs_modulus: constants.map(MaterialConstants::young),
            poisson_ratio: elastic.map(|elastic| elastic.poisson_ratio()),
            bulk_modulus: elastic.map(|elastic| elastic.bulk()),
            shear_modulus: elastic.map(|elastic| elastic.shear()),
            micromodulus: bonds.map(|constants| constants.micromodulus),
            critical_stretch: match &model.body {
                Body::Solid(_) => {
                    constants.and_then(|constants| finite(constants.critical_stretch()))
                }
                Body::Surface(surface) => surface.material.critical_stretch,
            },
            critical_bond_energy: constants
                .and_then(|constants| finite(constants.critical_bond_energy())),
            fracture_energy: constants.and_then(|constants| finite(constants.fracture_energy())),
            fracture_calibration: constants
                .and_then(MaterialConstants::fracture_calibration)
                .map(|given| given.name()),
            crack_planes: constants.map(plane_facts).unwrap_or_default(),
            softening: SofteningFacts::of(model, assembly),
            strength_failure: StrengthFacts::of(model, assembly),
            stiffness_error: constants.map(|constants| match constants {
                MaterialConstants::Bonds(constants) => constants.stiffness_error,
                // The bulk stiffness is exact for any points.
                MaterialConstants::StateBased(_) | MaterialConstants::Correspondence(_) => 0.0,
            }),
            diagonal_shear_error: shear.map(|shear| shear.diagonals - 1.0),
            shear_error: bonds
                .map(|constants| constants.shear_error)
                .or(shear.map(|shear| shear.axes - 1.0)),
            dt: assembly.dt,
            steps: assembly.steps,
            control: match &model.time.scheme {
                Scheme::Static(options) => options.control.clone(),
                _ => None,
            },
            highest_frequency: assembly.body_frequency.map(|f| f.estimate),
            highest_frequency_bound: assembly.body_frequency.map(|f| f.bound),
            highest_frequency_failure_probability: assembly
                .body_frequency
                .map(|f| f.failure_probability),
            frequency_converged: assembly.body_frequency.map(|f| f.converged),
            limiting_frequency: assembly.frequency.map(|f| f.estimate),
            limiting_frequency_bound: assembly.frequency.map(|f| f.bound),
            stable_step: assembly.stable_step(),
            memory_estimate: assembly.memory_estimate(model),
            scheme: assembly.integrator.name(),
            refinement: RefinementFacts::of(model, assembly),
            loads: assembly
                .loads
                .iter()
                .map(|load| LoadFacts::of(load, dimension, units))
                .collect(),
            pieces: model
                .body
                .solid()
                .map(|solid| solid.shape.pieces().len())
                .filter(|&pieces| pieces > 0),
            contact_frequency: assembly.contact_frequency,
            heat: assembly.temperature.as_ref().map(HeatFacts::of),
            impactors: model.impactors.iter().map(|one| one.name.clone()).collect(),
            ends: assembly.ends.iter().map(EndFacts::of).collect(),
            open: (assembly.open.as_ref())
                .map(|open| OpenFacts::of(open, points, assembly.cloud.spacing())),
            start: assembly.origin.as_ref().map(|(path, t)| StartFacts {
                checkpoint: path.display().to_string(),
                t: *t,
            }),
            device: assembly.device.as_ref().map(DeviceFacts::of),
            instruction_set: operator.instruction_set().name(),
            properties: assembly.properties.iter().map(PropertyFacts::of).collect(),
            warnings,
        }
    }

    /// Returns the unit of a quantity of the body that has the given unit for the whole body.
    pub fn unit(&self, whole: &str) -> String {
        unit_per(whole, self.units_per)
    }

    /// Returns the properties of the assembly of a deck, with locations of warnings.
    pub fn of_deck(deck: &Deck, assembly: &Assembly) -> Self {
        let waves = assembly.check_waves(&deck.model);
        let warnings = assembly.warnings.iter().chain(&waves);
        let located = |warning: &ModelWarning| deck.located(warning.clone()).line();
        Self::with(&deck.model, assembly, warnings.map(located).collect())
    }
}

/// Returns the energies of cracks along lattice planes.
fn plane_facts(constants: &MaterialConstants) -> Vec<PlaneFacts> {
    let planes = constants.crack_planes().iter();
    let facts = planes.map(|plane| PlaneFacts {
        plane: plane.to_string(),
        deviation: plane.energy() / constants.fracture_energy() - 1.0,
    });
    facts.collect()
}
