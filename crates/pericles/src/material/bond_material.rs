//! Bond-based materials: law, moduli, horizon, influence function and fracture.

use super::law::PairLaw;
use super::modulus::ElasticModulus;
use crate::family::VolumeCorrection;
use crate::kernel::Influence;

/// An elastic modulus and the calibration that gives the bond constant c.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Modulus {
    /// The modulus.
    pub value: ElasticModulus,
    /// Calibration of c.
    pub calibration: Calibration,
}

/// Failure criterion of bonds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fracture {
    /// Bonds never break.
    Unbreakable,
    /// Bonds break beyond this stretch.
    CriticalStretch(f64),
    /// Bonds break beyond the stretch that corresponds to a fracture energy.
    Energy {
        /// The fracture energy G, J/m².
        energy: f64,
        /// Calibration of the critical stretch.
        calibration: FractureCalibration,
    },
}

/// A bond-based material.
#[derive(Debug, Clone, PartialEq)]
pub struct BondMaterial {
    /// Pair law.
    pub law: PairLaw,
    /// Mass density ρ, kg/m³.
    pub density: f64,
    /// Elastic modulus.
    pub modulus: Modulus,
    /// Horizon δ, m.
    pub horizon: f64,
    /// Influence function.
    pub influence: Influence,
    /// Partial volumes at the horizon.
    pub volume_correction: VolumeCorrection,
    /// Failure criterion.
    pub fracture: Fracture,
}

impl BondMaterial {
    /// Returns an unbreakable material of density `density` (kg/m³) and horizon `horizon` (m) with the
    /// bond-stretch law, a constant influence function, the extended volume correction and continuum calibration.
    ///
    /// ```
    /// use pericles::material::{BondMaterial, ElasticModulus};
    ///
    /// let glass = BondMaterial::new(ElasticModulus::Young(72e9), 2440.0, 0.75e-3).with_fracture_energy(3.8);
    /// ```
    pub fn new(modulus: ElasticModulus, density: f64, horizon: f64) -> Self {
        Self {
            law: PairLaw::BondStretch,
            density,
            modulus: Modulus {
                value: modulus,
                calibration: Calibration::Continuum,
            },
            horizon,
            influence: Influence::default(),
            volume_correction: VolumeCorrection::default(),
            fracture: Fracture::Unbreakable,
        }
    }

    /// Sets the pair law.
    #[must_use]
    pub fn with_law(self, law: PairLaw) -> Self {
        Self { law, ..self }
    }

    /// Sets the influence function.
    #[must_use]
    pub fn with_influence(self, influence: Influence) -> Self {
        Self { influence, ..self }
    }

    /// Sets the calibration of the bond constant.
    #[must_use]
    pub fn with_calibration(mut self, calibration: Calibration) -> Self {
        self.modulus.calibration = calibration;
        self
    }

    /// Sets the critical stretch.
    #[must_use]
    pub fn with_critical_stretch(self, stretch: f64) -> Self {
        Self {
            fracture: Fracture::CriticalStretch(stretch),
            ..self
        }
    }

    /// Sets the fracture energy, J/m².
    #[must_use]
    pub fn with_fracture_energy(self, energy: f64) -> Self {
        Self {
            fracture: Fracture::Energy {
                energy,
                calibration: FractureCalibration::default(),
            },
            ..self
        }
    }
}

/// Calibration of the bond constant c: the moments from which it follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Calibration {
    /// Integrals of the continuum; the discretisation error of the grid remains.
    #[default]
    Continuum,
    /// Sums over the bonds of the lattice, so that the bulk modulus of the grid is exact. Tables per lattice
    /// class always use these sums, because they have no integrals.
    Lattice,
    /// Integrals of the constant function g ≡ 1 instead of g, for influence functions that contain the
    /// modulus themselves: α ≡ 1 if the function acts on the stretch, α = r if it acts on the relative
    /// displacement.
    Unmodified,
}

/// Calibration of the critical stretch from the fracture energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FractureCalibration {
    /// The fracture energy is the mean energy of cracks along planes of the lattice
    /// ([`CrackPlane::mean`](super::CrackPlane::mean)).
    #[default]
    Lattice,
    /// Integrals of the continuum; on a grid the energy of a crack differs by several per cent.
    Continuum,
}

impl FractureCalibration {
    /// Returns the name used in decks and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lattice => "lattice",
            Self::Continuum => "continuum",
        }
    }
}

impl Fracture {
    /// Returns the criterion with continuum calibration, for bodies without a lattice.
    pub(super) fn of_the_continuum(self) -> Self {
        match self {
            Self::Energy { energy, .. } => Self::Energy {
                energy,
                calibration: FractureCalibration::Continuum,
            },
            other => other,
        }
    }
}
