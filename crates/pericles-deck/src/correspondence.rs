//! `model = "correspondence"`: solids at large strain.

use pericles::material::{Inelasticity, LinearSolid, Strains, Yield};
use pericles_solids::correspondence::{
    CorrespondenceMaterial, ElasticLaw, Plasticity, Stabilisation,
};
use serde::{Deserialize, Serialize};

use crate::reader::Table;
use crate::state_based::{StateBased, read_yield};

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
    /// When the material yields, if it does.
    #[serde(default, with = "crate::form")]
    pub plasticity: Option<Plasticity>,
}

impl Correspondence {
    /// The state-based material with the same constants, influence function and failure.
    pub(crate) fn as_state_based(&self) -> StateBased {
        StateBased {
            solid: self.solid.clone(),
            strains: Strains::Finite,
            inelastic: Inelasticity::Elastic,
        }
    }

    /// The material as the engine's extension knows it.
    pub fn material(&self) -> CorrespondenceMaterial {
        CorrespondenceMaterial {
            solid: self.solid.clone(),
            law: self.law,
            stabilisation: self.stabilisation,
            plasticity: self.plasticity,
        }
    }
}

/// Keys of correspondence materials alone.
const OWN_KEYS: [&str; 2] = ["law", "stabilisation"];

/// Refuses them in the table of another material.
pub(crate) fn forbid_keys(table: &Table<'_>) {
    for key in OWN_KEYS {
        table.forbid(key, "it belongs to model = \"correspondence\"");
    }
}

/// The elastic law: a material that yields has the logarithmic one.
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
        "\"hencky\" with `yield_stress`: plastic flow is computed in logarithmic strains, whose elastic law it is; leave `law` out",
    );
    None
}

/// `yield_stress` and `hardening`.
pub(crate) fn plasticity(table: &Table<'_>) -> Option<Option<Plasticity>> {
    let yields = read_yield(table)?;
    Some(yields.map(|Yield { stress, hardening }| Plasticity {
        yield_stress: stress,
        hardening,
    }))
}
