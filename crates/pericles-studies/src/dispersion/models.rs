//! Models whose coefficients are tuned.

use pericles::family::VolumeCorrection;
use pericles::material::StressState;
use pericles_dispersion::tuning::{Method, ScalingModel, TunedTable, Tuning, continuum_speeds};
use pericles_run::RunError;

use crate::row::Row;

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

/// By how much the largest of the constraints is missed, 0 but for rounding; `what` names the row after the table.
pub(super) fn constraint_residual(what: &dyn Fn(String) -> String, table: &TunedTable) -> Row {
    let constraints = table.assessment.constraints.iter();
    let residual = constraints.map(|c| c.abs()).fold(0.0, f64::max);
    Row::new(what("constraint residual".into()), "", Some(residual)).within(0.0, 1e-12)
}

/// By how much the optimality conditions are missed, 0 but for rounding.
pub(super) fn optimality_residual(what: &dyn Fn(String) -> String, table: &TunedTable) -> Row {
    Row::new(what("optimality residual".into()), "", Some(table.kkt)).within(0.0, 1e-9)
}
