//! Table 5: bar with the bond-stretch law.

use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::kernel::Influence;
use pericles::material::BondMaterial;
use pericles::time::State;
use pericles_run::RunError;
use pericles_waves::exact::{BarMode, ExactSolution, StretchedBar};

use super::line::{Method, UNIT, cells_of, integrator, march, system};
use crate::common::difference;
use crate::data::{Case, Found};

const BAR: StretchedBar = StretchedBar {
    length: 1.0,
    strain: 1.0,
    speed: 1.0,
};
const MODE: BarMode = BarMode {
    length: 1.0,
    amplitude: 1.0,
    speed: 1.0,
};

/// Largest error over all nodes and steps, from a uniform strain or, with `smooth`, from the first mode of the bar;
/// the wall is the middle of a bar whose motion is odd about it.
pub(super) fn error(case: &Case<'_>) -> Result<Found, RunError> {
    let (method, h, ratio) = (Method::of(case)?, case.number("h")?, case.number("ratio")?);
    let smooth = case.flag("smooth");
    let exact: &dyn ExactSolution = if smooth { &MODE } else { &BAR };
    let material = BondMaterial {
        horizon: ratio * h,
        influence: Influence::default(),
        // Half a cell at the horizon.
        volume_correction: VolumeCorrection::Linear,
        ..UNIT.material()
    };
    let cloud = Arc::new(cells_of(-1.0, 2.0, h)?);
    let mut system = system(&cloud, &material)?;
    let mut scheme = integrator(method, h, &system)?;
    let x = cloud.axis(0);
    let mut state = State::at_rest(cloud.len());
    for (u, x) in state.u.iter_mut().zip(x) {
        *u = if smooth { (FRAC_PI_2 * x).sin() } else { *x };
    }
    let dt = 0.1 * h;
    let steps = (case.number("end")? / dt).round() as usize;
    let free = cloud.len() / 2..cloud.len();
    let mut expected = vec![0.0; free.len()];
    let mut worst = 0.0;
    let visit = |_: &_, state: &State| {
        exact.displacement_into(state.t, &x[free.clone()], &mut expected);
        worst = difference(&state.u[free.clone()], &expected).max(worst);
    };
    march(&mut system, &mut *scheme, &mut state, dt, steps, visit)?;
    Ok(worst.into())
}
