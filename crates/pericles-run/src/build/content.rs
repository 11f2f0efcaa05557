//! Plane waves in a deck's body: what the kernel and the grid do to them, and which loads, motions and initial values send out waves that the grid distorts.

use pericles::boundary::MotionKind;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{BondConstants, BondMaterial};
use pericles_deck::{
    BuildError, Caution, Component, Fault, KeyPath, Model, ModelWarning, Remark, Solid, TimeHistory,
};
use pericles_dispersion::DispersionError;
use pericles_dispersion::{
    BondLattice, KernelWaves, PhaseErrors, Resolved, space_content, stability, time_content,
};

use super::assembler::Assembler;
use super::assembly::Assembly;
use super::refusal::{HORIZON, at, at_path};

/// Deviation of the phase speed from which waves count as distorted.
const TOLERANCE: f64 = 0.05;

/// Share of the energy from which a warning is due.
const SHARE: f64 = 0.05;

/// What a deck's body does to plane waves of any direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneWaves {
    /// The shortest wave (m) whose phase speed in the nonlocal continuum is within [`Resolved::tolerance`] of `grid` of that of long waves; none for coefficients per class of bonds, which
    /// have no continuum.
    pub model: Option<f64>,
    /// The shortest waves whose phase speed on the grid is within the tolerance of that in the nonlocal continuum, or of that of long waves where there is no continuum.
    pub grid: Resolved,
    /// For tuned coefficients: how they do and how a constant influence function would do.
    pub tuning: Option<[KernelQuality; 2]>,
}

/// How well a kernel carries waves on its grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KernelQuality {
    /// Spacings per wavelength from which on the phase speed is within 1 % of that of long waves.
    pub spacings: f64,
    /// The largest relative error of the phase speed down to [`KernelQuality::SHORTEST`] spacings per wavelength.
    pub worst: f64,
}

impl KernelQuality {
    /// Spacings per wavelength down to which kernels are compared.
    pub const SHORTEST: f64 = 4.0;

    fn of(lattice: &BondLattice) -> Self {
        let errors = PhaseErrors::new(lattice);
        // The zone ends at two spacings per wavelength.
        let end = errors.end();
        Self {
            spacings: 2.0 * end / errors.resolved(0.01).wavenumber,
            worst: errors.largest(2.0 * end / Self::SHORTEST),
        }
    }
}

impl Assembly {
    /// The interior of the body: what plane waves know of it.
    ///
    /// # Errors
    /// A body whose points lie on no regular grid.
    pub fn interior<'a>(&'a self, model: &'a Model) -> Result<Interior<'a>, BuildError> {
        Assembler::new(model).interior(self)
    }

    /// What the body does to plane waves; none for bodies that lie on no grid or are of several materials.
    pub fn plane_waves(&self, model: &Model) -> Option<PlaneWaves> {
        Assembler::new(model).plane_waves(self)
    }

    /// Warns of kernels that do not keep what they are made for, and of loads, motions and initial values whose waves the grid distorts. What
    /// the nonlocal model itself does to short waves is no matter of the grid and not warned of. Bodies that lie on no grid, or are of several
    /// materials, are not judged.
    pub fn judge_waves(&self, model: &Model) -> Vec<ModelWarning> {
        Assembler::new(model).judge_waves(self)
    }
}

/// The interior of a body on a grid; of several materials the first one.
pub struct Interior<'a> {
    /// The bonds of a point.
    pub lattice: BondLattice,
    /// The body.
    pub solid: &'a Solid,
    /// Its bond-based material.
    pub material: &'a BondMaterial,
    /// The constants of the bonds.
    pub constants: &'a BondConstants,
}

