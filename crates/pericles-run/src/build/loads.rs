//! Loads of a model, and what they come to.

use pericles::System;
use pericles::boundary::Load as BodyLoad;
use pericles::space::PointCloud;
use pericles_deck::{
    BuildError, Caution, Fault, KeyPath, Load, LoadAmplitude, ModelWarning, Remark, SolidShape,
    VectorField,
};

use super::area;
use super::assembler::Assembler;
use super::discretisation::Discretisation;
use super::refusal::{at, at_path};
use super::step::Steps;

/// What a load comes to.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadReport {
    /// The set.
    pub set: String,
    /// Points of the set.
    pub points: usize,
    /// The area that a traction acts on, m²; none for body forces.
    pub area: Option<f64>,
    /// The resultant when it is largest in the run, N.
    pub force: [f64; 3],
    /// When that is first so, s.
    pub at: f64,
}

impl Assembler<'_> {
    /// Adds the loads to the system; the area that each traction acts on.
    pub(super) fn add_loads(
        &self,
        system: &mut System,
        discretisation: &Discretisation,
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<Vec<Option<f64>>, BuildError> {
        let cloud = &*discretisation.cloud;
        let mesh = discretisation.mesh.as_deref();
        let mut areas = Vec::new();
        for (k, load) in self.model.loads.iter().enumerate() {
            let path = KeyPath::from("load").index(k);
            let sets = &discretisation.sets;
            let points = self.members(sets, &load.set, path.key("set"))?.clone();
            let function = load.function.function();
            let function = function.map_err(|fault| at_path(path.key("function"), fault))?;
            let volume: f64 = points.iter().map(|&i| cloud.volumes()[i as usize]).sum();
            let spread = |field: &VectorField, factor: f64| {
                self.load_density(&path, field, factor, cloud, &points)
            };
            let (density, area) = match &load.amplitude {
                LoadAmplitude::BodyForce(density) => (spread(density, 1.0)?, None),
                // On a surface a traction is the force per area itself.
                LoadAmplitude::Traction { traction, .. } if self.model.body.surface().is_some() => {
                    (spread(traction, 1.0)?, Some(volume))
                }
                LoadAmplitude::Traction { traction, area } => {
                    let area = match area.or_else(|| self.face_area(mesh, &load.set)) {
                        Some(area) => area,
                        None => {
                            let path = path.key("traction");
                            self.loaded_area(cloud, load, &points, traction, &path, warnings)?
                        }
                    };
                    (spread(traction, area / volume)?, Some(area))
                }
                LoadAmplitude::Pressure(pressure) => {
                    let made = self.pressure(&path, load, pressure, discretisation, &points);
                    let (density, area) = made?;
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
            system.add_load(load).map_err(|error| at(&path, error))?;
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
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<f64, BuildError> {
        let refuse = |reason| at_path(path, Fault::UnknownArea { reason });
        let shape = self.model.body.solid().map(|solid| &solid.shape);
        match shape {
            Some(SolidShape::Points(_)) if cloud.dimension() > 1 => {
                return Err(refuse("listed points have no faces"));
            }
            Some(SolidShape::Mesh(_)) => {
                return Err(refuse("the set is no face set of the mesh, nor near one"));
            }
            Some(shape) if shape.is_listed() && cloud.dimension() > 1 => {
                return Err(refuse("points off a lattice have no faces"));
            }
            _ => {}
        }
        let named = self.model.sets.iter().find(|named| named.name == load.set);
        let region = named.and_then(|named| named.members.region());
        let acts = std::array::from_fn(|c| traction[c].number() != Some(0.0));
        let axis = area::normal_axis(region, &acts).map_err(refuse)?;
        if !area::is_layer(region)
            && let Some(doubt) = area::doubt(cloud, points, axis)
        {
            warnings.push(Remark::new(path, Caution::LoadedArea(doubt)));
        }
        Ok(area::seen_along(cloud, points, axis))
    }

    /// Refuses loads and motions that have no finite value at a step of the run.
    pub(super) fn refuse_lost_values(
        &self,
        system: &System,
        steps: &Steps,
    ) -> Result<(), BuildError> {
        for (k, (given, load)) in self.model.loads.iter().zip(system.loads()).enumerate() {
            let is_finite = |t: f64| load.is_finite_at(t, system.dimension());
            if let Some(t) = first_lost(steps, &is_finite) {
                let (what, set) = ("load", given.set.clone());
                let path = KeyPath::from("load").index(k);
                return Err(at_path(&path, Fault::LostValue { what, set, t }));
            }
        }
        for (k, (given, motion)) in self
            .model
            .prescribe
            .iter()
            .zip(system.motions())
            .enumerate()
        {
            let is_finite = |t: f64| motion.is_finite_at(t);
            if let Some(t) = first_lost(steps, &is_finite) {
                let (what, set) = ("prescribed motion", given.set.clone());
                let path = KeyPath::from("prescribe").index(k);
                return Err(at_path(&path, Fault::LostValue { what, set, t }));
            }
        }
        Ok(())
    }

    /// What the loads of a system come to until `end`; `areas` are those that tractions act on.
    pub(super) fn load_reports(
        &self,
        system: &System,
        areas: Vec<Option<f64>>,
        end: f64,
    ) -> Vec<LoadReport> {
        let loads = self.model.loads.iter().zip(system.loads()).zip(areas);
        let report = |((given, load), area): ((&Load, &BodyLoad), Option<f64>)| {
            let (force, at) = largest(load, system.cloud(), end);
            LoadReport {
                set: given.set.clone(),
                points: load.points.len(),
                area,
                force,
                at,
            }
        };
        loads.map(report).collect()
    }
}

/// The first time of a run at which something is not finite, s, to within rounding; looked for at its steps, or among many of them.
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

/// The largest resultant of a load between 0 and `end`, N, among evenly spaced times, with the first of them, s.
fn largest(load: &BodyLoad, cloud: &PointCloud, end: f64) -> ([f64; 3], f64) {
    /// Samples: a divisible number, so that usual ramps and pulses have their ends and peaks among them.
    const MOST: usize = 240;
    /// Values that one load may cost; fields that change by themselves are evaluated anew at every time.
    const BUDGET: usize = 2_000_000;
    let samples = (BUDGET / load.points.len().max(1)).clamp(4, MOST);
    let size = |force: &[f64; 3]| force.iter().map(|f| f * f).sum::<f64>();
    let mut best = (load.resultant(0.0, cloud), 0.0);
    for k in 1..=samples {
        let t = end * k as f64 / samples as f64;
        let force = load.resultant(t, cloud);
        // A rounding more is no later peak.
        if size(&force) > size(&best.0) * (1.0 + 1e-9) {
            best = (force, t);
        }
    }
    best
}
