//! Serialised form of absorbing boundaries.

use pericles_waves::absorbing::history::HistoryForm;
use pericles_waves::absorbing::{AbsorbingBoundaryPlan, KernelMethod};
use serde::{Deserialize, Serialize};

use super::described;

#[derive(Serialize, Deserialize)]
#[serde(remote = "AbsorbingBoundaryPlan", deny_unknown_fields)]
struct EndPlanForm {
    #[serde(with = "crate::form")]
    method: KernelMethod,
    #[serde(default, rename = "history", with = "crate::form")]
    form: Option<HistoryForm>,
    #[serde(default)]
    tolerance: Option<f64>,
    verify: bool,
}

described!(AbsorbingBoundaryPlan: EndPlanForm);
