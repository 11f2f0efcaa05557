//! Serialised form of scheme options.

use pericles::time::{
    Damping, Follow, InnerSolver, NewmarkOptions, RelaxationOptions, VelocityNorm,
};
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
#[serde(remote = "NewmarkOptions", deny_unknown_fields)]
struct NewmarkOptionsForm {
    beta: f64,
    gamma: f64,
    tolerance: f64,
    #[serde(with = "crate::form")]
    norm: VelocityNorm,
    iterations: u32,
    #[serde(with = "crate::form")]
    solver: InnerSolver,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "InnerSolver", rename_all = "kebab-case", deny_unknown_fields)]
enum InnerSolverForm {
    FixedPoint,
    Anderson { depth: u32 },
    NewtonKrylov,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "RelaxationOptions", deny_unknown_fields)]
struct RelaxationOptionsForm {
    #[serde(with = "crate::form")]
    damping: Damping,
    tolerance: f64,
    iterations: u32,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Damping", rename_all = "snake_case")]
enum DampingForm {
    Adaptive,
    Viscous(f64),
    Fire,
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
    NewmarkOptions: NewmarkOptionsForm,
    InnerSolver: InnerSolverForm,
    RelaxationOptions: RelaxationOptionsForm,
    Damping: DampingForm,
    TrigonometricOptions: TrigonometricOptionsForm,
);
