//! `model = "state-based"`: elastic constants and failure of linear peridynamic solids.

use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, Fracture, FractureCalibration, GivenConstants, LinearSolid, StateInfluence,
    Strains, StressState, StretchDefinition,
};
use pericles_deck_derive::DeckTable;
use pericles_solids::inelastic::{Inelasticity, Yield};
use serde::{Deserialize, Serialize};

use crate::criterion::FailureCriterion;
use crate::declaration::DeckKeys;
use crate::form::described;
use crate::property::{MaterialProperty, number_of};
use crate::range::{NOT_NEGATIVE, Range, between};
use crate::reader::Table;

/// A state-based material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateBased {
    /// Elastic constants, horizon, influence function and failure.
    #[serde(with = "crate::form")]
    pub solid: LinearSolid,
    /// Bond extensions for finite or small strains.
    #[serde(default, with = "crate::form")]
    pub strains: Strains,
    /// Viscoelastic or plastic shear behaviour.
    #[serde(
        default,
        with = "crate::form",
        skip_serializing_if = "Inelasticity::is_elastic"
    )]
    pub inelastic: Inelasticity,
    /// Failure criterion of stress and strain, if bonds break by them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub criterion: Option<FailureCriterion>,
}

impl StateBased {
    /// Returns the influence function of the bond length; none if it follows from the lattice.
    pub fn given_influence(&self) -> Option<pericles::kernel::Influence> {
        match &self.solid.influence {
            StateInfluence::Isotropic => None,
            StateInfluence::Function(function) => Some(pericles::kernel::Influence {
                function: function.clone(),
                ..Default::default()
            }),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "LinearSolid", deny_unknown_fields)]
struct LinearSolidForm {
    density: f64,
    #[serde(with = "crate::form")]
    elastic: GivenConstants,
    horizon: f64,
    #[serde(with = "crate::form")]
    influence: StateInfluence,
    #[serde(with = "crate::form")]
    volume_correction: VolumeCorrection,
    #[serde(with = "crate::form")]
    failure: BondFailure,
}

#[derive(Serialize, Deserialize)]
#[serde(
    remote = "StateInfluence",
    rename_all = "snake_case",
    deny_unknown_fields
)]
enum StateInfluenceForm {
    Function(#[serde(with = "crate::form")] InfluenceFunction),
    Isotropic,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "BondFailure", rename_all = "snake_case", deny_unknown_fields)]
enum BondFailureForm {
    Unbreakable,
    CriticalStretch(f64),
    Stretch {
        fracture_energy: f64,
        #[serde(with = "crate::form")]
        definition: StretchDefinition,
        #[serde(with = "crate::form")]
        calibration: FractureCalibration,
    },
    BondEnergy {
        fracture_energy: f64,
        #[serde(with = "crate::form")]
        calibration: FractureCalibration,
    },
    ByCriterion,
}

/// Elastic constants; the scope is the stress state.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "GivenConstants", deny_unknown_fields)]
#[deck(remote = GivenConstants, scope = Option<StressState>, verify = resolve)]
struct GivenConstantsForm {
    /// Young's modulus E. Every material needs elastic constants: bond-based ones exactly one of E, K and G; state-based and
    /// correspondence ones two of E, ν, K and G, or E alone for a bar. A number or an expression of position, with which all
    /// moduli change in proportion at constant ν; a bond of a bond-based material has the mean stiffness of its end points.
    /// Expressions use a neighbour list in state-based materials.
    #[serde(default, rename = "youngs_modulus")]
    #[deck(key = "youngs_modulus", with = number_of(MaterialProperty::YoungsModulus), range = POSITIVE)]
    young: Option<f64>,
    /// Poisson's ratio ν. state-based, correspondence: free. Bond-based: if given, it must be the value that bond-based models
    /// have: 1/3 in plane stress, 1/4 in plane strain and 3D. Not for bars.
    #[serde(default)]
    #[deck(
        range = RATIOS,
        forbid_if(
            scope == Some(StressState::Uniaxial),
            "the motion of a bar does not depend on Poisson's ratio; remove the key"
        )
    )]
    poisson_ratio: Option<f64>,
    /// Bulk modulus K.
    #[serde(default, rename = "bulk_modulus")]
    #[deck(key = "bulk_modulus", quantity = Modulus, range = POSITIVE)]
    bulk: Option<f64>,
    /// Shear modulus G.
    #[serde(default, rename = "shear_modulus")]
    #[deck(key = "shear_modulus", quantity = Modulus, range = POSITIVE)]
    shear: Option<f64>,
}

