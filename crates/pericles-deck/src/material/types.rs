//! Data types of materials.

use pericles::family::VolumeCorrection;
use pericles::kernel::Influence;
use pericles::material::{
    BondMaterial, CubicLaw, Fracture, Modulus, PairLaw, SurfaceCorrection, TensileStrength,
};
use pericles::operator::DamageMeasure;
use pericles_dispersion::tuning::TunedTable;
use pericles_waves::ForceForm;
use serde::{Deserialize, Serialize};

use super::scatter::Scatter;
use super::softening::{BondSoftening, FailureSurface};
use crate::correspondence::Correspondence;
use crate::form::described;
use crate::property::MaterialFunctions;
use crate::state_based::StateBased;

/// A material of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Name for assignments and interfaces; "default" if none ([`Material::name`](method@Material::name)).
    #[serde(default)]
    pub name: Option<String>,
    /// Whether points without an assignment have this material; otherwise every point needs an assignment.
    #[serde(default = "yes")]
    pub is_default: bool,
    /// Law, constants, horizon and failure.
    pub model: MaterialModel,
    /// Properties that are functions; each multiplies the number of the model.
    #[serde(default, skip_serializing_if = "MaterialFunctions::is_empty")]
    pub functions: MaterialFunctions,
    /// Tuning result of the influence function, if it is tuned.
    #[serde(default, with = "crate::form")]
    pub tuned: Option<TunedTable>,
    /// Sets whose bonds never break.
    #[serde(default)]
    pub no_fail: Vec<String>,
    /// Correction for missing bonds near free surfaces.
    #[serde(default, with = "crate::form")]
    pub surface_correction: SurfaceCorrection,
    /// Random distribution of strength.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scatter: Option<Scatter>,
    /// How bonds soften before they break, if they do.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub softening: Option<BondSoftening>,
    /// Tensile strength from which the onset of softening follows, if it is given.
    #[serde(default, with = "crate::form")]
    pub tensile_strength: Option<TensileStrength>,
    /// Stresses at which bonds begin to soften or break; `None` if they do so by their stretch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength_surface: Option<FailureSurface>,
    /// Damage measure, if it is given.
    #[serde(default, with = "crate::form")]
    pub damage: Option<DamageMeasure>,
    /// Force kernel; affects speed only.
    #[serde(default, with = "crate::form")]
    pub form: ForceForm,
}

/// Material models.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MaterialModel {
    /// Bond-based: pair forces with a fixed Poisson's ratio.
    Bonds(#[serde(with = "crate::form")] BondMaterial),
    /// State-based: forces that depend on all bonds of both end points, with any Poisson's ratio.
    StateBased(StateBased),
    /// Correspondence: forces from the stress of a nonlocal deformation gradient, with any Poisson's ratio,
    /// large strain and plasticity.
    Correspondence(Correspondence),
}

impl From<BondMaterial> for Material {
    /// A single material with the fastest force kernel.
    fn from(bonds: BondMaterial) -> Self {
        Self::from(MaterialModel::Bonds(bonds))
    }
}

impl From<StateBased> for Material {
    /// A single material for the whole body.
    fn from(solid: StateBased) -> Self {
        Self::from(MaterialModel::StateBased(solid))
    }
}

impl From<Correspondence> for Material {
    /// A single material for the whole body.
    fn from(solid: Correspondence) -> Self {
        Self::from(MaterialModel::Correspondence(solid))
    }
}

impl From<MaterialModel> for Material {
    fn from(model: MaterialModel) -> Self {
        Self {
            name: None,
            is_default: true,
            model,
            functions: MaterialFunctions::default(),
            tuned: None,
            no_fail: Vec::new(),
            surface_correction: SurfaceCorrection::default(),
            scatter: None,
            softening: None,
            tensile_strength: None,
            strength_surface: None,
            damage: None,
            form: ForceForm::default(),
        }
    }
}

/// A further material, assigned to sets by its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedMaterial {
    /// Name.
    pub name: String,
    /// Law, constants, horizon and failure; shared properties must equal those of the body's material.
    pub model: MaterialModel,
    /// Properties that are functions; each multiplies the number of the model.
    #[serde(default, skip_serializing_if = "MaterialFunctions::is_empty")]
    pub functions: MaterialFunctions,
    /// Tensile strength from which the onset of softening follows, if it is given.
    #[serde(default, with = "crate::form")]
    pub tensile_strength: Option<TensileStrength>,
    /// Stresses at which its bonds begin to soften or break; `None` if they do so by their stretch.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength_surface: Option<FailureSurface>,
}

