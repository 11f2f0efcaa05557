//! Serialised form of materials.

use pericles::family::VolumeCorrection;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{
    BondFailure, BondMaterial, Calibration, ElasticModulus, Fracture, FractureCalibration,
    GivenConstants, InterfaceRule, InterfaceStiffness, LinearSolid, Modulus, PairLaw,
    StateInfluence, StretchDefinition, TensileStrength,
};
use pericles_solids::correspondence::Plasticity;
use pericles_solids::inelastic::{Inelasticity, ViscousTerm, Yield};
use serde::{Deserialize, Serialize};

use super::described;

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

#[derive(Serialize, Deserialize)]
#[serde(remote = "Modulus", deny_unknown_fields)]
struct ModulusForm {
    #[serde(with = "crate::form")]
    value: ElasticModulus,
    #[serde(with = "crate::form")]
    calibration: Calibration,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "ElasticModulus", deny_unknown_fields)]
enum ElasticModulusForm {
    #[serde(rename = "youngs_modulus")]
    Young(f64),
    #[serde(rename = "bulk_modulus")]
    Bulk(f64),
    #[serde(rename = "shear_modulus")]
    Shear(f64),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Fracture", rename_all = "snake_case", deny_unknown_fields)]
enum FractureForm {
    Unbreakable,
    CriticalStretch(f64),
    Energy {
        energy: f64,
        #[serde(with = "crate::form")]
        calibration: FractureCalibration,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "TensileStrength", deny_unknown_fields)]
struct TensileStrengthForm {
    strength: f64,
    #[serde(with = "crate::form")]
    calibration: FractureCalibration,
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
#[serde(remote = "GivenConstants", deny_unknown_fields)]
struct GivenConstantsForm {
    #[serde(default, rename = "youngs_modulus")]
    young: Option<f64>,
    #[serde(default)]
    poisson_ratio: Option<f64>,
    #[serde(default, rename = "bulk_modulus")]
    bulk: Option<f64>,
    #[serde(default, rename = "shear_modulus")]
    shear: Option<f64>,
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

#[derive(Serialize, Deserialize)]
#[serde(
    remote = "Inelasticity",
    rename_all = "snake_case",
    deny_unknown_fields
)]
enum InelasticityForm {
    Elastic,
    Viscous(#[serde(with = "crate::form")] Vec<ViscousTerm>),
    Plastic(#[serde(with = "crate::form")] Yield),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Yield", deny_unknown_fields)]
struct YieldForm {
    stress: f64,
    hardening: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(
    remote = "InterfaceStiffness",
    rename_all = "snake_case",
    deny_unknown_fields
)]
enum InterfaceStiffnessForm {
    Rule(#[serde(with = "crate::form")] InterfaceRule),
    Modulus(#[serde(with = "crate::form")] Modulus),
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Plasticity", deny_unknown_fields)]
struct PlasticityForm {
    yield_stress: f64,
    #[serde(default)]
    hardening: f64,
}

described!(
    BondMaterial: BondMaterialForm,
    Modulus: ModulusForm,
    ElasticModulus: ElasticModulusForm,
    Fracture: FractureForm,
    TensileStrength: TensileStrengthForm,
    LinearSolid: LinearSolidForm,
    GivenConstants: GivenConstantsForm,
    StateInfluence: StateInfluenceForm,
    BondFailure: BondFailureForm,
    Inelasticity: InelasticityForm,
    Yield: YieldForm,
    InterfaceStiffness: InterfaceStiffnessForm,
    Plasticity: PlasticityForm,
);
