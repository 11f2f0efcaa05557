//! Materials as a user describes them.

use super::law::PairLaw;
use super::modulus::ElasticModulus;
use crate::family::VolumeCorrection;
use crate::kernel::Influence;

/// The modulus with the way it enters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Modulus {
    /// The constant given.
    pub value: ElasticModulus,
    /// How c follows from it.
    pub calibration: Calibration,
}

/// When bonds break.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fracture {
    /// Never.
    Unbreakable,
    /// Beyond this stretch.
    CriticalStretch(f64),
    /// Beyond the stretch for which a unit area of crack costs a given energy.
    Energy {
        /// The fracture energy G, J/m².
        energy: f64,
        /// How the critical stretch follows from it.
        calibration: FractureCalibration,
    },
}

/// A bond-based material as a user describes it.
#[derive(Debug, Clone, PartialEq)]
pub struct BondMaterial {
    /// Linear in the displacement, or in the stretch of the deformed bond.
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
    /// Breaking.
    pub fracture: Fracture,
}

impl BondMaterial {
    /// A material that never breaks, of density `density` (kg/m³) and horizon `horizon` (m): bond-stretch law, constant influence function, partial
    /// volumes of all cells that reach into the horizon, constants of the continuum.
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

    /// The same with another pair law.
    #[must_use]
    pub fn with_law(self, law: PairLaw) -> Self {
        Self { law, ..self }
    }

    /// The same with another influence function.
    #[must_use]
    pub fn with_influence(self, influence: Influence) -> Self {
        Self { influence, ..self }
    }

    /// The same with constants from other moments.
    #[must_use]
    pub fn with_calibration(mut self, calibration: Calibration) -> Self {
        self.modulus.calibration = calibration;
        self
    }

    /// The same with bonds that break beyond a stretch.
    #[must_use]
    pub fn with_critical_stretch(self, stretch: f64) -> Self {
        Self {
            fracture: Fracture::CriticalStretch(stretch),
            ..self
        }
    }

    /// The same with bonds that break such that a unit area of crack costs `energy` (J/m²).
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

/// From which moments the constant c follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Calibration {
    /// The integrals, as in the continuum; the grid's own error remains.
    #[default]
    Continuum,
    /// The sums over the lattice's bonds, so that the bulk modulus of the grid is exact. A table per class is always taken so: it has no
    /// integrals.
    Lattice,
    /// The integrals of the constant function, g ≡ 1, whatever g is: for functions made to carry the modulus themselves. What the function acts
    /// on counts: α ≡ 1 for the stretch, α = r for the relative displacement.
    Unmodified,
}

/// How the critical stretch follows from the fracture energy.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FractureCalibration {
    /// The mean over the crack planes of the lattice costs the energy asked for ([`CrackPlane::mean`](super::CrackPlane::mean)).
    #[default]
    Lattice,
    /// The integrals of the continuum; on a grid a crack costs several per cent more or less.
    Continuum,
}

impl FractureCalibration {
    /// The word for it in decks and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lattice => "lattice",
            Self::Continuum => "continuum",
        }
    }
}

impl Fracture {
    /// The same for a body without a lattice: only the continuum has integrals there.
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
