//! `model = "correspondence"`: correspondence materials for large strain.

use pericles::Result;
use pericles::material::{LinearSolid, Strains};
use pericles_solids::correspondence::{
    CorrespondenceMaterial, ElasticLaw, Plasticity, Stabilisation,
};
use pericles_solids::inelastic::{Inelasticity, Yield};
use serde::{Deserialize, Serialize};

use crate::criterion::FailureCriterion;
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
    /// Plasticity; none for elastic materials.
    #[serde(default, with = "crate::form")]
    pub plasticity: Option<Plasticity>,
    /// Failure criterion of stress and strain, if bonds break by them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub criterion: Option<FailureCriterion>,
}

impl Correspondence {
    /// Returns the state-based material with the same constants, influence function and failure.
    pub(crate) fn as_state_based(&self) -> StateBased {
        StateBased {
            solid: self.solid.clone(),
            strains: Strains::Finite,
            inelastic: Inelasticity::Elastic,
            criterion: self.criterion.clone(),
        }
    }

    /// Returns the material of `pericles-solids`.
    ///
    /// # Errors
    /// A strength that is not positive.
    pub fn material(&self) -> Result<CorrespondenceMaterial> {
        let criterion = self.criterion.as_ref();
        Ok(CorrespondenceMaterial {
            solid: self.solid.clone(),
            law: self.law,
            stabilisation: self.stabilisation,
            plasticity: self.plasticity,
            criterion: criterion.map(FailureCriterion::criterion).transpose()?,
        })
    }
}

/// Keys of correspondence materials only.
const OWN_KEYS: [&str; 2] = ["law", "stabilisation"];

/// Rejects these keys in the table of another model.
pub(crate) fn forbid_keys(table: &Table<'_>) {
    for key in OWN_KEYS {
        table.forbid(key, "it requires model = \"correspondence\"");
    }
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
