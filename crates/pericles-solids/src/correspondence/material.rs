//! Correspondence material and its constants on a body.

use pericles::family::VolumeCorrection;
use pericles::material::{
    BondFailure, BondLimits, BondStrength, CrackPlane, Criterion, FractureCalibration,
    LayerMoments, LinearSolid, LinearSolidConstants, Materials, StressState, StretchDefinition,
};
use pericles::space::PointCloud;
use pericles::{PericlesError, Result, positive};

use super::classical::ClassicalSolid;
use super::control::{Stabilisation, spring_of_horizon};
use super::law::{ElasticLaw, Moduli};
use super::plasticity::Plasticity;
use super::stiffness::Stiffness;
use crate::tensor::{Matrix, combination, contraction, in_body, product, symmetric};

/// A correspondence material (Silling, Epton, Weckner, Xu & Askari, J. Elasticity 88, 2007): the force state
/// of a point follows from the stress at its deformation gradient.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrespondenceMaterial {
    /// Density, elastic constants, horizon, influence function, partial volumes and failure criterion, as for
    /// a linear peridynamic solid.
    pub solid: LinearSolid,
    /// Elastic law; materials with plasticity always use [`ElasticLaw::Hencky`].
    pub law: ElasticLaw,
    /// Control of zero-energy modes.
    pub stabilisation: Stabilisation,
    /// Plasticity; `None` for elastic materials.
    pub plasticity: Option<Plasticity>,
    /// Stiffness of an anisotropic material in the axes of the body; the elastic constants of `solid` are then those of Voigt's
    /// average ([`Stiffness::average`]).
    pub anisotropy: Option<Stiffness>,
    /// Criterion of the Cauchy stress and of the strain, if bonds break by them.
    pub criterion: Option<Criterion>,
}

/// Constants of a correspondence material on a given body.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrespondenceConstants {
    /// Elastic constants, horizon, influence function, limits of bonds and fracture energy. The constants A
    /// and B are not used; the lattice shear is `None` because it is exact.
    pub solid: LinearSolidConstants,
    /// Stress–strain law.
    pub point: ClassicalSolid,
    /// Control of zero-energy modes.
    pub stabilisation: Stabilisation,
}

impl CorrespondenceMaterial {
    /// Creates a material without plasticity.
    pub fn new(solid: LinearSolid, law: ElasticLaw, stabilisation: Stabilisation) -> Self {
        Self {
            solid,
            law,
            stabilisation,
            plasticity: None,
            anisotropy: None,
            criterion: None,
        }
    }

    /// Returns the constants for bonds of `cloud`.
    ///
    /// # Errors
    /// The errors of [`LinearSolid::constants`]; a stretch definition other than `closing`; plastic constants out of range.
    pub fn constants(
        &self,
        cloud: &PointCloud,
        state: StressState,
    ) -> Result<CorrespondenceConstants> {
        if let Some(plasticity) = &self.plasticity {
            plasticity.check()?;
        }
        // The critical bond energy follows from the lattice alone, the critical stretch from the stress.
        let failure = match self.solid.failure {
            energy @ BondFailure::BondEnergy { .. } => energy,
            _ => BondFailure::Unbreakable,
        };
        let unbroken = LinearSolid {
            failure,
            ..self.solid.clone()
        };
        if let Some(stiffness) = &self.anisotropy {
            stiffness.check(state)?;
            if self.plasticity.is_some() || self.law != ElasticLaw::StVenantKirchhoff {
                return Err(PericlesError::ElasticConstants {
                    reason: "an anisotropic material is elastic with the law St Venant–Kirchhoff"
                        .into(),
                });
            }
        }
        let mut solid = unbroken.constants(cloud, state)?;
        solid.lattice_shear = None;
        solid.criterion = self.criterion.clone();
        let mut constants = CorrespondenceConstants {
            point: ClassicalSolid {
                state,
                law: match self.plasticity {
                    Some(_) => ElasticLaw::Hencky,
                    None => self.law,
                },
                moduli: match self.anisotropy {
                    Some(stiffness) => Moduli::anisotropic(stiffness),
                    None => Moduli::new(solid.elastic.bulk(), solid.elastic.shear()),
                },
                plasticity: self.plasticity,
            },
            stabilisation: self.stabilisation,
            solid,
        };
        self.set_limits(&mut constants, cloud)?;
        Ok(constants)
    }

