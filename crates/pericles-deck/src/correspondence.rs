//! `model = "correspondence"`: correspondence materials for large strain.

use pericles::Result;
use pericles::material::{LinearSolid, Strains};
use pericles_solids::correspondence::{
    CorrespondenceMaterial, ElasticLaw, Plasticity, Stabilisation,
};
use pericles_solids::inelastic::{Inelasticity, Yield};
use serde::{Deserialize, Serialize};

use crate::anisotropy::Anisotropy;
use crate::criterion::FailureCriterion;
use crate::declaration::DeckValue;
use crate::reader::Table;
use crate::state_based::{StateBased, read_yield};
use crate::vocabulary::MODULI;

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
    /// Elastic constants and axes of an anisotropic material; the elastic constants of `solid` are then those of Voigt's
    /// average.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub anisotropy: Option<Box<Anisotropy>>,
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
    /// A strength that is not positive; anisotropic constants for which a strain has no positive energy.
    pub fn material(&self) -> Result<CorrespondenceMaterial> {
        let (criterion, anisotropy) = (self.criterion.as_ref(), self.anisotropy.as_ref());
        Ok(CorrespondenceMaterial {
            solid: self.solid.clone(),
            law: self.law,
            stabilisation: self.stabilisation,
            plasticity: self.plasticity,
            anisotropy: anisotropy.map(|own| own.stiffness()).transpose()?,
            criterion: criterion.map(FailureCriterion::criterion).transpose()?,
        })
    }
}

/// Keys of correspondence materials only.
const OWN_KEYS: [&str; 3] = ["law", "stabilisation", "anisotropy"];

/// Rejects these keys in the table of another model.
pub(crate) fn forbid_keys(table: &Table<'_>) {
    for key in OWN_KEYS {
        table.forbid(key, "it requires model = \"correspondence\"");
    }
}

/// Reads `anisotropy`, which replaces other elastic constants and requires an elastic material.
pub(crate) fn anisotropy(table: &Table<'_>) -> Option<Option<Anisotropy>> {
    let read = table.maybe("anisotropy", |item| DeckValue::read(&item, ()));
    if table.has("anisotropy") {
        for &key in MODULI.iter().chain(&["poisson_ratio"]) {
            table.forbid(key, "`anisotropy` contains all elastic constants");
        }
        table.forbid("yield_stress", "materials with `anisotropy` are elastic");
        table.forbid(
            "law",
            "with `anisotropy` it is St Venant–Kirchhoff's law with the anisotropic stiffness",
        );
    }
    read
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
