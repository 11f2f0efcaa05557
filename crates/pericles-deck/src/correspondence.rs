//! `model = "correspondence"`: correspondence materials for large strain.

use pericles::material::{Inelasticity, LinearSolid, Strains, Yield};
use pericles_solids::correspondence::{
    CorrespondenceMaterial, ElasticLaw, Plasticity, Stabilisation,
};
use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;
use crate::state_based::{StateBased, read_yield};
use crate::vocabulary::STRENGTHS;

/// A correspondence material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Correspondence {
    /// Elastic constants, horizon, influence function and failure.
    #[serde(with = "crate::form")]
    pub solid: LinearSolid,
    /// The elastic law.
    #[serde(default, with = "crate::form")]
    pub law: ElasticLaw,
    /// Control of zero-energy modes.
    #[serde(default, with = "crate::form")]
    pub stabilisation: Stabilisation,
    /// Plasticity; none for elastic materials.
    #[serde(default, with = "crate::form")]
    pub plasticity: Option<Plasticity>,
    /// The largest principal stress that a bond bears, Pa, if bonds break by their stress.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength: Option<f64>,
}

impl Correspondence {
    /// Returns the state-based material with the same constants, influence function and failure.
    pub(crate) fn as_state_based(&self) -> StateBased {
        StateBased {
            solid: self.solid.clone(),
            strains: Strains::Finite,
            inelastic: Inelasticity::Elastic,
        }
    }

    /// Returns the material of `pericles-solids`.
    pub fn material(&self) -> CorrespondenceMaterial {
        CorrespondenceMaterial {
            solid: self.solid.clone(),
            law: self.law,
            stabilisation: self.stabilisation,
            plasticity: self.plasticity,
            strength: self.strength,
        }
    }
}

/// Keys of correspondence materials only.
const OWN_KEYS: [&str; 3] = ["law", "stabilisation", "strength"];

/// Refuses these keys in the table of another model.
pub(crate) fn forbid_keys(table: &Table<'_>) {
    for key in OWN_KEYS {
        table.forbid(key, "it requires model = \"correspondence\"");
    }
}

/// Reads `failure` and `strength`: the principal stress at which bonds break, if they break by stress.
pub(crate) fn strength(table: &Table<'_>) -> Option<Option<f64>> {
    let by_stress = table.choice_or_first(
        "failure",
        "failure criterion",
        &[("stretch", false), ("principal-stress", true)],
    )?;
    if !by_stress {
        table.forbid("strength", "it requires failure = \"principal-stress\"");
        return Some(None);
    }
    for &key in STRENGTHS {
        table.forbid(
            key,
            "with failure = \"principal-stress\" bonds break at the `strength`, which determines the dissipated energy",
        );
    }
    let strength = table.required("strength")?;
    strength.positive(Quantity::Traction).map(Some)
}

/// Reads the elastic law; plastic materials have the logarithmic one.
pub(crate) fn law(table: &Table<'_>, yields: bool) -> Option<ElasticLaw> {
    let Some(item) = table.optional("law").filter(|_| yields) else {
        return match yields {
            true => {
                table.record("law", "hencky");
                Some(ElasticLaw::Hencky)
            }
            false => table.worded("law", "elastic law"),
        };
    };
    if item.is_keyword("hencky") {
        return Some(ElasticLaw::Hencky);
    }
    item.out_of_range(
        "\"hencky\" with `yield_stress`, because plasticity uses logarithmic strains; remove `law`",
    );
    None
}

/// Reads `yield_stress` and `hardening`.
pub(crate) fn plasticity(table: &Table<'_>) -> Option<Option<Plasticity>> {
    let yields = read_yield(table)?;
    Some(yields.map(|Yield { stress, hardening }| Plasticity {
        yield_stress: stress,
        hardening,
    }))
}