    /// Returns the limits of bonds between this material and another one, for a failure criterion of the
    /// interface. Each side contributes half of the fracture energy.
    ///
    /// # Errors
    /// The errors of [`CorrespondenceMaterial::constants`].
    pub fn limits_towards(
        &self,
        other: &Self,
        failure: BondFailure,
        cloud: &PointCloud,
        state: StressState,
    ) -> Result<BondLimits> {
        // 1/s₀² is the crack energy at unit stretch over the fracture energy.
        let limit = |material: &Self| -> Result<BondLimits> {
            let solid = LinearSolid {
                failure,
                ..material.solid.clone()
            };
            let material = Self {
                solid,
                ..material.clone()
            };
            Ok(material.constants(cloud, state)?.solid.limits)
        };
        let [a, b] = [limit(self)?, limit(other)?];
        Ok(BondLimits {
            stretch: (0.5 * (a.stretch.powi(-2) + b.stretch.powi(-2))).powf(-0.5),
            energy: 0.5 * (a.energy + b.energy),
        })
    }

    /// Sets the critical stretch: s₀² is the fracture energy over the crack energy per area at unit stretch
    /// in the closing deformation, in which only bonds across the crack are stretched.
    fn set_limits(
        &self,
        constants: &mut CorrespondenceConstants,
        cloud: &PointCloud,
    ) -> Result<()> {
        let sides = cloud.cell_sides();
        let planes = |fine: bool| constants.crack_planes(&self.solid, cloud, fine);
        let (stretch, energy, calibration) = match self.solid.failure {
            BondFailure::Unbreakable
            | BondFailure::ByCriterion
            | BondFailure::BondEnergy { .. } => return Ok(()),
            BondFailure::CriticalStretch(stretch) => {
                let stretch = positive("the critical stretch", stretch)?;
                let unit = CrackPlane::mean(&planes(true));
                (stretch, unit * stretch * stretch, None)
            }
            BondFailure::Stretch {
                definition: StretchDefinition::Bond | StretchDefinition::Isotropic,
                ..
            } => {
                return Err(no_such_definition());
            }
            BondFailure::Stretch {
                fracture_energy,
                calibration,
                ..
            } => {
                let energy = positive("the fracture energy", fracture_energy)?;
                let calibration = match sides {
                    Some(_) => calibration,
                    None => FractureCalibration::Continuum,
                };
                let fine = calibration == FractureCalibration::Continuum;
                let unit = CrackPlane::mean(&planes(fine));
                ((energy / unit).sqrt(), energy, Some(calibration))
            }
        };
        let crack_planes = match sides {
            Some(_) => planes(false),
            None => Vec::new(),
        };
        let scale = stretch * stretch;
        let solid = &mut constants.solid;
        solid.crack_planes = crack_planes
            .into_iter()
            .map(|plane| plane.scaled(scale))
            .collect();
        solid.limits.stretch = stretch;
        solid.fracture_energy = energy;
        solid.fracture_calibration = calibration;
        Ok(())
    }
}

fn no_such_definition() -> PericlesError {
    PericlesError::ElasticConstants {
        reason: "the critical stretch of correspondence materials has the definition \"closing\"; \"bond\" and \"iso\" are not supported".into(),
    }
}

/// Cells per horizon of the lattice whose sums approximate the integrals of the continuum, to 1 % in the
/// plane and 2 % in space.
const FINE: [f64; 3] = [200.0, 24.0, 10.0];

impl CorrespondenceConstants {
    /// Returns the materials of a body of this material.
    pub fn uniform(self) -> Materials<Self> {
        let strength = self.strength();
        Materials::uniform(self, strength)
    }

