//! `scatter`: randomly distributed strength.

use pericles::material::{Scattered, StrengthScatter};
use pericles_deck_derive::{DeckTable, DeckWords};
use serde::{Deserialize, Serialize};

use crate::range::{Range, from_to};

/// Random distribution of strength. The factor of a point depends on the seed and its number in files, not on threads.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
pub struct Scatter {
    /// `weibull`: the factor k has the distribution function 1 − exp(−(Γ(1 + 1/m) k)^m).
    #[serde(default)]
    #[deck(default)]
    pub distribution: Distribution,
    /// Distributed quantity: the critical stretch, or the fracture energy, which changes the critical stretch by its square
    /// root and the critical bond energy in proportion.
    #[serde(default)]
    #[deck(default)]
    pub of: ScatteredStrength,
    /// Weibull modulus m. Larger values mean less scatter.
    #[deck(range = SHAPES)]
    pub shape: f64,
    /// Random seed. Equal seeds give equal strengths.
    #[deck(default = 1)]
    pub seed: u64,
}

/// Distribution of strength.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "kebab-case")]
#[deck(what = "distribution")]
pub enum Distribution {
    /// Weibull distribution.
    #[default]
    Weibull,
}

/// Distributed quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "snake_case")]
#[deck(what = "strength")]
pub enum ScatteredStrength {
    /// The critical stretch.
    #[default]
    #[deck(word = "critical_stretch")]
    CriticalStretch,
    /// The fracture energy.
    #[deck(word = "fracture_energy")]
    FractureEnergy,
}

const SHAPES: Range = from_to(StrengthScatter::SHAPES[0], StrengthScatter::SHAPES[1])
    .described("a number from 0.5 to 1000 (glass: 5 to 10)");

impl Scatter {
    /// Returns the engine's type of the distribution.
    pub fn strength(&self) -> StrengthScatter {
        StrengthScatter {
            of: match self.of {
                ScatteredStrength::CriticalStretch => Scattered::CriticalStretch,
                ScatteredStrength::FractureEnergy => Scattered::FractureEnergy,
            },
            shape: self.shape,
            seed: self.seed,
        }
    }
}
