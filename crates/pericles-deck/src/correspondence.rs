//! `model = "correspondence"`: correspondence materials for large strain.

use pericles::Result;
use pericles::material::{LinearSolid, Strains};
use pericles_solids::correspondence::{
    CorrespondenceMaterial, ElasticLaw, Plasticity, Stabilisation,
};
use pericles_solids::inelastic::Inelasticity;
use serde::{Deserialize, Serialize};

use crate::anisotropy::Anisotropy;
use crate::criterion::FailureCriterion;
use crate::form::described;
use crate::state_based::StateBased;

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

#[derive(Serialize, Deserialize)]
#[serde(remote = "Plasticity", deny_unknown_fields)]
struct PlasticityForm {
    yield_stress: f64,
    #[serde(default)]
    hardening: f64,
}

described!(Plasticity: PlasticityForm);