    /// Returns the materials of a body of several materials; `of_point` is the number of the material of each point.
    ///
    /// # Errors
    /// A material number out of range; materials with different horizons, influence functions or stabilisations.
    pub fn several(of_point: Vec<u8>, materials: &[Self]) -> Result<Materials<Self>> {
        let same = |pair: &[Self]| {
            let [a, b] = [&pair[0], &pair[1]];
            a.solid.horizon == b.solid.horizon
                && a.solid.influence == b.solid.influence
                && a.stabilisation == b.stabilisation
        };
        if !materials.windows(2).all(same) {
            return Err(PericlesError::BadInfluence {
                reason: "the correspondence materials of a body must have the same horizon, influence function and stabilisation".into(),
            });
        }
        let with_strength = |own: &Self| (own.clone(), own.strength());
        Materials::new(of_point, materials.iter().map(with_strength).collect())
    }

    fn strength(&self) -> BondStrength {
        BondStrength {
            limits: self.solid.limits,
            criterion: self.solid.criterion.clone(),
        }
    }

    /// Returns planes of the lattice of the body, or of a fine lattice, with the crack energy per area at unit stretch.
    fn crack_planes(&self, solid: &LinearSolid, cloud: &PointCloud, fine: bool) -> Vec<CrackPlane> {
        let (dimension, horizon) = (cloud.dimension(), self.solid.horizon);
        let (sides, correction) = match cloud.cell_sides() {
            Some(sides) if !fine => (sides.to_vec(), solid.volume_correction),
            _ => (
                vec![horizon / (FINE[dimension - 1] + 0.5); dimension],
                VolumeCorrection::None,
            ),
        };
        let weight = |xi: [f64; 3]| self.solid.influence.alpha_of(xi, horizon);
        let energy = |layer: &LayerMoments| match dimension {
            1 => self.closing_energy::<1>(layer),
            2 => self.closing_energy::<2>(layer),
            _ => self.closing_energy::<3>(layer),
        };
        CrackPlane::by_layers(&sides, (horizon, correction), &weight, &energy)
    }

    /// Returns the energy density (J/m³) of a point whose bonds across a crack have unit stretch, η = ξ, and
    /// whose other bonds are unstretched: with the moment M of the former and the shape tensor K, the
    /// displacement gradient is H = M K⁻¹, and Σ w z ⊗ z = M − M K⁻¹ M. Of anisotropic materials that of Voigt's average, because
    /// planes that are equivalent on the lattice have different energies.
    fn closing_energy<const D: usize>(&self, layer: &LayerMoments) -> f64 {
        let whole: Matrix<D> = in_body(&layer.whole);
        let crossing: Matrix<D> = in_body(&layer.crossing);
        let inverse = crate::solid::inverse_of(&whole);
        let gradient = product(&crossing, &inverse);
        let strain = symmetric(&gradient);
        let point = ClassicalSolid {
            moduli: self.point.moduli.isotropic(),
            ..self.point
        };
        let stress = point.linear_stress(&strain);
        let left = combination(1.0, &crossing, -1.0, &product(&gradient, &crossing));
        let spring = self.spring() / layer.weight;
        // Moments are in units of the cell volume; the penalty does not depend on it.
        let control = self.stabilisation.control(&point, &inverse, spring);
        0.5 * contraction(&stress, &strain) + 0.5 * control.contraction(&symmetric(&left))
    }

    /// Returns an upper bound of the stiffness C : H : H/|H|², Pa.
    pub(super) fn stiffest(&self) -> f64 {
        let dimension = self.point.state.dimension() as f64;
        let bulk = dimension * self.point.dilatation_modulus();
        if let Some(stiffness) = &self.point.moduli.stiffness {
            return stiffness.largest();
        }
        match self.point.state {
            StressState::Uniaxial => bulk,
            _ => bulk.max(2.0 * self.point.moduli.shear),
        }
    }

    /// Returns c V_δ/δ, N/m⁴.
    pub(super) fn spring(&self) -> f64 {
        let dimension = self.point.state.dimension();
        spring_of_horizon(
            dimension,
            self.point.dilatation_modulus(),
            self.solid.horizon,
        )
    }
}
