//! `model = "state-based"`: elastic constants and failure of linear peridynamic solids.

use pericles::material::{
    BondFailure, Fracture, FractureCalibration, GivenConstants, LinearSolid, StateInfluence,
    Strains, StressState, StretchDefinition,
};
use pericles_solids::inelastic::{Inelasticity, Yield};
use serde::{Deserialize, Serialize};

use crate::constants;
use crate::criterion::FailureCriterion;
use crate::property::{MaterialProperty, number_of};
use crate::quantity::Quantity;
use crate::reader::Table;
use crate::vocabulary::{BY_STATE, MODULI, STRENGTHS};

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

/// Rules for reading the constants of state-based materials.
pub(crate) struct SolidRules {
    state: Option<StressState>,
    criterion: Option<Criterion>,
    definition: Option<StretchDefinition>,
    calibration: Option<FractureCalibration>,
}

#[derive(Clone, Copy, PartialEq)]
enum Criterion {
    Stretch,
    BondEnergy,
    ByState,
}

/// Words of `failure` for limits of bonds.
const LIMITS: [(&str, Criterion); 2] = [
    ("stretch", Criterion::Stretch),
    ("bond-energy", Criterion::BondEnergy),
];

impl SolidRules {
    /// Reads the rules of a material; `calibration` follows from the body. `shared`: other materials inherit them.
    /// `by_state`: its bonds break by stress or strain. `only`: the definition of the critical stretch of models that have
    /// one.
    pub(crate) fn read(
        table: &Table<'_>,
        state: Option<StressState>,
        calibration: Option<FractureCalibration>,
        [shared, by_state]: [bool; 2],
        only: Option<StretchDefinition>,
    ) -> Self {
        let words = BY_STATE.map(|(word, _)| (word, Criterion::ByState));
        let words: Vec<_> = LIMITS.into_iter().chain(words).collect();
        match shared || by_state {
            true => Self::of_words(table, state, calibration, &words, only),
            false => Self::of_breaking_bonds(table, state, calibration, &words, only),
        }
    }

    /// Reads the rules of bonds between two materials, which break by stretch or energy.
    pub(crate) fn interface(
        table: &Table<'_>,
        state: Option<StressState>,
        calibration: Option<FractureCalibration>,
        only: Option<StretchDefinition>,
    ) -> Self {
        Self::of_breaking_bonds(table, state, calibration, &LIMITS, only)
    }

