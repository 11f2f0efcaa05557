//! Lattice model whose coefficients are tuned, in units of the spacing and the bar wave speed √(E/ρ).

use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use crate::contour::Contour;
use crate::lattice::BondLattice;
use crate::vector::{Vector, dot};
use crate::zone::{Stability, stability};
use pericles::family::VolumeCorrection;
use pericles::kernel::{ClassOffset, class_of, multiplicity};
use pericles::material::StressState;
use pericles::{PericlesError, Result};

use super::samples::{Sample, panels};

/// Bond class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondClass {
    /// Absolute offsets in descending order.
    pub offset: ClassOffset,
    /// |ξ| in spacings.
    pub length: f64,
    /// Number of bonds of a point in this class.
    pub multiplicity: usize,
}

/// Returns the bond classes of a lattice by length; classes of equal length are kept apart, as in tables per class.
pub fn bond_classes(lattice: &BondLattice) -> Vec<BondClass> {
    let keys = lattice.bonds().iter().map(|bond| {
        let offset = class_of(bond.offset);
        let square: i32 = offset.iter().map(|c| c * c).sum();
        (square, offset.map(Reverse))
    });
    let keys: BTreeSet<(i32, [Reverse<i32>; 3])> = keys.collect();
    keys.into_iter()
        .map(|(square, offset)| {
            let offset = offset.map(|Reverse(steps)| steps);
            BondClass {
                offset,
                length: f64::from(square).sqrt(),
                multiplicity: multiplicity(offset, lattice.dimension()),
            }
        })
        .collect()
}

/// Dispersion error of a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DispersionError {
    /// Absolute error ∮ Σ_branches |R| (Alebrahim et al. 2022, eqs. 49 and 51).
    pub absolute: f64,
    /// `absolute` divided by that of α ≡ 1 with the same horizon; in 1D with N = 3, as in the paper.
    pub ratio: f64,
    /// Square error (∮ Σ_branches R²)^½.
    pub square: f64,
}

/// Wave properties of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Assessment {
    /// Dispersion errors.
    pub error: DispersionError,
    /// Relative residuals of the long-wave constraints.
    pub constraints: Vec<f64>,
    /// Stability and highest frequency over the zone, in units of √(E/ρ) and the spacing.
    pub stability: Stability,
}

/// Bond-based lattice with one unknown coefficient α per bond class, in units of the spacing D and the speed V =
/// √(E/ρ).
///
/// The bond constant belongs to α ≡ 1 with δ = `horizon_ratio` · D:
///
/// | | c V² D^… | V_p² | V_s² | ν |
/// |---|---|---|---|---|
/// | bar | 2/N² | 1 | – | – |
/// | plane stress | 9/(πN³) | 9/8 | 3/8 | 1/3 |
/// | plane strain | 48/(5πN³) | 6/5 | 2/5 | 1/4 |
/// | 3D | 12/(πN⁴) | 6/5 | 2/5 | 1/4 |
///
/// Since 9/8 over 9 equals 6/5 over 48/5, both plane states have the same coefficients.
#[derive(Debug, Clone)]
pub struct ScalingModel {
    state: StressState,
    ratio: f64,
    correction: VolumeCorrection,
    classes: Vec<BondClass>,
    whole: BondLattice,
    parts: Vec<BondLattice>,
    contour: Contour,
    equations: DMatrix<f64>,
    targets: DVector<f64>,
}

impl ScalingModel {
    /// Creates the model of a stress state with a horizon of `horizon_ratio` spacings and partial volumes.
    ///
    /// # Errors
    /// A horizon below one spacing or above fifty.
    pub fn new(
        state: StressState,
        horizon_ratio: f64,
        correction: VolumeCorrection,
    ) -> Result<Self> {
        // A horizon of one spacing up to round-off contains bonds.
        if !(1.0 - 1e-9..=50.0).contains(&horizon_ratio) {
            return Err(PericlesError::OutOfRange {
                quantity: "the horizon in spacings",
                value: horizon_ratio,
                allowed: "1 to 50 (usual: 3)",
            });
        }
        let dimension = state.dimension();
        let n = horizon_ratio;
        let constant = match state {
            StressState::Uniaxial => 2.0 / n.powi(2),
            StressState::PlaneStress => 9.0 / (PI * n.powi(3)),
            StressState::PlaneStrain => 48.0 / (5.0 * PI * n.powi(3)),
            StressState::Spatial => 12.0 / (PI * n.powi(4)),
        };
        let reach = correction.reach(n, 1.0);
        let whole = BondLattice::new(&vec![1.0; dimension], reach, |_, _, r| {
            constant * correction.factor(r, n, 1.0)
        })?;
        let classes = bond_classes(&whole);
        let parts: Vec<BondLattice> = classes
            .iter()
            .map(|class| whole.only(|bond| class_of(bond.offset) == class.offset))
            .collect();
        let speeds = continuum_speeds(state);
        let mut targets = vec![speeds.pressure.powi(2)];
        if dimension > 1 {
            targets.push(speeds.shear.powi(2));
        }
        let equations = DMatrix::from_fn(targets.len(), parts.len(), |row, class| {
            parts[class].elasticity(0, 0, row, row)
        });
        Ok(Self {
            state,
            ratio: horizon_ratio,
            correction,
            contour: Contour::irreducible(&whole),
            classes,
            whole,
            parts,
            equations,
            targets: DVector::from_vec(targets),
        })
    }

    /// The stress state.
    pub fn state(&self) -> StressState {
        self.state
    }

