//! Linear peridynamic solid: material parameters and the constants of its force states.

use super::elastic::{ElasticConstants, GivenConstants};
use super::failure::{BondFailure, BondLimits, Crossing};
use super::isotropic::{IsotropicInfluence, LatticeShear};
use crate::error::{PericlesError, Result, positive};
use crate::family::VolumeCorrection;
use crate::kernel::{ActsOn, Influence, InfluenceFunction};
use crate::material::crack_planes::CrackPlane;
use crate::material::lattice::{Cells, check_reach, for_each_offset};
use crate::material::{Criterion, FractureCalibration, StressState};
use crate::space::PointCloud;

/// Influence function w(r) of a state-based material.
#[derive(Debug, Clone, PartialEq)]
pub enum StateInfluence {
    /// A function of the bond length.
    Function(InfluenceFunction),
    /// The linear function that makes the lattice isotropic ([`IsotropicInfluence`]).
    Isotropic,
}

/// Strain measure: the extension e of a bond as a function of the displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Strains {
    /// e = |ξ + η| − |ξ|, forces along ξ + η; valid for displacements of any size.
    #[default]
    Finite,
    /// e = ξ·η/|ξ|, forces along ξ; linear in the displacement.
    Small,
}

/// A linear peridynamic solid (Silling, Epton, Weckner, Xu & Askari, J. Elasticity 88, 2007; in the plane Le,
/// Chan & Schwartz, Int. J. Numer. Meth. Eng. 98, 2014).
#[derive(Debug, Clone, PartialEq)]
pub struct LinearSolid {
    /// Mass density ρ, kg/m³.
    pub density: f64,
    /// Two of the elastic constants.
    pub elastic: GivenConstants,
    /// Horizon δ, m.
    pub horizon: f64,
    /// Influence function w.
    pub influence: StateInfluence,
    /// Partial volumes at the horizon.
    pub volume_correction: VolumeCorrection,
    /// Failure criterion.
    pub failure: BondFailure,
}

/// Constants of a linear peridynamic solid on a given body.
///
/// With the extension e and the length r of a bond, the weighted volume m = Σ w r² and the dilatation
/// θ = (D/m) Σ w r e of a point in D dimensions (sums over its bonds weighted by volume), the force state is
/// t = (w/m)(A θ r + B e) and the energy density is W = A θ²/(2 D) + B/(2 m) Σ w e². The constants
/// A = D κ − (D + 2) G and B = D (D + 2) G follow from the dilatation modulus κ
/// ([`ElasticConstants::dilatation_modulus`]) and the shear modulus G; a bar has A = 0 and B = E. A solid with
/// A = 0 is bond-based.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearSolidConstants {
    /// A, Pa.
    pub dilatational: f64,
    /// B, Pa.
    pub deviatoric: f64,
    /// K and G of the solid.
    pub elastic: ElasticConstants,
    /// The influence function w, dimensionless.
    pub influence: Influence,
    /// Horizon δ, m.
    pub horizon: f64,
    /// Failure limits of bonds.
    pub limits: BondLimits,
    /// Failure criterion of stress and strain; `None` after [`LinearSolid::constants`], set it before the classes of a
    /// body are made.
    pub criterion: Option<Criterion>,
    /// Fracture energy that corresponds to the limits, J/m²: the given fracture energy, or for a given
    /// critical stretch the continuum value by the closing definition. Infinite for unbreakable bonds.
    pub fracture_energy: f64,
    /// Calibration of the limits from the fracture energy; `None` if no fracture energy is given. Always
    /// continuum calibration for bodies without a lattice.
    pub fracture_calibration: Option<FractureCalibration>,
    /// Energies of cracks along planes of the lattice; empty for unbreakable bonds and for bodies without a lattice.
    pub crack_planes: Vec<CrackPlane>,
    /// Shear stiffness of the lattice; `None` for bars and for bodies that are not on a square or cubic lattice.
    pub lattice_shear: Option<LatticeShear>,
}

impl LinearSolid {
    /// Returns the constants for bonds of `cloud`.
    ///
    /// # Errors
    /// Constants that are not positive or are inconsistent; an invalid influence function; a stress state
    /// whose dimension differs from that of the cloud; a signed influence function together with a failure
    /// criterion; the isotropic function on points that are not a square or cubic lattice.
    pub fn constants(
        &self,
        cloud: &PointCloud,
        state: StressState,
    ) -> Result<LinearSolidConstants> {
        if state.dimension() != cloud.dimension() {
            return Err(PericlesError::WrongDimension {
                what: state.name(),
                needed: ["1", "2", "3"][state.dimension() - 1],
                dimension: cloud.dimension(),
            });
        }
        match cloud.cell_sides() {
            Some(sides) => self.constants_of(sides, cloud.section(), state, true),
            None => {
                let sides = vec![cloud.spacing(); state.dimension()];
                self.constants_of(&sides, cloud.section(), state, false)
            }
        }
    }

