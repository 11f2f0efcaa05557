//! Models whose coefficients are tuned.

use pericles::family::VolumeCorrection;
use pericles::material::StressState;
use pericles_dispersion::tuning::{Method, ScalingModel, TunedTable, Tuning, continuum_speeds};
use pericles_run::RunError;

use crate::common::largest;
use crate::data::Case;

/// Coefficients with their names.
pub(super) type NamedTables = Vec<(String, Vec<f64>)>;

pub(super) fn model(state: StressState, n: f64) -> Result<ScalingModel, RunError> {
    Ok(ScalingModel::new(state, n, VolumeCorrection::None)?)
}

/// Model of the arguments `state` and `n`.
pub(super) fn model_of(case: &Case<'_>) -> Result<ScalingModel, RunError> {
    let states = [
        ("bar", StressState::Uniaxial),
        ("plane strain", StressState::PlaneStrain),
        ("3D", StressState::Spatial),
    ];
    model(case.one_of("state", &states)?, case.number("n")?)
}

pub(super) fn tuned(
    model: &ScalingModel,
    method: Method,
    lower_bound: Option<f64>,
) -> Result<TunedTable, RunError> {
    Ok(model.tune(Tuning {
        method,
        lower_bound,
        ..Default::default()
    })?)
}

/// Method of the argument `method`.
pub(super) fn method_of(case: &Case<'_>) -> Result<Method, RunError> {
    case.one_of("method", &Method::ALL.map(|method| (method.name(), method)))
}

/// Continuum speed for each branch.
pub(super) fn targets(state: StressState) -> Vec<Option<f64>> {
    let speeds = continuum_speeds(state);
    let mut targets = vec![Some(speeds.shear); state.dimension()];
    targets[0] = Some(speeds.pressure);
    targets
}

/// Stability of a table, for a note.
pub(super) fn verdict(table: &TunedTable) -> &'static str {
    match table.assessment.stability.is_stable() {
        true => "stable",
        false => "UNSTABLE: some waves grow",
    }
}

/// Largest constraint residual, zero up to round-off.
pub(super) fn constraint_residual(table: &TunedTable) -> f64 {
    largest(&table.assessment.constraints)
}