impl<'a> Assembler<'a> {
    fn interior(self, assembly: &'a Assembly) -> Result<Interior<'a>, BuildError> {
        let Some(solid) = self.model.body.solid() else {
            return Err(at("body", DispersionError::NoLattice.into()));
        };
        let Some((material, constants)) = bonds_of(solid, assembly) else {
            let fault = Fault::OutOfRange {
                value: solid.material.model_name().into(),
                allowed: "allowed: a bond-based model, whose lattice is one of single bonds".into(),
            };
            return Err(at_path("material.model", fault));
        };
        let lattice = self.lattice_of(solid, assembly, material, constants);
        let lattice = lattice.map_err(|error| match error.extension() {
            Some(DispersionError::NoLattice) => at("body", error),
            _ => at(HORIZON, error),
        })?;
        Ok(Interior {
            lattice,
            solid,
            material,
            constants,
        })
    }

    fn lattice_of(
        &self,
        solid: &Solid,
        assembly: &Assembly,
        material: &BondMaterial,
        constants: &BondConstants,
    ) -> pericles::Result<BondLattice> {
        match solid.shape.rectangular() {
            Some(spacing) => {
                BondLattice::of_material(spacing, solid.shape.section(), material, constants)
            }
            None => BondLattice::of_body(&assembly.cloud, material, constants),
        }
    }

    /// What the body does to plane waves; none for bodies that lie on no grid or are of several materials.
    fn plane_waves(self, assembly: &Assembly) -> Option<PlaneWaves> {
        let solid = self.model.body.solid()?;
        let (material, constants) = bonds_of(solid, assembly)?;
        if !self.model.materials.is_empty() {
            return None;
        }
        let lattice = self.lattice_of(solid, assembly, material, constants).ok()?;
        let (horizon, end) = (material.horizon, PhaseErrors::new(&lattice).end());
        let kernel = KernelWaves::new(lattice.dimension(), &material.influence, horizon, end);
        let (model_length, grid) = match &kernel {
            Some(kernel) => (
                Some(std::f64::consts::TAU / kernel.resolved(TOLERANCE, end)),
                PhaseErrors::of_grid(&lattice, kernel).resolved(TOLERANCE),
            ),
            None => (None, PhaseErrors::new(&lattice).resolved(TOLERANCE)),
        };
        let tuning = solid.material.tuned.as_ref().and_then(|_| {
            let constant = BondMaterial {
                influence: Influence {
                    function: InfluenceFunction::Constant,
                    ..material.influence.clone()
                },
                ..material.clone()
            };
            let constant = self
                .lattice_of(solid, assembly, &constant, constants)
                .ok()?;
            Some([KernelQuality::of(&lattice), KernelQuality::of(&constant)])
        });
        Some(PlaneWaves {
            model: model_length,
            grid,
            tuning,
        })
    }

    /// Warns of kernels that do not keep what they are made for, and of loads, motions and initial values whose waves the grid distorts. What the nonlocal model itself does to short waves
    /// is no matter of the grid and not warned of. Bodies that lie on no grid, or are of several materials, are not judged.
    fn judge_waves(self, assembly: &Assembly) -> Vec<ModelWarning> {
        let body = self.model.body.solid();
        let Some((solid, waves)) = body.zip(self.plane_waves(assembly)) else {
            return Vec::new();
        };
        let mut warnings = self.judge_kernel(solid, assembly, &waves);
        if self.model.time.scheme.is_static() {
            return warnings;
        }
        let carried = waves.grid;
        let mut judge = |path: &KeyPath, what: &'static str, share: f64| {
            if share > SHARE {
                let caution = Caution::ShortWaves {
                    what,
                    share,
                    tolerance: TOLERANCE,
                    nonlocal: waves.model.is_some(),
                    period: std::f64::consts::TAU / carried.frequency,
                    length: std::f64::consts::TAU / carried.wavenumber,
                };
                warnings.push(Remark::new(path, caution));
            }
        };
        let state = &assembly.state;
        for (what, field, strain) in [
            ("initial displacement", &state.u, true),
            ("initial velocity", &state.v, false),
        ] {
            let share = space_content(&assembly.cloud, field, carried.wavenumber, strain);
            judge(&"initial".into(), what, share.unwrap_or(0.0));
        }
        let end = assembly.steps as f64 * assembly.dt;
        let in_time = |g: &dyn Fn(f64) -> f64, start: f64| {
            let start = start.clamp(0.0, end);
            time_content(|t| g(start + t), end - start, carried.frequency)
        };
        for (k, load) in self.model.loads.iter().enumerate() {
            let field = load.amplitude.components();
            let ([from, until], Ok(function)) = (load.window(), load.function.function()) else {
                continue;
            };
            let g = |t: f64| {
                let acts = (from..=until).contains(&t);
                f64::from(u8::from(acts)) * function.value(t) * course(field, t)
            };
            judge(&KeyPath::from("load").index(k), "load", in_time(&g, from));
        }
        for (k, motion) in self.model.prescribe.iter().enumerate() {
            // A motion sends out its velocity.
            let moved = assembly
                .system
                .motions()
                .get(k)
                .map_or(0, |m| m.points.len());
            // What moves all points at once sends out nothing.
            if !motion.moves() || moved == assembly.cloud.len() {
                continue;
            }
            let mut amplitudes = motion.amplitude.iter().flatten();
            let varies = amplitudes.any(Component::depends_on_time);
            let constant = motion.function == TimeHistory::Constant && !varies;
            if constant && motion.kind == MotionKind::Displacement {
                continue;
            }
            let Ok(function) = motion.function.function() else {
                continue;
            };
            let field = motion
                .amplitude
                .each_ref()
                .map(|entry| entry.clone().unwrap_or(Component::Number(0.0)));
            let displacement = motion.kind == MotionKind::Displacement;
            let step = end * 1e-6;
            let g = |t: f64| match (displacement, varies) {
                (true, false) => function.derivative(t),
                (false, false) => function.value(t),
                (true, true) => {
                    (course(&field, t + step) - course(&field, t - step)) / (2.0 * step)
                }
                (false, true) => course(&field, t),
            };
            judge(
                &KeyPath::from("prescribe").index(k),
                "prescribed motion",
                in_time(&g, 0.0),
            );
        }
        warnings
    }

