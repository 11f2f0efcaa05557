//! Materials of bonds.

use pericles::family::VolumeCorrection;
use pericles::kernel::Influence;
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, FractureCalibration, Modulus, PairLaw,
};
use pericles::operator::DamageMeasure;
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
#[serde(remote = "DamageMeasure", deny_unknown_fields)]
struct DamageMeasureForm {
    count: bool,
    count_precut: bool,
}

described!(
    BondMaterial: BondMaterialForm,
    Modulus: ModulusForm,
    ElasticModulus: ElasticModulusForm,
    Fracture: FractureForm,
    DamageMeasure: DamageMeasureForm,
);
