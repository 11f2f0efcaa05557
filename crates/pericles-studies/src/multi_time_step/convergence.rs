//! Errors and orders of the schemes on bodies without failure.

use std::rc::Rc;

use pericles_run::RunError;

use super::problem::{End, Method, Problem, relative};
use crate::common::{difference, largest};
use crate::data::{Case, Found};

/// Largest displacement along x of the reference.
pub(super) fn largest_displacement(case: &Case<'_>) -> Result<Found, RunError> {
    Ok(largest(reference(case)?.x()).into())
}

/// Reference: RK4 with `reference` steps.
fn reference(case: &Case<'_>) -> Result<Rc<End>, RunError> {
    Problem::of(case)?.end(Method::Uniform(4), case.count("reference")? as u64, &[])
}

/// Error of the scheme `name` at the end with a number of steps and the overrides `choice`: the largest |u_x −
/// reference| over the points, or with `relative` the relative error of all displacements.
fn error_in(case: &Case<'_>, name: &'static str, steps: u64) -> Result<f64, RunError> {
    let choice = case.texts("choice")?;
    let end = Problem::of(case)?.end(Method::of(case, name)?, steps, &choice)?;
    let exact = reference(case)?;
    Ok(match case.flag("relative") {
        true => relative(&end.u, &exact.u),
        false => difference(end.x(), exact.x()),
    })
}

/// Error of a method, and its ratio to the error of the method `beside` with the same number of steps; with `ratio` also
/// to that with the fine step everywhere.
pub(super) fn error(case: &Case<'_>) -> Result<Found, RunError> {
    let steps = case.count("steps")? as u64;
    let error = error_in(case, "method", steps)?;
    let mut found = Found::from(error);
    if case.has("beside") {
        found = found.value("over", error / error_in(case, "beside", steps)?);
        if let Some(ratio) = case.optional("ratio") {
            let fine = error_in(case, "beside", steps * ratio as u64)?;
            found = found.value("over fine", error / fine);
        }
    }
    Ok(found)
}

/// Order of a method from half of the `steps` to all of them.
pub(super) fn order(case: &Case<'_>) -> Result<Found, RunError> {
    let steps = case.count("steps")? as u64;
    let [coarse, fine] = [steps / 2, steps].map(|steps| error_in(case, "method", steps));
    Ok([
        ("value", (coarse? / fine?).log2()),
        ("half", (steps / 2) as f64),
    ]
    .into())
}

/// Order in which the multirate scheme with M = 1 converges to the single-rate one of the same order.
pub(super) fn equal_steps(case: &Case<'_>) -> Result<Found, RunError> {
    let problem = Problem::of(case)?;
    let order = case.count("order")? as u32;
    let difference = |steps| -> Result<f64, RunError> {
        let plain = problem.end(Method::Uniform(order), steps, &[])?;
        let zoned = problem.end(Method::Two(order, 1), steps, &[])?;
        Ok(difference(zoned.x(), plain.x()))
    };
    Ok((difference(128)? / difference(256)?).log2().into())
}

/// Relative errors of a set's displacements with velocity Verlet at a quarter of the fine step as reference: of
/// r-RESPA, multirate RK4, and velocity Verlet with the fine step.
pub(super) fn errors_of_set(case: &Case<'_>) -> Result<Found, RunError> {
    let problem = Problem::of(case)?;
    let ratio = case.count("ratio")? as u32;
    let steps = case.count("steps")? as u64;
    let assembly = problem.assembly(Method::Verlet, &[])?;
    let n = assembly.cloud.len();
    let set = case.text("points")?;
    let found = assembly.sets.iter().find(|(name, _)| *name == set);
    let points = found.map_or(&[][..], |(_, points)| points);
    let part = |u: &[f64]| -> Vec<f64> {
        let of = |c: usize| points.iter().map(move |&i| c * n + i as usize);
        of(0).chain(of(1)).map(|entry| u[entry]).collect()
    };
    let fine = steps * u64::from(ratio);
    let exact = problem.run(Method::Verlet, 4 * fine, &[])?;
    let error = |method, steps| -> Result<f64, RunError> {
        let run = problem.run(method, steps, &[])?;
        Ok(relative(&part(&run.state().u), &part(&exact.state().u)))
    };
    let respa = error(Method::Respa(ratio), steps)?;
    let verlet = error(Method::Verlet, fine)?;
    let two = error(Method::Two(4, ratio), steps)?;
    Ok([
        ("r-RESPA", respa),
        ("RK4", two),
        ("RK4 over r-RESPA", two / respa),
        ("Verlet", verlet),
        ("r-RESPA over Verlet", respa / verlet),
    ]
    .into())
}