impl MaterialModel {
    /// Returns the mass density ρ, kg/m³.
    pub fn density(&self) -> f64 {
        match self {
            Self::Bonds(bonds) => bonds.density,
            Self::StateBased(state) => state.solid.density,
            Self::Correspondence(state) => state.solid.density,
        }
    }

    /// Returns the horizon δ, m.
    pub fn horizon(&self) -> f64 {
        match self {
            Self::Bonds(bonds) => bonds.horizon,
            Self::StateBased(state) => state.solid.horizon,
            Self::Correspondence(state) => state.solid.horizon,
        }
    }

    /// Returns the volume correction.
    pub fn volume_correction(&self) -> VolumeCorrection {
        match self {
            Self::Bonds(bonds) => bonds.volume_correction,
            Self::StateBased(state) => state.solid.volume_correction,
            Self::Correspondence(state) => state.solid.volume_correction,
        }
    }

    /// Returns the word of `model`, without the approximation.
    pub fn name(&self) -> &'static str {
        let bonds = match self {
            Self::Bonds(bonds) => bonds,
            Self::StateBased(_) => return "state-based",
            Self::Correspondence(_) => return "correspondence",
        };
        match bonds.law {
            PairLaw::BondStretch => "bond-stretch",
            PairLaw::Linear => "linear",
            PairLaw::GreenStrain | PairLaw::Approximated(CubicLaw::GreenStrain, _) => {
                "green-strain"
            }
            PairLaw::CubicSoftening | PairLaw::Approximated(CubicLaw::CubicSoftening, _) => {
                "cubic-softening"
            }
        }
    }
}

/// Default of fields that are true if missing.
fn yes() -> bool {
    true
}

impl Material {
    /// Name of a material without one.
    pub const DEFAULT: &'static str = "default";

    /// Returns the name that assignments and interfaces use.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(Self::DEFAULT)
    }

    /// Returns the bond-based material, if it is one.
    pub fn bonds(&self) -> Option<&BondMaterial> {
        match &self.model {
            MaterialModel::Bonds(bonds) => Some(bonds),
            MaterialModel::StateBased(_) | MaterialModel::Correspondence(_) => None,
        }
    }

    /// Returns the bond-based material mutably, if it is one.
    pub fn bonds_mut(&mut self) -> Option<&mut BondMaterial> {
        match &mut self.model {
            MaterialModel::Bonds(bonds) => Some(bonds),
            MaterialModel::StateBased(_) | MaterialModel::Correspondence(_) => None,
        }
    }

    /// Returns the state-based material, if it is one.
    pub fn state_based(&self) -> Option<&StateBased> {
        match &self.model {
            MaterialModel::StateBased(solid) => Some(solid),
            MaterialModel::Bonds(_) | MaterialModel::Correspondence(_) => None,
        }
    }

    /// Returns the correspondence material, if it is one.
    pub fn correspondence(&self) -> Option<&Correspondence> {
        match &self.model {
            MaterialModel::Correspondence(solid) => Some(solid),
            MaterialModel::Bonds(_) | MaterialModel::StateBased(_) => None,
        }
    }

    /// Returns the mass density ρ, kg/m³.
    pub fn density(&self) -> f64 {
        self.model.density()
    }

    /// Returns the horizon δ, m.
    pub fn horizon(&self) -> f64 {
        self.model.horizon()
    }

    /// Returns the volume correction.
    pub fn volume_correction(&self) -> VolumeCorrection {
        self.model.volume_correction()
    }

    /// Returns the word of `material.model`, without the approximation.
    pub fn model_name(&self) -> &'static str {
        self.model.name()
    }
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "BondMaterial", deny_unknown_fields)]
struct BondMaterialForm {
    #[serde(rename = "model", with = "crate::form")]
    law: PairLaw,
    density: f64,
    #[serde(with = "crate::form")]
    modulus: Modulus,
    horizon: f64,
    #[serde(with = "crate::form")]
    influence: Influence,
    #[serde(with = "crate::form")]
    volume_correction: VolumeCorrection,
    #[serde(with = "crate::form")]
    fracture: Fracture,
}

described!(BondMaterial: BondMaterialForm);
