//! `softening`, `tensile_strength` and `failure = "strength"`: bonds that soften before they break, and the strength from
//! which they do.

use pericles::material::{
    Criterion, FractureCalibration, SofteningLaw, StrengthSurface, TensileStrength,
};
use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use crate::declaration::DeckValue;
use crate::expression::BondExpression;
use crate::fault::Fault;
use crate::form::described;
use crate::quantity::Quantity;
use crate::reader::Table;
use crate::vocabulary::STRENGTHS;

/// Softening of bonds. The force c (1 − d) s of a bond with stretch s decreases with the largest stretch that the bond has
/// had; ∫ c (1 − d) s ds = ½ c s₀² with the critical stretch s₀, which is given or follows from the fracture energy.
///
/// The scope is whether bonds begin to fail by their strength.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = bool)]
pub struct BondSoftening {
    /// The curve.
    #[serde(with = "crate::form")]
    #[deck(flatten)]
    pub law: SofteningLaw,
    /// Stretch s_e at which softening starts; below the critical stretch. Required unless `tensile_strength` of the
    /// material determines it. The tensile strength of the material is E s_e in a bar and larger in two and three
    /// dimensions; `check` prints it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(
        range = POSITIVE.described("a positive stretch below the critical stretch"),
        forbid_if(scope, BY_STRENGTH)
    )]
    pub onset_stretch: Option<f64>,
}

/// `linear`: a straight line to zero; `trilinear`: two straight lines with a knee; `exponential`: s_e exp(−(s − s_e)/s_x),
/// until the force has decreased to 1 % of its maximum and the bond breaks.
#[derive(Serialize, Deserialize, DeckKeys)]
#[serde(
    remote = "SofteningLaw",
    rename_all = "snake_case",
    deny_unknown_fields
)]
#[deck(remote = SofteningLaw, tag = "law", what = "softening law")]
enum SofteningLawForm {
    Linear,
    Trilinear {
        /// trilinear: force at the knee over the largest force. Default 1/3 (concrete, Petersson 1981).
        #[deck(range = between(0.0, 1.0), default = 1.0 / 3.0)]
        knee_force: f64,
        /// trilinear: position of the knee, 0 at the onset and 1 at the end of the curve. Default 2/9 (concrete, Petersson
        /// 1981).
        #[deck(range = between(0.0, 1.0), default = 2.0 / 9.0)]
        knee_position: f64,
    },
    Exponential,
}

described!(SofteningLaw: SofteningLawForm);

/// Why bonds that fail by strength have no onset.
const BY_STRENGTH: &str = "with failure = \"strength\" a bond softens from its stretch when the stress reaches the strength";

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
    pub fn surface(&self, strength: f64) -> pericles::Result<StrengthSurface> {
        match self {
            Self::Rankine => StrengthSurface::rankine(strength),
            Self::Expression(expression) => Ok(StrengthSurface::Function(Criterion::new(
                expression.clone(),
            ))),
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
    let given = table.maybe("softening", |item| {
        BondSoftening::read(&item, surface.is_some())
    })?;
    let usual = surface.map(|_| BondSoftening {
        law: SofteningLaw::Linear,
        onset_stretch: None,
    });
    Some(given.or(usual))
}
