//! `softening`, `tensile_strength` and `failure = "strength"`: bonds that soften before they break, and the strength from
//! which they do.

use pericles::material::{
    Criterion, FractureCalibration, SofteningLaw, StrengthSurface, TensileStrength,
};
use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use super::scope::MaterialScope;
use crate::declaration::Fallback;
use crate::expression::BondExpression;
use crate::fault::Fault;
use crate::form::described;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};

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

#[derive(Serialize, Deserialize)]
#[serde(remote = "TensileStrength", deny_unknown_fields)]
struct TensileStrengthForm {
    strength: f64,
    #[serde(with = "crate::form")]
    calibration: FractureCalibration,
}

described!(SofteningLaw: SofteningLawForm, TensileStrength: TensileStrengthForm);

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
    const RANKINE: &'static str = "rankine";

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

/// How bonds of the models `bond-stretch` and `linear` fail.
#[derive(DeckTable)]
#[deck(scope = MaterialScope<'s>)]
pub(super) struct StrengthKeys {
    #[deck(
        flatten,
        default = Failure::Stretch,
        forbid_if(
            !scope.breaks,
            "bonds without `fracture_energy` or `critical_stretch` never break"
        )
    )]
    failure: Failure,
    /// bond-stretch, linear: softening of bonds beyond an elastic limit. The area under the curve equals the energy of a bond
    /// that breaks at the critical stretch, so that a crack dissipates the fracture energy. Unloading is linear to the origin.
    /// The field Damage is then the lost fraction of the stiffness of a point's bonds. Uses a neighbour list. Default: no
    /// softening.
    #[deck(
        scope = failure.is_some_and(Failure::is_by_strength),
        otherwise = "it requires model = \"bond-stretch\" or \"linear\", whose pair force is proportional to the stretch, so that the area under the curve is the energy of the bond"
    )]
    softening: Option<BondSoftening>,
    /// bond-stretch, linear, with `softening`: tensile strength f_t. It determines the stretch s_e at which softening starts:
    /// the largest stress of a homogeneous body in uniaxial tension is f_t, in the mean over tension normal to the planes (10),
    /// (11) in 2D and (100), (110), (111) in 3D, or by integrals with fracture_calibration = "continuum" and for listed points;
    /// s_e = f_t/E in a bar. Independent of the elastic modulus and the fracture energy, for horizons up to the limit that
    /// `check` prints. Not with `onset_stretch`. With failure = "strength": the strength f_t at which bonds begin to fail, for
    /// any horizon.
    #[deck(
        flatten,
        key = "tensile_strength",
        with = tensile_strength,
        scope = (scope, failure, softening),
        otherwise = "it requires model = \"bond-stretch\" or \"linear\" with `softening`; failure = \"principal-stress\" has the key `strength`"
    )]
    tensile_strength: Option<f64>,
}

/// Failure criterion of bonds. `strength` (bond-stretch, linear): a bond is elastic at any stretch until the stress of one of
/// its ends reaches the strength of the material; it then softens from its stretch at that time, with the energy of a bond that
/// breaks at the critical stretch, or breaks at once beyond that stretch. Strength and fracture energy are then independent for
/// every horizon.
#[derive(DeckKeys)]
#[deck(tag = "failure", what = "failure criterion", scope = MaterialScope<'s>)]
enum Failure {
    #[default]
    Stretch,
    Strength {
        /// failure = "strength": the stresses at which bonds begin to fail. `rankine`: the largest principal stress is
        /// `tensile_strength`; or an expression of the stress in Pa (components, stress_1, stress_2, stress_3,
        /// equivalent_stress) that is 1 on the surface, such as `"stress_1/60e6 + stress_2/600e6"`.
        #[deck(
            with = surface,
            default = FailureSurface::Rankine,
            otherwise = "it requires failure = \"strength\" of a bond-based material; failure = \"expression\" has the key `criterion`"
        )]
        strength_surface: FailureSurface,
    },
}

impl Failure {
    fn is_by_strength(&self) -> bool {
        matches!(self, Self::Strength { .. })
    }
}

impl StrengthKeys {
    /// Returns tensile strength, softening and strength surface of a material whose fracture energy has this calibration.
    pub(super) fn made(self, calibration: FractureCalibration) -> Strength {
        let strength = self.tensile_strength;
        let usual = self.failure.is_by_strength().then_some(BondSoftening {
            law: SofteningLaw::Linear,
            onset_stretch: None,
        });
        let surface = match self.failure {
            Failure::Stretch => None,
            Failure::Strength { strength_surface } => Some(strength_surface),
        };
        let strength = strength.map(|strength| TensileStrength {
            strength,
            calibration,
        });
        (strength, self.softening.or(usual), surface)
    }
}

/// Tensile strength, softening and strength surface of a material.
pub(super) type Strength = (
    Option<TensileStrength>,
    Option<BondSoftening>,
    Option<FailureSurface>,
);

/// Reads a strength surface.
fn surface(item: &Item<'_>, scope: MaterialScope<'_>) -> Option<FailureSurface> {
    if item.is_keyword(FailureSurface::RANKINE) {
        return Some(FailureSurface::Rankine);
    }
    let text = item.text()?;
    let reason = match BondExpression::parse(&text, scope.body.frame.dimension.unwrap_or(3)) {
        Ok(expression) if expression.is_of_stress() => {
            return Some(FailureSurface::Expression(expression));
        }
        Ok(_) => "a strength surface is a function of the stress of a point: of its components, stress_1, stress_2, stress_3 and equivalent_stress".into(),
        Err(malformed) => malformed.reason,
    };
    item.report(Fault::bad_expression(text, reason));
    None
}

impl<S> Fallback<S> for FailureSurface {
    fn missing(self, table: &Table<'_>, key: &'static str, _: S) -> Option<Self> {
        table.record(key, Self::RANKINE);
        Some(self)
    }
}

/// Reads the tensile strength of a material, from which the onset of its softening follows, or at which its bonds begin to
/// fail. It requires a softening law without an onset or failure = "strength".
fn tensile_strength(
    table: &Table<'_>,
    (scope, failure, softening): (
        MaterialScope<'_>,
        Option<&Failure>,
        Option<&Option<BondSoftening>>,
    ),
) -> Option<Option<f64>> {
    const KEY: &str = "tensile_strength";
    let (Some(failure), Some(softening)) = (failure, softening) else {
        // It is unknown whether the key belongs to the material.
        table.know(&[KEY]);
        return None;
    };
    let by_strength = failure.is_by_strength();
    let forbidden = match softening {
        None if by_strength => None,
        None => Some(
            "it requires `softening = { law = … }`: the tensile strength gives the stretch at which softening starts; or failure = \"strength\"",
        ),
        Some(given) if given.onset_stretch.is_some() => Some(
            "`softening` has an `onset_stretch`, which determines the strength; give one of the two keys",
        ),
        Some(_) if !scope.breaks => {
            Some("bonds without `fracture_energy` or `critical_stretch` never break")
        }
        Some(_) => None,
    };
    if let Some(reason) = forbidden {
        table.forbid(KEY, reason);
        return Some(None);
    }
    let Some(item) = table.optional(KEY) else {
        match by_strength {
            true => table.requires_one_of(&[KEY]),
            false => table.requires_one_of(&[KEY, "softening.onset_stretch"]),
        }
        return None;
    };
    item.positive(Quantity::Traction).map(Some)
}
