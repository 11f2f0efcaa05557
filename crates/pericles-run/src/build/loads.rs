//! Loads of a model and their resultants.

use pericles::System;
use pericles::boundary::Load as BodyLoad;
use pericles::space::PointCloud;
use pericles::units::quantity;
use pericles_deck::{
    BuildError, Caution, Fault, KeyPath, Load, LoadAmplitude, SolidShape, VectorField,
};

use super::area::{self, LoadedCells};
use super::assembler::Assembler;
use super::discretisation::Discretisation;
use super::rejection::{at, at_path};
use super::step::Steps;

/// The resultant of a load.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadReport {
    /// The set.
    pub set: String,
    /// Number of points of the set.
    pub points: usize,
    /// The loaded area of a traction, m²; `None` for body forces.
    pub area: Option<f64>,
    /// The largest resultant in the run, N.
    pub force: [f64; 3],
    /// The time of the largest resultant, s.
    pub at: f64,
}

impl Assembler<'_> {
    /// Adds the loads to the system; returns the loaded areas of tractions.
    pub(super) fn add_loads(
        &self,
        system: &mut System,
        discretisation: &Discretisation,
    ) -> Result<Vec<Option<f64>>, BuildError> {
        let cloud = &*discretisation.cloud;
        let mut areas = Vec::new();
        for (k, load) in self.model.loads.iter().enumerate() {
            let path = KeyPath::from("load").index(k);
            let sets = &discretisation.sets;
            let points = self.members(sets, &load.set, path.key("set"))?.clone();
            let function = load.function.function();
            let function = function.map_err(|fault| at_path(path.key("function"), fault))?;
            let volume = volume_of(cloud, &points);
            let spread = |field: &VectorField, factor: f64| {
                let density = self.load_density(&path, field, factor, cloud, &points);
                discretisation.agreed(density)
            };
            let (density, area) = match &load.amplitude {
                LoadAmplitude::BodyForce(density) => (spread(density, 1.0)?, None),
                // On a surface a traction is a force per area directly.
                LoadAmplitude::Traction { traction, .. } if self.model.body.surface().is_some() => {
                    (spread(traction, 1.0)?, Some(volume))
                }
                LoadAmplitude::Traction { traction, area } => {
                    let area =
                        match area.or_else(|| self.face_area(&discretisation.meshes, &load.set)) {
                            Some(area) => area,
                            None => {
                                let path = path.key("traction");
                                self.loaded_area(cloud, load, &points, traction, &path)?
                            }
                        };
                    (spread(traction, area / volume)?, Some(area))
                }
                LoadAmplitude::Pressure(pressure) => {
                    let made = self.pressure(&path, load, pressure, discretisation, &points);
                    let (density, area) = discretisation.agreed(made)?;
                    (density, Some(area))
                }
            };
            areas.push(area);
            let load = BodyLoad {
                points,
                density,
                function,
                window: load.window(),
            };
            let added = system.add_load(load).map_err(|error| at(&path, error));
            discretisation.agreed(added)?;
        }
        Ok(areas)
    }

    fn loaded_area(
        &self,
        cloud: &PointCloud,
        load: &Load,
        points: &[u32],
        traction: &VectorField,
        path: &KeyPath,
    ) -> Result<f64, BuildError> {
        let reject = |reason| at_path(path, Fault::UnknownArea { reason });
        let shape = self.model.body.solid().map(|solid| &solid.shape);
        match shape {
            Some(SolidShape::Points(_)) if cloud.dimension() > 1 => {
                return Err(reject("listed points have no faces"));
            }
            Some(SolidShape::Mesh(_)) => {
                return Err(reject(
                    "the set is neither a face set of the mesh nor near one",
                ));
            }
            Some(shape) if shape.is_listed() && cloud.dimension() > 1 => {
                return Err(reject("points without a lattice have no faces"));
            }
            _ => {}
        }
        let named = self.model.sets.iter().find(|named| named.name == load.set);
        let region = named.and_then(|named| named.members.region());
        let acts = std::array::from_fn(|c| traction[c].number() != Some(0.0));
        let axis = area::normal_axis(region, &acts).map_err(reject)?;
        let loaded = LoadedCells::new(cloud, points);
        if !area::is_layer(region)
            && let Some(caution) = loaded.caution(axis)
        {
            self.warn(path, Caution::LoadedArea(caution));
        }
        Ok(loaded.seen_along(axis))
    }

    /// Rejects loads and prescribed motions that are NaN or infinite at a step of the run.
    pub(super) fn reject_lost_values(
        &self,
        system: &System,
        steps: &Steps,
    ) -> Result<(), BuildError> {
        for (k, (given, load)) in self.model.loads.iter().zip(system.loads()).enumerate() {
            let is_finite = |t: f64| load.is_finite_at(t, system.dimension());
            if let Some(t) = first_lost(steps, &is_finite) {
                let path = KeyPath::from("load").index(k);
                return Err(at_path(&path, lost_value("load", &given.set, t)));
            }
        }
        for (k, (given, motion)) in self
            .model
            .constraints
            .iter()
            .zip(system.motions())
            .enumerate()
        {
            let is_finite = |t: f64| motion.is_finite_at(t);
            if let Some(t) = first_lost(steps, &is_finite) {
                let path = KeyPath::from("constraint").index(k);
                let fault = lost_value("prescribed motion", &given.set, t);
                return Err(at_path(&path, fault));
            }
        }
        Ok(())
    }

    /// Returns the resultants of the loads of a system until `end`; `areas` are the loaded areas of tractions.
    pub(super) fn load_reports(
        &self,
        system: &System,
        areas: Vec<Option<f64>>,
        end: f64,
    ) -> Vec<LoadReport> {
        let loads = self.model.loads.iter().zip(system.loads()).zip(areas);
        let report = |((given, load), area): ((&Load, &BodyLoad), Option<f64>)| {
            let points = system.domain().count(load.points.len() as u64) as usize;
            let (force, at) = largest((load, points), system, end);
            LoadReport {
                set: given.set.clone(),
                points,
                area,
                force,
                at,
            }
        };
        loads.map(report).collect()
    }
}