    /// Warns of waves that grow, and of tuned coefficients that do worse than a constant influence function.
    fn judge_kernel(
        &self,
        solid: &Solid,
        assembly: &Assembly,
        waves: &PlaneWaves,
    ) -> Vec<ModelWarning> {
        let mut cautions = Vec::new();
        let Some((material, constants)) = bonds_of(solid, assembly) else {
            return Vec::new();
        };
        if material.influence.is_signed(material.horizon) {
            let lattice = self.lattice_of(solid, assembly, material, constants).ok();
            let smallest = lattice.map_or(0.0, |lattice| stability(&lattice).smallest);
            if smallest < 0.0 {
                cautions.push(Caution::GrowingWaves { smallest });
            }
        }
        if let Some([tuned, constant]) = waves.tuning
            && (tuned.spacings > constant.spacings || tuned.worst > constant.worst)
        {
            cautions.push(Caution::PoorTuning {
                spacings: [tuned.spacings, constant.spacings],
                worst: [tuned.worst, constant.worst],
                shortest: KernelQuality::SHORTEST,
            });
        }
        let located = cautions.into_iter();
        located
            .map(|caution| Remark::new("material.influence", caution))
            .collect()
    }
}

/// The bond-based material of a body with its constants, if it is one.
fn bonds_of<'a>(
    solid: &'a Solid,
    assembly: &'a Assembly,
) -> Option<(&'a BondMaterial, &'a BondConstants)> {
    let constants = assembly.constants.as_ref()?.bonds()?;
    Some((solid.material.bonds()?, constants))
}

/// How a field goes over time, at the origin; 1 where it does not change.
fn course(field: &[Component], t: f64) -> f64 {
    field
        .iter()
        .find(|entry| entry.depends_on_time())
        .map_or(1.0, |entry| entry.value([0.0; 3], t))
}