    /// Reads the rules of bonds that break only with a fracture energy or a critical stretch.
    fn of_breaking_bonds(
        table: &Table<'_>,
        state: Option<StressState>,
        calibration: Option<FractureCalibration>,
        words: &[(&'static str, Criterion)],
        only: Option<StretchDefinition>,
    ) -> Self {
        if STRENGTHS.iter().any(|key| table.has(key)) {
            return Self::of_words(table, state, calibration, words, only);
        }
        let definition = only.is_none().then_some("stretch_definition");
        for key in ["failure"].into_iter().chain(definition) {
            table.forbid(key, "bonds without `fracture_energy` never break");
        }
        Self {
            state,
            criterion: Some(Criterion::Stretch),
            definition: Some(only.unwrap_or_default()),
            calibration,
        }
    }

    fn of_words(
        table: &Table<'_>,
        state: Option<StressState>,
        calibration: Option<FractureCalibration>,
        words: &[(&'static str, Criterion)],
        only: Option<StretchDefinition>,
    ) -> Self {
        let criterion = table.choice_or_first("failure", "failure criterion", words);
        let definition = match criterion {
            _ if only.is_some() => only,
            Some(Criterion::BondEnergy) => {
                table.forbid(
                    "stretch_definition",
                    "it requires failure = \"stretch\"; the critical bond energy does not depend on it",
                );
                Some(StretchDefinition::default())
            }
            Some(Criterion::ByState) => Some(StretchDefinition::default()),
            _ => table.worded("stretch_definition", "definition of the critical stretch"),
        };
        Self {
            state,
            criterion,
            definition,
            calibration,
        }
    }

    /// Reads the elastic constants: two of four, or Young's modulus of a bar.
    pub(crate) fn elastic(&self, table: &Table<'_>) -> Option<GivenConstants> {
        table.together(MODULI);
        let modulus = |key| table.maybe(key, |item| item.positive(Quantity::Modulus));
        let young = table.maybe("youngs_modulus", |item| {
            number_of(&item, MaterialProperty::YoungsModulus)
        });
        let [bulk, shear] = ["bulk_modulus", "shear_modulus"].map(modulus);
        let is_function = table
            .optional("youngs_modulus")
            .is_some_and(|item| item.is_table());
        if is_function {
            for key in ["bulk_modulus", "shear_modulus"] {
                table.forbid(
                    key,
                    "with a function as `youngs_modulus`, Poisson's ratio is constant; use `poisson_ratio`",
                );
            }
        }
        table.forbid(
            "modulus",
            "the bulk stiffness of a state-based material is exact on every lattice; use influence = { function = \"isotropic\" } for exact shear",
        );
        let poisson_ratio = if self.state == Some(StressState::Uniaxial) {
            table.forbid(
                "poisson_ratio",
                "the motion of a bar does not depend on Poisson's ratio; remove the key",
            );
            Some(None)
        } else {
            table.maybe("poisson_ratio", |item| {
                item.within(
                    Quantity::Number,
                    "a number above -1 and below 0.5, where bulk and shear modulus are positive",
                    |ratio| ratio > -1.0 && ratio < 0.5,
                )
            })
        };
        let given = GivenConstants {
            young: young?,
            poisson_ratio: poisson_ratio?,
            bulk: bulk?,
            shear: shear?,
        };
        table.accept(given.resolve(self.state?))?;
        Some(given)
    }

    /// Reads the failure of bonds.
    pub(crate) fn failure(&self, table: &Table<'_>) -> Option<BondFailure> {
        if self.criterion == Some(Criterion::ByState) {
            return Some(BondFailure::ByCriterion);
        }
        if self.criterion == Some(Criterion::BondEnergy) {
            table.forbid(
                "critical_stretch",
                "failure = \"bond-energy\" requires `fracture_energy`, which determines the critical bond energy",
            );
        }
        let fracture = constants::fracture(table)?;
        Some(match (fracture, self.criterion?) {
            (Fracture::Unbreakable, _) => BondFailure::Unbreakable,
            (Fracture::CriticalStretch(stretch), _) => BondFailure::CriticalStretch(stretch),
            (Fracture::Energy { energy, .. }, Criterion::Stretch) => BondFailure::Stretch {
                fracture_energy: energy,
                definition: self.definition?,
                calibration: self.calibration?,
            },
            (Fracture::Energy { .. }, Criterion::ByState) => BondFailure::ByCriterion,
            (Fracture::Energy { energy, .. }, Criterion::BondEnergy) => BondFailure::BondEnergy {
                fracture_energy: energy,
                calibration: self.calibration?,
            },
        })
    }
}

/// Reads `yield_stress` and `hardening` of any model.
pub(crate) fn read_yield(table: &Table<'_>) -> Option<Option<Yield>> {
    let stress = table.maybe("yield_stress", |item| {
        number_of(&item, MaterialProperty::YieldStress)
    });
    if !table.has("yield_stress") {
        table.forbid("hardening", "it requires `yield_stress`");
        return Some(None);
    }
    let hardening = table.or("hardening", 0.0, |item| {
        item.within(
            Quantity::Modulus,
            "zero or a positive modulus; softening is not supported because the model has no length scale for it",
            |hardening| hardening >= 0.0,
        )
    });
    Some(Some(Yield {
        stress: stress??,
        hardening: hardening?,
    }))
}