/// Returns the volume of a set, m³. All processes must call it together.
pub(super) fn volume_of(cloud: &PointCloud, points: &[u32]) -> f64 {
    let volumes = cloud.volumes();
    cloud
        .domain()
        .sum(points.len(), |k| volumes[points[k] as usize])
}

/// Returns the first time at which a value is not finite, s, to within rounding, sampled at all or many steps.
fn first_lost(steps: &Steps, is_finite: &dyn Fn(f64) -> bool) -> Option<f64> {
    const MOST: u64 = 2000;
    const HALVINGS: usize = 60;
    let samples = steps.count.min(MOST);
    let time = |k: u64| {
        let step = u128::from(k) * u128::from(steps.count) / u128::from(samples.max(1));
        step as f64 * steps.dt
    };
    let lost = (0..=samples).find(|&k| !is_finite(time(k)))?;
    if lost == 0 {
        return Some(0.0);
    }
    let (mut before, mut after) = (time(lost - 1), time(lost));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (before + after);
        if is_finite(middle) {
            before = middle;
        } else {
            after = middle;
        }
    }
    Some(after)
}

/// Returns the largest resultant of a load between 0 and `end`, N, over evenly spaced times, and its first time, s.
fn largest((load, points): (&BodyLoad, usize), system: &System, end: f64) -> ([f64; 3], f64) {
    /// Number of samples, with many divisors, so that ends and peaks of common ramps and pulses are sampled.
    const MOST: usize = 240;
    /// Maximum number of evaluations per load; fields that depend on time are evaluated at every sample.
    const BUDGET: usize = 2_000_000;
    let samples = (BUDGET / points.max(1)).clamp(4, MOST);
    let size = |force: &[f64; 3]| force.iter().map(|f| f * f).sum::<f64>();
    let cloud = system.cloud();
    let mut best = (load.resultant(0.0, cloud), 0.0);
    for k in 1..=samples {
        let t = end * k as f64 / samples as f64;
        let force = load.resultant(t, cloud);
        // An increase within rounding is not a later peak.
        if size(&force) > size(&best.0) * (1.0 + 1e-9) {
            best = (force, t);
        }
    }
    best
}

/// Creates the error for a load or prescribed motion that becomes NaN or infinite at a time (s).
fn lost_value(what: &str, set: &str, t: f64) -> Fault {
    Fault::other(
        "not finite",
        format!(
            "the {what} on `{set}` has no finite value at t = {}, within the run",
            quantity(t, "s")
        ),
        "change the expression, or end the run or the load (`until`) earlier; the expression, and for motions its derivatives, must be finite throughout the run",
    )
}
