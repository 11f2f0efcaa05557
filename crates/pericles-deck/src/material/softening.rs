//! `softening`: bonds that soften before they break.

use pericles::material::{Softening, SofteningLaw};
use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;

/// Softening of bonds beyond an elastic limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BondSoftening {
    /// The curve.
    pub law: SofteningWord,
    /// The stretch at which softening starts.
    pub onset_stretch: f64,
    /// Trilinear: the force at the knee over the largest force.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub knee_force: Option<f64>,
    /// Trilinear: the place of the knee between the onset (0) and the end of the curve (1).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub knee_position: Option<f64>,
}

/// The curve of bonds that soften.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SofteningWord {
    /// A straight line.
    Linear,
    /// Two straight lines.
    Trilinear,
    /// An exponential function.
    Exponential,
}

/// The defaults of the knee: the curve of concrete by Petersson.
const KNEE: [f64; 2] = [1.0 / 3.0, 2.0 / 9.0];

impl BondSoftening {
    /// Converts to the engine's type.
    pub fn softening(&self) -> Softening {
        let law = match self.law {
            SofteningWord::Linear => SofteningLaw::Linear,
            SofteningWord::Exponential => SofteningLaw::Exponential,
            SofteningWord::Trilinear => SofteningLaw::Trilinear {
                knee_force: self.knee_force.unwrap_or(KNEE[0]),
                knee_position: self.knee_position.unwrap_or(KNEE[1]),
            },
        };
        Softening {
            law,
            onset: self.onset_stretch,
        }
    }
}

/// Rejects the key in the table of a material whose bonds cannot soften.
pub(super) fn forbid_softening(table: &Table<'_>) {
    table.forbid(
        "softening",
        "it requires model = \"bond-stretch\" or \"linear\", whose pair force is proportional to the stretch, so that the area under the curve is the energy of the bond",
    );
}

pub(super) fn softening(table: &Table<'_>) -> Option<Option<BondSoftening>> {
    table.maybe("softening", |item| read(item.table()?))
}

fn read(table: Table<'_>) -> Option<BondSoftening> {
    let law = table.required("law").and_then(|item| {
        item.choice(
            "softening law",
            &[
                ("linear", SofteningWord::Linear),
                ("trilinear", SofteningWord::Trilinear),
                ("exponential", SofteningWord::Exponential),
            ],
        )
    });
    let onset = table.required("onset_stretch").and_then(|item| {
        item.within(
            Quantity::Number,
            "a positive stretch below the critical stretch, such as tensile strength over Young's modulus",
            |stretch| stretch > 0.0,
        )
    });
    let mut knee = [Some(None); 2];
    for (k, key) in ["knee_force", "knee_position"].into_iter().enumerate() {
        if law != Some(SofteningWord::Trilinear) {
            table.forbid(key, "it requires law = \"trilinear\"");
            continue;
        }
        let value = table.or(key, KNEE[k], |item| {
            item.within(Quantity::Number, "a number above 0 and below 1", |value| {
                value > 0.0 && value < 1.0
            })
        });
        knee[k] = value.map(Some);
    }
    table.finish();
    let [knee_force, knee_position] = knee;
    Some(BondSoftening {
        law: law?,
        onset_stretch: onset?,
        knee_force: knee_force?,
        knee_position: knee_position?,
    })
}
