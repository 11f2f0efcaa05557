//! Absorbing boundaries of a model.

use pericles::kernel::InfluenceFunction;
use pericles::space::PointCloud;
use pericles::sum::max_norm;
use pericles::time::{Integrator, State};
use pericles::{Need, PericlesError, System};
use pericles_deck::{
    ALL, BoundaryCondition, BuildError, Caution, Fault, KeyPath, ModelWarning, Remark, Solid,
};
use pericles_waves::absorbing::{
    AbsorbingBoundaryPlan, AbsorbingEnd, AbsorbingError, EndReport, FreeWave, LatticeScheme,
    LatticeStencil, LatticeStep, MidpointEnd, OuterLayer, Side, history::HistoryForm,
};

use super::assembler::Assembler;
use super::discretisation::Sets;
use super::rejection::{at, at_path};
use super::resources::Resources;
use super::step::Steps;

/// An absorbing boundary that is built once the time step is known.
pub(super) struct End {
    path: KeyPath,
    layer: OuterLayer,
    scheme: LatticeScheme,
    plan: AbsorbingBoundaryPlan,
    /// Displacements and velocities of the exterior sites.
    beyond: Option<[Vec<f64>; 2]>,
}

impl Assembler<'_> {
    /// Returns the outer layers at the absorbing boundaries.
    pub(super) fn ends(
        &self,
        system: &System,
        state: &State,
        sets: &Sets,
        integrator: &dyn Integrator,
        resources: &Resources<'_>,
    ) -> Result<Vec<End>, BuildError> {
        let no_fail = self.union_of(sets, self.model.body.no_fail())?;
        let mut ends = Vec::new();
        let mut sides: Vec<Side> = Vec::new();
        let mut exterior = 0.0;
        let mut requirements = integrator.requirements().iter();
        let free = requirements.find(|one| one.need == Need::NoBoundaries);
        if let (Some(requirement), false) = (free, self.model.boundaries.is_empty()) {
            let error = PericlesError::SchemeNotUsable {
                scheme: integrator.name(),
                reason: requirement.reason,
            };
            return Err(at("time.scheme", error));
        }
        for (k, boundary) in self.model.boundaries.iter().enumerate() {
            let path = KeyPath::from("boundary").index(k);
            let reject = |error| at_path(&path, PericlesError::from(error).into());
            let kind = integrator.step_kind();
            let wrong_scheme = |what, needed| {
                let error = PericlesError::BoundaryScheme {
                    what,
                    scheme: integrator.name(),
                    kind,
                    needed,
                };
                at("time.scheme", error)
            };
            let BoundaryCondition::Absorbing {
                side,
                plan,
                exterior_extent,
            } = *boundary
            else {
                continue;
            };
            let Some(scheme) = LatticeScheme::of(kind) else {
                return Err(wrong_scheme("an absorbing boundary", LatticeScheme::KINDS));
            };
            if scheme != LatticeScheme::VelocityVerlet && exterior_extent.is_some() {
                let what = "exterior_extent";
                return Err(reject(AbsorbingError::VerletOnly { what }));
            }
            if sides.contains(&side) {
                let side = side.name();
                return Err(reject(AbsorbingError::Twice { side }));
            }
            sides.push(side);
            let (layer, beyond) = match exterior_extent {
                None => (OuterLayer::of(system, side, state, &no_fail), None),
                Some(depth) => {
                    self.reject_initial_files()?;
                    exterior += depth / system.cloud().spacing();
                    self.check_exterior(&path.key("exterior_extent"), exterior, resources)?;
                    let layer = OuterLayer::with_motion_beyond(system, side, &no_fail);
                    (layer, Some(self.fields_beyond(side, depth, system.cloud())))
                }
            };
            ends.push(End {
                layer: layer.map_err(reject)?,
                path,
                scheme,
                plan,
                beyond,
            });
        }
        Ok(ends)
    }

    /// Rejects initial states from files if the initial fields extend beyond the body.
    fn reject_initial_files(&self) -> Result<(), BuildError> {
        let Some(k) = self
            .model
            .initial
            .iter()
            .position(|initial| initial.file.is_some())
        else {
            return Ok(());
        };
        let fault = Fault::Misplaced {
            key: "file".into(),
            table: "an [[initial]] of a deck with `exterior_extent`".into(),
            allowed: "a file has no values beyond the body; give `displacement` and `velocity` as expressions".into(),
        };
        Err(at_path(
            KeyPath::from("initial").index(k).key("file"),
            fault,
        ))
    }

    /// Evaluates the initial fields beyond a boundary; returns displacement and velocity of each site.
    fn fields_beyond(&self, side: Side, depth: f64, cloud: &PointCloud) -> [Vec<f64>; 2] {
        let spacing = cloud.spacing();
        let (last, step) = match side {
            Side::Left => (cloud.point(0), -spacing),
            Side::Right => (cloud.point(cloud.len() - 1), spacing),
        };
        let count = (depth / spacing).ceil() as usize;
        let mut fields = [vec![0.0; count], vec![0.0; count]];
        for initial in self
            .model
            .initial
            .iter()
            .filter(|initial| initial.set == ALL)
        {
            let given = [&initial.displacement, &initial.velocity];
            for (field, vector) in fields.iter_mut().zip(given) {
                let Some(vector) = vector else { continue };
                for (n, value) in field.iter_mut().enumerate() {
                    let x = last[0] + (n + 1) as f64 * step;
                    *value = vector[0].value([x, last[1], last[2]], 0.0);
                }
            }
        }
        fields
    }

    /// Builds the absorbing boundaries for the steps of the run.
    pub(super) fn add_ends(
        &self,
        system: &mut System,
        ends: Vec<End>,
        start: &State,
        steps: &Steps,
        resources: &Resources<'_>,
    ) -> Result<Vec<(Side, EndReport)>, BuildError> {
        /// Initial fields above this fraction at a boundary lead to a warning.
        const NOTABLE_FIELD: f64 = 1e-10;
        let largest = [&start.u, &start.v].map(max_norm);
        let mut reports = Vec::new();
        let mut sites = 0;
        for mut end in ends {
            let path = end.path;
            let reject = |error| at_path(&path, PericlesError::from(error).into());
            let stencil = end.layer.stencil.clone();
            let step = LatticeStep {
                scheme: end.scheme,
                dt: steps.dt,
            };
            step.check(&stencil).map_err(reject)?;
            if let Some(solid) = self.model.body.solid() {
                self.warnings
                    .extend(self.check_reach(solid, &stencil, system.cloud()));
            }
            let neglected = end.layer.neglected;
            if neglected > NOTABLE_FIELD {
                let side = end.layer.side.name();
                self.warn(
                    &path,
                    Caution::FieldAtEnd {
                        side,
                        share: neglected,
                    },
                );
            }
            let count = steps.count as usize;
            let own = stencil.reach() * if end.beyond.is_some() { 3 } else { 1 };
            if !end.plan.forgets() {
                sites += own;
                self.check_history(&path, sites, count as f64, resources)?;
            }
            let make =
                |plan: AbsorbingBoundaryPlan| plan.history(&stencil, step, count, resources.cache);
            let mut made = make(end.plan);
            if let Err(AbsorbingError::Fit {
                tolerance,
                residual,
                ..
            }) = made
            {
                if end.plan.forgets() {
                    sites += own;
                    self.check_history(&path, sites, count as f64, resources)?;
                }
                let caution = Caution::ExactHistory {
                    tolerance,
                    residual,
                };
                self.warn(path.key("history"), caution);
                end.plan.form = Some(HistoryForm::Blocked);
                made = make(end.plan);
            }
            let (history, report) = made.map_err(reject)?;
            if let Some(growth) = report.growth {
                self.warn(path.key("method"), Caution::HistoricalKernels { growth });
            }
            reports.push((end.layer.side, report));
            if end.scheme == LatticeScheme::Midpoint {
                let made = MidpointEnd::new(end.layer, history, steps.dt);
                system.add_boundary(Box::new(made.map_err(reject)?));
                continue;
            }
            let mut made = AbsorbingEnd::new(end.layer, history, steps.dt).map_err(reject)?;
            if let Some([u, v]) = &end.beyond {
                let another = || make(end.plan).map(|(history, _)| history).map_err(reject);
                let histories = [another()?, another()?];
                let wave = FreeWave::new(&stencil, steps.dt, [u, v], largest, histories);
                let reject = |error| {
                    at_path(
                        path.key("exterior_extent"),
                        PericlesError::from(error).into(),
                    )
                };
                made = made.with_free_wave(wave.map_err(reject)?);
            }
            system.add_boundary(Box::new(made));
        }
        Ok(reports)
    }

    /// Warns if the longest bonds of a table of classes have no stiffness: the exterior, derived from the bonds,
    /// lacks them.
    fn check_reach(
        &self,
        solid: &Solid,
        stencil: &LatticeStencil,
        cloud: &PointCloud,
    ) -> Option<ModelWarning> {
        let material = solid.material.bonds()?;
        if !matches!(material.influence.function, InfluenceFunction::Classes(_)) {
            return None;
        }
        let given = (material.horizon / cloud.spacing() + 1e-9).floor() as usize;
        let reach = stencil.reach();
        let caution = Caution::IdleClasses { given, reach };
        (reach < given).then(|| Remark::new("material.influence", caution))
    }
}

/// Returns the highest frequency of the exterior lattices, 1/s; 0 without absorbing boundaries.
pub(super) fn exterior_frequency(ends: &[End]) -> f64 {
    ends.iter()
        .map(|end| end.layer.stencil.highest_frequency())
        .fold(0.0, f64::max)
}