const RATIOS: Range = between(-1.0, 0.5)
    .described("a number above -1 and below 0.5, where bulk and shear modulus are positive");

/// Plastic flow.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "Yield", deny_unknown_fields)]
#[deck(remote = Yield)]
struct YieldForm {
    /// Yield stress σ_y in uniaxial tension. state-based, not for bars: von Mises criterion averaged over all directions in 3D;
    /// maximum in-plane shear stress σ_y/√3 in 2D. Uses a neighbour list. correspondence: J2 plasticity in logarithmic strains,
    /// with the von Mises equivalent of the Kirchhoff stress. A number, an expression of position and `temperature` (K), or a
    /// table by temperature; a point yields at the stress of its present temperature. Default: elastic.
    #[deck(key = "yield_stress", with = number_of(MaterialProperty::YieldStress), range = POSITIVE)]
    stress: f64,
    /// Linear isotropic hardening modulus H: the yield stress is σ_y + H ε_p with the equivalent plastic strain ε_p.
    #[deck(quantity = Modulus, range = HARDENING, default = 0.0)]
    hardening: f64,
}

const HARDENING: Range = NOT_NEGATIVE.described(
    "zero or a positive modulus; softening is not supported because the model has no length scale for it",
);

described!(
    LinearSolid: LinearSolidForm,
    StateInfluence: StateInfluenceForm,
    BondFailure: BondFailureForm,
    GivenConstants: GivenConstantsForm,
    Yield: YieldForm,
);

/// Rejects constants that do not determine the elastic behaviour, or that are inconsistent.
fn resolve(table: &Table<'_>, given: &GivenConstants, state: Option<StressState>) -> Option<()> {
    table.accept(given.resolve(state?)).map(drop)
}

/// Reads `yield_stress` and `hardening`; none for elastic materials.
pub(crate) fn read_yield<S: Copy>(table: &Table<'_>, scope: S) -> Option<Option<Yield>> {
    if table.optional("yield_stress").is_none() {
        table.forbid("hardening", "it requires `yield_stress`");
        return Some(None);
    }
    Yield::read_keys(table, scope).map(Some)
}

/// Returns the strength of bonds whose limit is a stretch or energy.
pub(crate) fn strength_of(failure: &BondFailure) -> Fracture {
    match *failure {
        BondFailure::Unbreakable | BondFailure::ByCriterion => Fracture::Unbreakable,
        BondFailure::CriticalStretch(stretch) => Fracture::CriticalStretch(stretch),
        BondFailure::Stretch {
            fracture_energy: energy,
            calibration,
            ..
        }
        | BondFailure::BondEnergy {
            fracture_energy: energy,
            calibration,
        } => Fracture::Energy {
            energy,
            calibration,
        },
    }
}

/// Returns the failure of bonds of a strength, which break by the stretch of a definition or, without one, by their energy.
pub(crate) fn failure_of(strength: Fracture, definition: Option<StretchDefinition>) -> BondFailure {
    match (strength, definition) {
        (Fracture::Unbreakable, _) => BondFailure::Unbreakable,
        (Fracture::CriticalStretch(stretch), _) => BondFailure::CriticalStretch(stretch),
        (
            Fracture::Energy {
                energy,
                calibration,
            },
            Some(definition),
        ) => BondFailure::Stretch {
            fracture_energy: energy,
            definition,
            calibration,
        },
        (
            Fracture::Energy {
                energy,
                calibration,
            },
            None,
        ) => BondFailure::BondEnergy {
            fracture_energy: energy,
            calibration,
        },
    }
}
