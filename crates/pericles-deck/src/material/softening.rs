//! `softening`, `tensile_strength` and `failure = "strength"`: bonds that soften before they break, and the strength from
//! which they do.

use pericles::Result;
use pericles::material::{
    Criterion, FractureCalibration, SofteningLaw, StrengthSurface, TensileStrength,
};
use serde::{Deserialize, Serialize};

use crate::expression::BondExpression;
use crate::fault::Fault;
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

/// Stresses at which the bonds of a point begin to soften or break.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureSurface {
    /// The largest principal stress is the tensile strength.
    Rankine,
    /// A function of the stress (Pa) is 1.
    Expression(BondExpression),
}

impl FailureSurface {
    /// Returns the surface of the engine for a tensile strength, Pa.
    ///
    /// # Errors
    /// A strength that is not positive.
    pub fn surface(&self, strength: f64) -> Result<StrengthSurface> {
        match self {
            Self::Rankine => StrengthSurface::rankine(strength),
            Self::Expression(expression) => Ok(StrengthSurface::Function(Criterion::new(
                expression.clone(),
            ))),
        }
    }
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

/// Reads `failure` of a bond-based material, and the strength surface of failure = "strength".
pub(super) fn failure(
    table: &Table<'_>,
    dimension: Option<usize>,
) -> Option<Option<FailureSurface>> {
    const KEY: &str = "strength_surface";
    const RANKINE: &str = "rankine";
    if !STRENGTHS.iter().any(|key| table.has(key)) {
        for key in ["failure", KEY] {
            table.forbid(
                key,
                "bonds without `fracture_energy` or `critical_stretch` never break",
            );
        }
        return Some(None);
    }
    let by_strength = table.choice_or_first(
        "failure",
        "failure criterion",
        &[("stretch", false), ("strength", true)],
    );
    if !by_strength? {
        table.forbid(KEY, "it requires failure = \"strength\"");
        return Some(None);
    }
    let Some(item) = table.optional(KEY) else {
        table.record(KEY, RANKINE);
        return Some(Some(FailureSurface::Rankine));
    };
    if item.is_keyword(RANKINE) {
        return Some(Some(FailureSurface::Rankine));
    }
    let text = item.text()?;
    let report = |reason: String| item.report(Fault::bad_expression(text.clone(), reason));
    match BondExpression::parse(&text, dimension.unwrap_or(3)) {
        Ok(expression) if expression.is_of_stress() => {
            Some(Some(FailureSurface::Expression(expression)))
        }
        Ok(_) => {
            report("a strength surface is a function of the stress of a point: of its components, stress_1, stress_2, stress_3 and equivalent_stress".into());
            None
        }
        Err(malformed) => {
            report(malformed.reason);
            None
        }
    }
}

/// Rejects the keys in the table of a material whose bonds have no strength.
pub(super) fn forbid_failure(table: &Table<'_>) {
    for key in ["failure", "strength_surface"] {
        table.forbid(
            key,
            "it requires model = \"bond-stretch\", \"linear\", \"state-based\" or \"correspondence\"",
        );
    }
}

/// Reads the tensile strength of a material, from which the onset of its softening follows, or at which its bonds begin to
/// fail. It requires a softening law without an onset or failure = "strength"; `calibration` is that of the fracture
/// energy.
pub(super) fn tensile_strength(
    table: &Table<'_>,
    softening: Option<Option<BondSoftening>>,
    surface: Option<&FailureSurface>,
    calibration: Option<FractureCalibration>,
) -> Option<Option<TensileStrength>> {
    const KEY: &str = "tensile_strength";
    let breaks = STRENGTHS.iter().any(|key| table.has(key));
    let forbidden = match softening? {
        Some(_) if surface.is_some() && breaks => None,
        None => Some(
            "it requires `softening = { law = … }`: the tensile strength gives the stretch at which softening starts; or failure = \"strength\"",
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
        match surface {
            Some(_) => table.requires_one_of(&[KEY]),
            None => table.requires_one_of(&[KEY, "softening.onset_stretch"]),
        }
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

/// Reads the softening of bonds; with failure = "strength" its default is a straight line.
pub(super) fn softening(
    table: &Table<'_>,
    surface: Option<&FailureSurface>,
) -> Option<Option<BondSoftening>> {
    let given = table.maybe("softening", |item| read(item.table()?, surface))?;
    Some(given.or_else(|| {
        surface.map(|_| BondSoftening {
            law: SofteningWord::Linear,
            onset_stretch: None,
            knee_force: None,
            knee_position: None,
        })
    }))
}

fn read(table: Table<'_>, surface: Option<&FailureSurface>) -> Option<BondSoftening> {
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
    let onset = match surface {
        Some(_) => {
            table.forbid(
                "onset_stretch",
                "with failure = \"strength\" a bond softens from its stretch when the stress reaches the strength",
            );
            Some(None)
        }
        None => table.maybe("onset_stretch", |item| {
            item.within(
                Quantity::Number,
                "a positive stretch below the critical stretch",
                |stretch| stretch > 0.0,
            )
        }),
    };
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
