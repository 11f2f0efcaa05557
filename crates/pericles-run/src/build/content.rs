//! Plane waves in the body of a deck: dispersion by kernel and grid, and warnings about loads, motions and initial
//! values with waves that the grid does not resolve.

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

use super::assembler::{Assembler, Warnings};
use super::assembly::Assembly;
use super::rejection::{HORIZON, at, at_path};

/// Waves with a larger error of the phase speed are not resolved.
const TOLERANCE: f64 = 0.05;

/// Fraction of the energy in unresolved waves that leads to a warning.
const SHARE: f64 = 0.05;

/// Dispersion of plane waves of any direction in the body of a deck.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneWaves {
    /// The shortest wavelength (m) whose phase speed in the nonlocal continuum is within [`Resolved::tolerance`] of
    /// `grid` of the long-wave limit; `None` for coefficients per class of bonds, which have no continuum.
    pub model: Option<f64>,
    /// The shortest waves whose phase speed on the grid is within the tolerance of that in the nonlocal continuum or,
    /// without a continuum, of the long-wave limit.
    pub grid: Resolved,
    /// For tuned coefficients: their quality and the quality of a constant influence function.
    pub tuning: Option<[KernelQuality; 2]>,
}

/// Dispersion error of a kernel on its grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KernelQuality {
    /// Spacings per wavelength above which the phase speed is within 1 % of the long-wave limit.
    pub spacings: f64,
    /// The largest relative error of the phase speed down to [`KernelQuality::SHORTEST`] spacings per wavelength.
    pub worst: f64,
}

impl KernelQuality {
    /// Smallest number of spacings per wavelength in comparisons of kernels.
    pub const SHORTEST: f64 = 4.0;

    fn of(lattice: &BondLattice) -> Self {
        let errors = PhaseErrors::new(lattice);
        // The boundary of the Brillouin zone corresponds to two spacings per wavelength.
        let end = errors.end();
        Self {
            spacings: 2.0 * end / errors.resolved(0.01).wavenumber,
            worst: errors.largest(2.0 * end / Self::SHORTEST),
        }
    }
}

impl Assembly {
    /// Returns the interior of the body for plane-wave analysis.
    ///
    /// # Errors
    /// The points of the body do not form a regular grid.
    pub fn interior<'a>(&'a self, model: &'a Model) -> Result<Interior<'a>, BuildError> {
        interior(self.with_means(model), self)
    }

    /// Returns the dispersion of plane waves; `None` for bodies without a grid or with several materials.
    pub fn plane_waves(&self, model: &Model) -> Option<PlaneWaves> {
        Assembler::new(self.with_means(model), &Warnings::default()).plane_waves(self)
    }

    /// Warns of kernels that are less accurate than intended, and of loads, motions and initial values with waves
    /// that the grid does not resolve. Dispersion of the nonlocal model itself leads to no warning. Bodies without a
    /// grid or with several materials are not checked.
    pub fn check_waves(&self, model: &Model) -> Vec<ModelWarning> {
        Assembler::new(self.with_means(model), &Warnings::default()).check_waves(self)
    }
}

/// The interior of a body on a grid; of several materials only the first.
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

fn interior<'a>(model: &'a Model, assembly: &'a Assembly) -> Result<Interior<'a>, BuildError> {
    let Some(solid) = model.body.solid() else {
        return Err(at("body", DispersionError::NoLattice.into()));
    };
    let Some((material, constants)) = bonds_of(solid, assembly) else {
        let fault = Fault::OutOfRange {
            value: solid.material.model_name().into(),
            allowed: "allowed: a bond-based model".into(),
        };
        return Err(at_path("material.model", fault));
    };
    let lattice = lattice_of(solid, assembly, material, constants);
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

impl Assembler<'_> {
    /// Returns the dispersion of plane waves; `None` for bodies without a grid or with several materials.
    fn plane_waves(self, assembly: &Assembly) -> Option<PlaneWaves> {
        let solid = self.model.body.solid()?;
        let (material, constants) = bonds_of(solid, assembly)?;
        if !self.model.materials.is_empty() {
            return None;
        }
        let lattice = lattice_of(solid, assembly, material, constants).ok()?;
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
            let constant = lattice_of(solid, assembly, &constant, constants).ok()?;
            Some([KernelQuality::of(&lattice), KernelQuality::of(&constant)])
        });
        Some(PlaneWaves {
            model: model_length,
            grid,
            tuning,
        })
    }

    /// See [`Assembly::check_waves`].
    fn check_waves(self, assembly: &Assembly) -> Vec<ModelWarning> {
        let body = self.model.body.solid();
        let Some((solid, waves)) = body.zip(self.plane_waves(assembly)) else {
            return Vec::new();
        };
        let mut warnings = self.check_kernel(solid, assembly, &waves);
        // Initial fields are compared with the waves of a body that is not divided among processes.
        if self.model.time.scheme.is_static() || assembly.system.domain().is_divided() {
            return warnings;
        }
        let carried = waves.grid;
        let mut check = |path: &KeyPath, what: &'static str, share: f64| {
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
            check(&"initial".into(), what, share.unwrap_or(0.0));
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
            check(&KeyPath::from("load").index(k), "load", in_time(&g, from));
        }
        for (k, motion) in self.model.constraints.iter().enumerate() {
            // A prescribed motion emits waves by its velocity.
            let moved = assembly
                .system
                .motions()
                .get(k)
                .map_or(0, |m| m.points.len());
            // A motion of all points emits no waves.
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
            check(
                &KeyPath::from("constraint").index(k),
                "prescribed motion",
                in_time(&g, 0.0),
            );
        }
        warnings
    }

    /// Warns of unstable waves, and of tuned coefficients that are less accurate than a constant influence function.
    fn check_kernel(
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
            let lattice = lattice_of(solid, assembly, material, constants).ok();
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

/// Returns the bond-based material of a body with its constants, if it has one.
fn bonds_of<'a>(
    solid: &'a Solid,
    assembly: &'a Assembly,
) -> Option<(&'a BondMaterial, &'a BondConstants)> {
    let constants = assembly.constants.as_ref()?.bonds()?;
    Some((solid.material.bonds()?, constants))
}

/// Returns the time history of a field at the origin; 1 if it is constant.
fn course(field: &[Component], t: f64) -> f64 {
    field
        .iter()
        .find(|entry| entry.depends_on_time())
        .map_or(1.0, |entry| entry.value([0.0; 3], t))
}