    /// Horizon divided by spacing.
    pub fn horizon_ratio(&self) -> f64 {
        self.ratio
    }

    /// Volume correction.
    pub fn correction(&self) -> VolumeCorrection {
        self.correction
    }

    /// Bond classes in the order of the coefficients: by length.
    pub fn classes(&self) -> &[BondClass] {
        &self.classes
    }

    /// Contour on which dispersion is evaluated: the border of the irreducible zone, parametrised by arc length.
    pub fn contour(&self) -> &Contour {
        &self.contour
    }

    /// Returns the lattice with given coefficients.
    pub fn lattice(&self, alpha: &[f64]) -> BondLattice {
        let value = |offset| {
            let class = class_of(offset);
            let found = self.classes.iter().position(|c| c.offset == class);
            found.map_or(0.0, |c| alpha.get(c).copied().unwrap_or(0.0))
        };
        self.whole
            .with_stiffness(|bond| bond.stiffness * value(bond.offset))
    }

    /// Computes errors, constraints and stability of given coefficients.
    ///
    /// # Errors
    /// The number of coefficients is not the number of classes.
    pub fn assess(&self, alpha: &[f64]) -> Result<Assessment> {
        if alpha.len() != self.classes.len() {
            return Err(PericlesError::BadInfluence {
                reason: format!(
                    "{} coefficients for {} bond classes; exactly one per class is required",
                    alpha.len(),
                    self.classes.len()
                ),
            });
        }
        let vector = DVector::from_column_slice(alpha);
        let residual = &self.equations * &vector - &self.targets;
        let lattice = self.lattice(alpha);
        let error = self.error(&lattice);
        let reference = if self.state == StressState::Uniaxial {
            let three = Self::new(self.state, 3.0, VolumeCorrection::None)?;
            three.error(&three.lattice(&[1.0; 3])).0
        } else {
            self.error(&self.lattice(&vec![1.0; alpha.len()])).0
        };
        Ok(Assessment {
            error: DispersionError {
                absolute: error.0,
                ratio: error.0 / reference,
                square: error.1.sqrt(),
            },
            constraints: residual
                .iter()
                .zip(self.targets.iter())
                .map(|(r, t)| r / t)
                .collect(),
            stability: stability(&lattice),
        })
    }

    /// Returns ∮ Σ|R| and ∮ ΣR².
    fn error(&self, lattice: &BondLattice) -> (f64, f64) {
        /// Number of panels of the whole contour: the kinks of |R| limit the order.
        const PANELS: usize = 2400;
        let speeds = self.squared_speeds();
        let (mut absolute, mut square) = (0.0, 0.0);
        for place in panels(&self.contour, PANELS, 4) {
            for (branch, e) in self.polarisations(place.segment).iter().enumerate() {
                let k = place.k;
                let wanted = speeds[branch] * dot(k, k);
                let residual = lattice.omega_squared(k, *e) - wanted;
                absolute += place.weight * residual.abs();
                square += place.weight * residual * residual;
            }
        }
        (absolute, square)
    }

    /// Residuals of the branches at a place as functions of the coefficients: R = row · α − value.
    pub(super) fn sample(&self, k: Vector, segment: usize) -> Sample {
        let square = dot(k, k);
        let speeds = self.squared_speeds();
        let branches = self.polarisations(segment).iter().zip(&speeds);
        Sample {
            k,
            rows: branches
                .clone()
                .map(|(e, _)| self.parts.iter().map(|p| p.omega_squared(k, *e)).collect())
                .collect(),
            values: branches.map(|(_, speed)| speed * square).collect(),
        }
    }

    /// Contribution of a class to the trace of M(k).
    pub(super) fn trace(&self, class: usize, k: Vector) -> f64 {
        let matrix = self.parts[class].dynamical_matrix(k);
        (0..3).map(|c| matrix[c][c]).sum()
    }

    pub(super) fn equations(&self) -> (&DMatrix<f64>, &DVector<f64>) {
        (&self.equations, &self.targets)
    }

    /// V² of each branch.
    fn squared_speeds(&self) -> Vec<f64> {
        let speeds = continuum_speeds(self.state);
        let mut all = vec![speeds.shear.powi(2); self.state.dimension()];
        all[0] = speeds.pressure.powi(2);
        all
    }

    fn polarisations(&self, segment: usize) -> &[Vector] {
        self.contour.segments[segment]
            .polarisation
            .as_deref()
            .unwrap_or_default()
    }
}

/// Long-wave speeds of the continuum, in units of √(E/ρ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaveSpeeds {
    /// Pressure waves.
    pub pressure: f64,
    /// Shear waves; zero in a bar.
    pub shear: f64,
}

/// Wave speeds of the continuum in units of √(E/ρ). Their squares are (1−ν)/((1+ν)(1−2ν)) and 1/(2(1+ν)) with ν =
/// 1/4 in plane strain and 3D; 1/(1−ν²) and 1/(2(1+ν)) with ν = 1/3 in plane stress.
pub fn continuum_speeds(state: StressState) -> WaveSpeeds {
    let (pressure, shear): (f64, f64) = match state {
        StressState::Uniaxial => (1.0, 0.0),
        StressState::PlaneStress => (9.0 / 8.0, 3.0 / 8.0),
        StressState::PlaneStrain | StressState::Spatial => (6.0 / 5.0, 2.0 / 5.0),
    };
    WaveSpeeds {
        pressure: pressure.sqrt(),
        shear: shear.sqrt(),
    }
}
