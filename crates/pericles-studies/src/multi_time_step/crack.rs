//! Propagating crack: multirate schemes compared with the fine step everywhere.
//!
//! Before bonds break the orders are those of the method. Afterwards the same bonds cannot be expected: breaking is
//! detected to first order in the step, and halving the step of one scheme changes as much as the second step does.
//! The crack length and the number of broken bonds must agree.

use std::rc::Rc;

use pericles::Simulation;
use pericles_run::RunError;

use super::problem::{Method, Problem, relative};
use crate::data::{Case, Found};

/// Number of coarse steps to the end of the deck.
const STEPS: f64 = 128.0;
const END: f64 = 15e-6;

/// State of the plate at a time, with the deck's time step divided by `ratio`.
fn at(
    case: &Case<'_>,
    method: Method,
    end: f64,
    ratio: u32,
    choice: &[String],
) -> Result<Rc<Simulation>, RunError> {
    let mut changes = vec![format!("time.end={end:?}")];
    changes.extend_from_slice(choice);
    let steps = (STEPS * end / END).round() as u64 * u64::from(ratio);
    let problem = Problem::of(case)?;
    let key = problem.key(method, steps, &changes)?;
    case.once(key, || problem.run(method, steps, &changes))
}

/// Until the first bonds break the runs agree: the difference of broken bonds, and the relative error of
/// displacements.
pub(super) fn before_failure(case: &Case<'_>) -> Result<Found, RunError> {
    let (end, ratio) = (case.number("end")?, case.count("ratio")? as u32);
    let fine = at(case, Method::Uniform(4), end, ratio, &[])?;
    let two = at(case, Method::Two(4, ratio), end, 1, &[])?;
    Ok([
        ("bonds", broken(&two).abs_diff(broken(&fine)) as f64),
        ("distance", relative(&two.state().u, &fine.state().u)),
    ]
    .into())
}

fn broken(run: &Simulation) -> u64 {
    run.system().operator().broken_bonds()
}

/// Largest x of points with damage above 0.3, m.
fn tip(run: &Simulation) -> f64 {
    let cloud = run.system().cloud();
    let mut damage = vec![0.0; cloud.len()];
    run.system().operator().damage_into(&mut damage);
    (0..cloud.len())
        .filter(|&i| damage[i] > 0.3)
        .map(|i| cloud.point(i)[0])
        .fold(0.0, f64::max)
}

/// Single-rate method at the end, after several hundred bonds have broken.
pub(super) fn fine_step(case: &Case<'_>) -> Result<Found, RunError> {
    let ratio = case.count("ratio")? as u32;
    let run = at(case, Method::of(case, "method")?, END, ratio, &[])?;
    Ok([("bonds", broken(&run) as f64), ("tip", tip(&run))].into())
}

/// Multirate method at the end, compared with the single-rate method `beside` with the fine step everywhere; and its
/// evaluations per point and step, counted and by the model of its cost, with the initial steps that are fine everywhere.
pub(super) fn failure(case: &Case<'_>) -> Result<Found, RunError> {
    let ratio = case.count("ratio")? as u32;
    let fine = at(case, Method::of(case, "beside")?, END, ratio, &[])?;
    let two = at(
        case,
        Method::of(case, "method")?,
        END,
        1,
        &case.texts("choice")?,
    )?;
    let found = Found::from([
        ("bonds", broken(&two) as f64 / broken(&fine) as f64),
        ("tip", tip(&two) - tip(&fine)),
    ]);
    let Some(report) = two.integrator().refinement() else {
        return Ok(found);
    };
    let points = (report.points * two.steps()) as f64;
    let evaluations = two.system().evaluated_points() as f64 / points;
    let starting = f64::from(report.stages * report.ratio) * report.starting_steps as f64;
    let model = report.evaluations() * report.steps as f64 + starting;
    Ok(found
        .value("fraction", report.mean_fraction)
        .value("evaluations", evaluations)
        .value("model", model / two.steps() as f64))
}