    /// Returns the constants for bonds of a lattice whose cells have these sides (m, one per axis) and
    /// section (m² in 1D, m in 2D, 1 in 3D).
    ///
    /// # Errors
    /// The errors of [`LinearSolid::constants`].
    ///
    /// # Panics
    /// If the number of sides is not the dimension.
    pub fn constants_on(
        &self,
        sides: &[f64],
        section: f64,
        state: StressState,
    ) -> Result<LinearSolidConstants> {
        self.constants_of(sides, section, state, true)
    }

    fn constants_of(
        &self,
        sides: &[f64],
        section: f64,
        state: StressState,
        on_lattice: bool,
    ) -> Result<LinearSolidConstants> {
        let dimension = state.dimension();
        assert_eq!(sides.len(), dimension, "one side for each axis");
        let cells = Cells::new(sides);
        positive("the density", self.density)?;
        positive("the horizon", self.horizon)?;
        check_reach(cells, self.horizon, self.volume_correction)?;
        let elastic = self.elastic.resolve(state)?;
        let influence = self.influence_on(cells, on_lattice)?;
        let (dilatational, deviatoric) = kernel_constants(&elastic, state);
        let crossing = Crossing {
            cells,
            section,
            influence: &influence,
            horizon: self.horizon,
            correction: self.volume_correction,
            dilatational,
            deviatoric,
        };
        let calibrated = self.failure.calibrated(&crossing, on_lattice)?;
        let lattice_shear = on_lattice
            .then(|| LatticeShear::of(sides, &influence, self.horizon, self.volume_correction));
        Ok(LinearSolidConstants {
            dilatational,
            deviatoric,
            elastic,
            horizon: self.horizon,
            limits: calibrated.limits,
            criterion: None,
            fracture_energy: calibrated.fracture_energy,
            fracture_calibration: calibrated.calibration,
            crack_planes: calibrated.crack_planes,
            lattice_shear: lattice_shear.flatten(),
            influence,
        })
    }

    /// Returns the influence function, or an error if it is invalid for the lattice.
    fn influence_on(&self, cells: Cells<'_>, on_lattice: bool) -> Result<Influence> {
        let reject = |reason: &str| {
            Err(PericlesError::BadInfluence {
                reason: reason.into(),
            })
        };
        let influence = match &self.influence {
            StateInfluence::Function(function) => Influence {
                function: function.clone(),
                acts_on: ActsOn::Stretch,
            },
            StateInfluence::Isotropic if !on_lattice => {
                return reject(
                    "an isotropic function requires points on a regular lattice; use the conical function",
                );
            }
            StateInfluence::Isotropic => {
                IsotropicInfluence::of_lattice(cells.sides(), self.horizon, self.volume_correction)?
                    .influence()
            }
        };
        let (mut weighted_volume, mut least, mut bonds) = (0.0, f64::INFINITY, 0);
        for_each_offset(cells, self.horizon, self.volume_correction, |_, xi, r| {
            let weight = influence.alpha_of(xi, self.horizon);
            let factor = self.volume_correction.factor(r, self.horizon, cells.size());
            weighted_volume += factor * weight * r * r;
            least = least.min(weight);
            bonds += 1;
        });
        if bonds == 0 {
            return Err(PericlesError::HorizonTooSmall {
                horizon: self.horizon,
                spacing: cells.size(),
            });
        }
        let isotropic = self.influence == StateInfluence::Isotropic;
        if !isotropic {
            influence.check(cells.sides().len(), self.horizon)?;
        }
        let signed = least < 0.0 || !isotropic && influence.is_signed(self.horizon);
        if signed && self.failure != BondFailure::Unbreakable {
            return reject(match isotropic {
                true => {
                    "the isotropic function of this lattice is negative near the horizon and cannot be used with bonds that \
                     break, because a bond with negative weight gains energy as it stretches; use another ratio of horizon and \
                     spacing (2D: 3 or 4, 3D: 3), another volume correction or the conical function"
                }
                false => {
                    "a function with negative values cannot be used with bonds that break, because a bond with negative weight gains energy as it stretches; remove the failure criterion, or use a positive function"
                }
            });
        }
        if weighted_volume > 0.0 {
            return Ok(influence);
        }
        reject(
            "its weighted volume, the sum of w |ξ|² over the bonds of the lattice, must be positive",
        )
    }
}

/// Returns A and B, Pa.
fn kernel_constants(elastic: &ElasticConstants, state: StressState) -> (f64, f64) {
    let dimension = state.dimension() as f64;
    let kappa = elastic.dilatation_modulus(state);
    match state {
        // A bar has no deviatoric strain.
        StressState::Uniaxial => (0.0, kappa),
        _ => {
            let shear = elastic.shear();
            let deviatoric = dimension * (dimension + 2.0) * shear;
            (dimension * kappa - (dimension + 2.0) * shear, deviatoric)
        }
    }
}
