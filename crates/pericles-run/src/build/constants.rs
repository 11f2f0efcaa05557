//! Constants of materials of all models.

use pericles::kernel::Influence;
use pericles::material::{
    BondConstants, CrackPlane, Criterion, ElasticWaves, FractureCalibration, LinearSolidConstants,
    StressState,
};
use pericles_solids::correspondence::CorrespondenceConstants;

/// The constants of a material.
#[derive(Debug, Clone, PartialEq)]
pub enum MaterialConstants {
    /// Constants of a bond-based material.
    Bonds(BondConstants),
    /// Constants of a state-based material.
    StateBased(LinearSolidConstants),
    /// Constants of a correspondence material.
    Correspondence(Box<CorrespondenceConstants>),
}

impl MaterialConstants {
    /// Returns the constants of a bond-based material.
    pub fn bonds(&self) -> Option<&BondConstants> {
        match self {
            Self::Bonds(constants) => Some(constants),
            Self::StateBased(_) | Self::Correspondence(_) => None,
        }
    }

    /// Returns elastic constants and limits of a state-based or correspondence material.
    pub fn state_based(&self) -> Option<&LinearSolidConstants> {
        match self {
            Self::Bonds(_) => None,
            Self::StateBased(constants) => Some(constants),
            Self::Correspondence(constants) => Some(&constants.solid),
        }
    }

    /// Returns the influence function of a state-based or correspondence material.
    pub fn influence(&self) -> Option<&Influence> {
        self.state_based().map(|constants| &constants.influence)
    }

    /// Returns Young's modulus, Pa.
    pub fn young(&self) -> f64 {
        match self {
            Self::Bonds(constants) => constants.young,
            Self::StateBased(constants) => constants.elastic.young(),
            Self::Correspondence(constants) => constants.solid.elastic.young(),
        }
    }

    /// Returns ρ c² of longitudinal waves, Pa.
    pub fn longitudinal_modulus(&self, state: StressState) -> f64 {
        match self {
            Self::Bonds(constants) => state.longitudinal_modulus(constants.young),
            Self::StateBased(constants) => constants.elastic.longitudinal_modulus(state),
            Self::Correspondence(constants) => constants.solid.elastic.longitudinal_modulus(state),
        }
    }

    /// Returns the wave speeds for a density (kg/m³).
    pub fn waves(&self, density: f64, state: StressState) -> ElasticWaves {
        match self {
            Self::Bonds(constants) => ElasticWaves::of(constants.young, density, state),
            Self::StateBased(constants) => {
                ElasticWaves::of_solid(&constants.elastic, density, state)
            }
            Self::Correspondence(constants) => {
                ElasticWaves::of_solid(&constants.solid.elastic, density, state)
            }
        }
    }

    /// Returns the failure criterion of stress and strain, if bonds break by them.
    pub fn criterion(&self) -> Option<&Criterion> {
        self.state_based()?.criterion.as_ref()
    }

    /// Returns the critical stretch; infinite if bonds do not break by their stretch.
    pub fn critical_stretch(&self) -> f64 {
        match self {
            Self::Bonds(constants) => constants.critical_stretch,
            Self::StateBased(constants) => constants.limits.stretch,
            Self::Correspondence(constants) => constants.solid.limits.stretch,
        }
    }

    /// Returns the critical bond energy w_c, J/m⁶; infinite if bonds do not break by their energy.
    pub fn critical_bond_energy(&self) -> f64 {
        match self {
            Self::Bonds(_) => f64::INFINITY,
            Self::StateBased(constants) => constants.limits.energy,
            Self::Correspondence(constants) => constants.solid.limits.energy,
        }
    }

    /// Returns the fracture energy, J/m²; infinite if bonds do not break.
    pub fn fracture_energy(&self) -> f64 {
        match self {
            Self::Bonds(constants) => constants.fracture_energy,
            Self::StateBased(constants) => constants.fracture_energy,
            Self::Correspondence(constants) => constants.solid.fracture_energy,
        }
    }

    /// Returns the calibration by the fracture energy; `None` if no fracture energy is given.
    pub fn fracture_calibration(&self) -> Option<FractureCalibration> {
        match self {
            Self::Bonds(constants) => constants.fracture_calibration,
            Self::StateBased(constants) => constants.fracture_calibration,
            Self::Correspondence(constants) => constants.solid.fracture_calibration,
        }
    }

    /// Returns the energies of cracks along lattice planes; empty if bonds do not break, and for bodies without a
    /// lattice.
    pub fn crack_planes(&self) -> &[CrackPlane] {
        match self {
            Self::Bonds(constants) => &constants.crack_planes,
            Self::StateBased(constants) => &constants.crack_planes,
            Self::Correspondence(constants) => &constants.solid.crack_planes,
        }
    }
}
