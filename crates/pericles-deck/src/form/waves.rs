//! Absorbing ends.

use pericles_waves::absorbing::history::HistoryForm;
use pericles_waves::absorbing::{EndPlan, KernelMethod};
use serde::{Deserialize, Serialize};

use super::described;

#[derive(Serialize, Deserialize)]
#[serde(remote = "EndPlan", deny_unknown_fields)]
struct EndPlanForm {
    #[serde(with = "crate::form")]
    method: KernelMethod,
    #[serde(default, rename = "history", with = "crate::form")]
    form: Option<HistoryForm>,
    #[serde(default)]
    tolerance: Option<f64>,
    verify: bool,
}

described!(EndPlan: EndPlanForm);
