//! Serialised form of scheme options.

use pericles::time::Follow;
use pericles_waves::{FunctionMethod, LoadRule, TrigonometricOptions};
use serde::{Deserialize, Serialize};

use super::described;

#[derive(Serialize, Deserialize)]
#[serde(remote = "Follow", deny_unknown_fields)]
struct FollowForm {
    every: u32,
    threshold: f64,
    layers: u32,
    keep_checks: u32,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "TrigonometricOptions", deny_unknown_fields)]
struct TrigonometricOptionsForm {
    #[serde(with = "crate::form")]
    functions: FunctionMethod,
    #[serde(rename = "loads", with = "crate::form")]
    load_rule: LoadRule,
    regularisation: f64,
}

described!(
    Follow: FollowForm,
    TrigonometricOptions: TrigonometricOptionsForm,
);
