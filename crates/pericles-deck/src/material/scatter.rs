//! `scatter`: randomly distributed strength.

use pericles::material::{Scattered, StrengthScatter};
use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;

/// A Weibull distribution of the strength of points.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scatter {
    /// Distributed quantity.
    #[serde(default)]
    pub of: ScatteredStrength,
    /// Weibull modulus.
    pub shape: f64,
    /// Random seed.
    pub seed: u64,
}

/// Distributed quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ScatteredStrength {
    /// The critical stretch.
    #[default]
    CriticalStretch,
    /// The fracture energy.
    FractureEnergy,
}

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

pub(super) fn scatter(table: &Table<'_>) -> Option<Option<Scatter>> {
    table.maybe("scatter", |item| read(item.table()?))
}

fn read(table: Table<'_>) -> Option<Scatter> {
    table.choice_or_first("distribution", "distribution", &[("weibull", ())]);
    let of = table.choice_or_first(
        "of",
        "strength",
        &[
            ("critical_stretch", ScatteredStrength::CriticalStretch),
            ("fracture_energy", ScatteredStrength::FractureEnergy),
        ],
    );
    let shape = table.required("shape").and_then(|item| {
        let [least, most] = StrengthScatter::SHAPES;
        item.within(
            Quantity::Number,
            "a number from 0.5 to 1000 (glass: 5 to 10)",
            |shape| (least..=most).contains(&shape),
        )
    });
    let seed = table.or("seed", 1, |item| item.count());
    table.finish();
    Some(Scatter {
        of: of?,
        shape: shape?,
        seed: seed?,
    })
}
