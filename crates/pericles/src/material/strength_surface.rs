//! The strength of a brittle material as an input beside its fracture energy.

use super::criterion::{BondPlace, BondState, Criterion};
use crate::error::{Result, positive};
use crate::units::quantity;

/// Stresses at which a material begins to fail.
#[derive(Debug, Clone, PartialEq)]
pub enum StrengthSurface {
    /// The largest principal stress is the tensile strength, Pa (Rankine).
    Rankine(f64),
    /// The failure index of the stress is one.
    Function(Criterion),
}

/// Strength of a material whose bonds soften or break where the stress reaches it.
///
/// A bond is elastic at any stretch until the stress of one of its ends reaches the surface. From then on it softens from
/// its stretch at that time, at least `least_onset`, along a curve with the area ½ s₀² of the fracture energy; it
/// breaks at once if its stretch is beyond s₀. Bonds of points that have lost a tenth of their stiffness soften from s₀/2.
#[derive(Debug, Clone, PartialEq)]
pub struct Strength {
    /// The surface.
    pub surface: StrengthSurface,
    /// Smallest stretch at which a bond softens.
    pub least_onset: f64,
}

impl StrengthSurface {
    /// Returns the surface of a tensile strength, Pa.
    ///
    /// # Errors
    /// A strength that is not positive.
    pub fn rankine(strength: f64) -> Result<Self> {
        positive("the tensile strength", strength).map(Self::Rankine)
    }

    /// Returns whether a stress (Pa) of a body of some dimension is on the surface or beyond it.
    pub fn is_reached(&self, dimension: usize, stress: [[f64; 3]; 3]) -> bool {
        // No principal stress exceeds the Frobenius norm.
        if let Self::Rankine(strength) = self {
            let square: f64 = stress.iter().flatten().map(|entry| entry * entry).sum();
            if square < strength * strength {
                return false;
            }
        }
        let point = BondState {
            dimension,
            stress,
            strain: [[0.0; 3]; 3],
            direction: [1.0, 0.0, 0.0],
            stretch: 0.0,
            at: BondPlace::default(),
        };
        match self {
            Self::Rankine(strength) => point.principal_stresses()[0] >= *strength,
            Self::Function(criterion) => criterion.failure_index(&point) >= 1.0,
        }
    }

    /// Returns the surface in words that complete "points fail", for reports.
    pub fn words(&self) -> String {
        match self {
            Self::Rankine(strength) => {
                format!("at the principal stress {}", quantity(*strength, "Pa"))
            }
            Self::Function(criterion) => criterion.words(),
        }
    }
}
