//! Models whose coefficients are tuned.

use pericles::family::VolumeCorrection;
use pericles::material::StressState;
use pericles_dispersion::tuning::{Method, ScalingModel, TunedTable, Tuning, continuum_speeds};
use pericles_run::RunError;

/// Coefficients with their names.
pub(super) type NamedTables = Vec<(String, Vec<f64>)>;

pub(super) fn model(state: StressState, n: f64) -> Result<ScalingModel, RunError> {
    Ok(ScalingModel::new(state, n, VolumeCorrection::None)?)
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

/// Speed of the continuum for each branch.
pub(super) fn targets(state: StressState) -> Vec<Option<f64>> {
    let speeds = continuum_speeds(state);
    let mut targets = vec![Some(speeds.shear); state.dimension()];
    targets[0] = Some(speeds.pressure);
    targets
}
