//! Materials as plain data.

use pericles::family::VolumeCorrection;
use pericles::material::{BondMaterial, CubicLaw, PairLaw, SurfaceCorrection};
use pericles::operator::DamageMeasure;
use pericles_dispersion::tuning::TunedTable;
use pericles_waves::ForceForm;
use serde::{Deserialize, Serialize};

use super::scatter::Scatter;
use crate::correspondence::Correspondence;
use crate::state_based::StateBased;

/// The material with what goes with it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Its name, for people, assignments and interfaces; "default" if it is left out ([`Material::name`](method@Material::name)).
    #[serde(default)]
    pub name: Option<String>,
    /// Whether points without an assignment have this material. If not, every point needs an assignment.
    #[serde(default = "yes")]
    pub is_default: bool,
    /// Law, constants, horizon and breaking.
    pub model: MaterialModel,
    /// How the coefficients of the influence function were found, if it is tuned against dispersion.
    #[serde(default, with = "crate::form")]
    pub tuned: Option<TunedTable>,
    /// Sets whose bonds never break.
    #[serde(default)]
    pub no_fail: Vec<String>,
    /// What is done about the bonds that points near surfaces lack.
    #[serde(default, with = "crate::form")]
    pub surface_correction: SurfaceCorrection,
    /// How the strength of points scatters, if it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scatter: Option<Scatter>,
    /// How damage is measured, if it is given.
    #[serde(default, with = "crate::form")]
    pub damage: Option<DamageMeasure>,
    /// How bonds are kept: a matter of speed only.
    #[serde(default, with = "crate::form")]
    pub form: ForceForm,
}

/// The model of a material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MaterialModel {
    /// A pair force for each bond: Poisson's ratio is fixed.
    Bonds(#[serde(with = "crate::form")] BondMaterial),
    /// Forces that depend on all bonds of both ends: any Poisson's ratio.
    StateBased(StateBased),
    /// Forces from the stress of a deformation gradient: any Poisson's ratio, large strain, plastic flow.
    Correspondence(Correspondence),
}

impl From<BondMaterial> for Material {
    /// One material for the whole body, whose bonds are kept as is fastest.
    fn from(bonds: BondMaterial) -> Self {
        Self::from(MaterialModel::Bonds(bonds))
    }
}

impl From<StateBased> for Material {
    /// One material for the whole body.
    fn from(solid: StateBased) -> Self {
        Self::from(MaterialModel::StateBased(solid))
    }
}

impl From<Correspondence> for Material {
    /// One material for the whole body.
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
            tuned: None,
            no_fail: Vec::new(),
            surface_correction: SurfaceCorrection::default(),
            scatter: None,
            damage: None,
            form: ForceForm::default(),
        }
    }
}

/// A material beside the body's, assigned to sets by its name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedMaterial {
    /// Its name.
    pub name: String,
    /// Law, constants, horizon and breaking; what all bonds of a body share must be that of the body's material.
    pub model: MaterialModel,
}

impl MaterialModel {
    /// Mass density ρ, kg/m³.
    pub fn density(&self) -> f64 {
        match self {
            Self::Bonds(bonds) => bonds.density,
            Self::StateBased(state) => state.solid.density,
            Self::Correspondence(state) => state.solid.density,
        }
    }

    /// Horizon δ, m.
    pub fn horizon(&self) -> f64 {
        match self {
            Self::Bonds(bonds) => bonds.horizon,
            Self::StateBased(state) => state.solid.horizon,
            Self::Correspondence(state) => state.solid.horizon,
        }
    }

    /// Partial volumes at the horizon.
    pub fn volume_correction(&self) -> VolumeCorrection {
        match self {
            Self::Bonds(bonds) => bonds.volume_correction,
            Self::StateBased(state) => state.solid.volume_correction,
            Self::Correspondence(state) => state.solid.volume_correction,
        }
    }

    /// The word of `model`, whatever the treatment of a law.
    pub fn name(&self) -> &'static str {
        let bonds = match self {
            Self::Bonds(bonds) => bonds,
            Self::StateBased(_) => return "state-based",
            Self::Correspondence(_) => return "correspondence",
        };
        match bonds.law {
            PairLaw::BondStretch => "bond-stretch",
            PairLaw::Linear => "linear",
            PairLaw::GreenStrain | PairLaw::Treated(CubicLaw::GreenStrain, _) => "green-strain",
            PairLaw::Literal57 | PairLaw::Treated(CubicLaw::Literal57, _) => "literal57",
        }
    }
}

/// For fields that are true if they are left out.
fn yes() -> bool {
    true
}

impl Material {
    /// The name of a material that has none.
    pub const DEFAULT: &'static str = "default";

    /// What assignments and interfaces call it.
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(Self::DEFAULT)
    }

    /// The bond-based material, if it is one.
    pub fn bonds(&self) -> Option<&BondMaterial> {
        match &self.model {
            MaterialModel::Bonds(bonds) => Some(bonds),
            MaterialModel::StateBased(_) | MaterialModel::Correspondence(_) => None,
        }
    }

    /// The same, to be changed.
    pub fn bonds_mut(&mut self) -> Option<&mut BondMaterial> {
        match &mut self.model {
            MaterialModel::Bonds(bonds) => Some(bonds),
            MaterialModel::StateBased(_) | MaterialModel::Correspondence(_) => None,
        }
    }

    /// The state-based material, if it is one.
    pub fn state_based(&self) -> Option<&StateBased> {
        match &self.model {
            MaterialModel::StateBased(solid) => Some(solid),
            MaterialModel::Bonds(_) | MaterialModel::Correspondence(_) => None,
        }
    }

    /// The correspondence material, if it is one.
    pub fn correspondence(&self) -> Option<&Correspondence> {
        match &self.model {
            MaterialModel::Correspondence(solid) => Some(solid),
            MaterialModel::Bonds(_) | MaterialModel::StateBased(_) => None,
        }
    }

    /// Mass density ρ, kg/m³.
    pub fn density(&self) -> f64 {
        self.model.density()
    }

    /// Horizon δ, m.
    pub fn horizon(&self) -> f64 {
        self.model.horizon()
    }

    /// Partial volumes at the horizon.
    pub fn volume_correction(&self) -> VolumeCorrection {
        self.model.volume_correction()
    }

    /// The word of `material.model`, whatever the treatment of a law.
    pub fn model_name(&self) -> &'static str {
        self.model.name()
    }
}
