//! `softening` and `tensile_strength`: bonds that soften before they break.

use pericles::material::{FractureCalibration, SofteningLaw, TensileStrength};
use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;
use crate::vocabulary::STRENGTHS;

/// Softening of bonds beyond an elastic limit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BondSoftening {
    /// The curve.
    pub law: SofteningWord,
    /// The stretch at which softening starts; `None` if it follows from the tensile strength of each material.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub onset_stretch: Option<f64>,
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
    /// Converts the curve to the engine's type.
    pub fn law(&self) -> SofteningLaw {
        match self.law {
            SofteningWord::Linear => SofteningLaw::Linear,
            SofteningWord::Exponential => SofteningLaw::Exponential,
            SofteningWord::Trilinear => SofteningLaw::Trilinear {
                knee_force: self.knee_force.unwrap_or(KNEE[0]),
                knee_position: self.knee_position.unwrap_or(KNEE[1]),
            },
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

/// Reads the tensile strength of a material, from which the onset of its softening follows. It requires a softening law
/// without an onset; `calibration` is that of the fracture energy.
pub(super) fn tensile_strength(
    table: &Table<'_>,
    softening: Option<Option<BondSoftening>>,
    calibration: Option<FractureCalibration>,
) -> Option<Option<TensileStrength>> {
    const KEY: &str = "tensile_strength";
    let breaks = STRENGTHS.iter().any(|key| table.has(key));
    let forbidden = match softening? {
        None => Some(
            "it requires `softening = { law = … }`: the tensile strength gives the stretch at which softening starts",
        ),
        Some(given) if given.onset_stretch.is_some() => Some(
            "`softening` has an `onset_stretch`, which determines the strength; give one of the two keys",
        ),
        Some(_) if !breaks => {
            Some("bonds without `fracture_energy` or `critical_stretch` never break")
        }
        Some(_) => None,
    };
    if let Some(reason) = forbidden {
        table.forbid(KEY, reason);
        return Some(None);
    }
    let Some(item) = table.optional(KEY) else {
        table.requires_one_of(&[KEY, "softening.onset_stretch"]);
        return None;
    };
    Some(Some(TensileStrength {
        strength: item.positive(Quantity::Traction)?,
        calibration: calibration?,
    }))
}

/// Rejects the key in the table of a material whose bonds cannot soften.
pub(super) fn forbid_tensile_strength(table: &Table<'_>) {
    table.forbid(
        "tensile_strength",
        "it requires model = \"bond-stretch\" or \"linear\" with `softening`; failure = \"principal-stress\" has the key `strength`",
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
    let onset = table.maybe("onset_stretch", |item| {
        item.within(
            Quantity::Number,
            "a positive stretch below the critical stretch",
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
