//! Serialised form of tuned influence functions: method, coefficients and dispersion errors.

use pericles::kernel::ClassOffset;
use pericles_dispersion::Stability;
use pericles_dispersion::tuning::{Assessment, BondClass, DispersionError, TunedTable, Tuning};
use serde::{Deserialize, Serialize};

use super::described;

#[derive(Serialize, Deserialize)]
#[serde(remote = "TunedTable", deny_unknown_fields)]
struct TunedTableForm {
    #[serde(with = "crate::form")]
    tuning: Tuning,
    #[serde(with = "crate::form")]
    classes: Vec<BondClass>,
    alpha: Vec<f64>,
    active: Vec<usize>,
    #[serde(with = "crate::form")]
    condition: f64,
    #[serde(with = "crate::form")]
    kkt: f64,
    #[serde(with = "crate::form")]
    functionals: Vec<Vec<f64>>,
    #[serde(with = "crate::form")]
    assessment: Assessment,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "BondClass", deny_unknown_fields)]
struct BondClassForm {
    offset: ClassOffset,
    length: f64,
    multiplicity: usize,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Assessment", deny_unknown_fields)]
struct AssessmentForm {
    #[serde(with = "crate::form")]
    error: DispersionError,
    #[serde(with = "crate::form")]
    constraints: Vec<f64>,
    #[serde(with = "crate::form")]
    stability: Stability,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "DispersionError", deny_unknown_fields)]
struct DispersionErrorForm {
    #[serde(with = "crate::form")]
    absolute: f64,
    #[serde(with = "crate::form")]
    ratio: f64,
    #[serde(with = "crate::form")]
    square: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Stability", deny_unknown_fields)]
struct StabilityForm {
    #[serde(with = "crate::form")]
    smallest: f64,
    #[serde(with = "crate::form")]
    smallest_at: [f64; 3],
    #[serde(with = "crate::form")]
    omega_max: f64,
    #[serde(with = "crate::form")]
    omega_max_at: [f64; 3],
}

described!(
    TunedTable: TunedTableForm,
    BondClass: BondClassForm,
    Assessment: AssessmentForm,
    DispersionError: DispersionErrorForm,
    Stability: StabilityForm,
);
