//! Parts of messages.

use crate::units::precise;

/// The end of a message: spacings that divide all sides.
pub(super) fn spacings_that_fit(fitting: &[f64]) -> String {
    let spacings: Vec<String> = fitting.iter().map(|dx| precise(*dx, "m")).collect();
    match spacings.is_empty() {
        true => String::new(),
        false => format!(
            "; with these sides spacings of {} fit",
            spacings.join(" and ")
        ),
    }
}

pub(super) fn no_equilibrium(t: f64, iterations: u32, residual: f64, tolerance: f64) -> String {
    if residual.is_finite() {
        format!(
            "at t = {t:.4e} s the forces out of balance are {residual:.3e} of those that act after {iterations} iterations; the tolerance is {tolerance:.1e}"
        )
    } else {
        format!(
            "at t = {t:.4e} s the forces grow without bound after {iterations} iterations, as where a body becomes much stiffer within a load step"
        )
    }
}

/// The message of [`PericlesError::InnerIteration`].
pub(super) fn inner_iteration(
    t: f64,
    iterations: u32,
    change: f64,
    tolerance: f64,
    dt: f64,
    omega: f64,
    safe: Option<f64>,
) -> String {
    let evaluations = match iterations {
        1 => "1 evaluation".to_owned(),
        several => format!("{several} evaluations"),
    };
    let state = if change.is_finite() {
        format!(
            "after {evaluations} the velocity still changes by {change:.3e} m/s (allowed: {tolerance:.3e} m/s)"
        )
    } else {
        format!("the iteration diverged within {evaluations}: velocities are NaN or infinite")
    };
    let step = match safe {
        Some(safe) => format!(
            "dt = {dt:.4e} s with a highest frequency of {omega:.4e} 1/s: give dt ≤ {safe:.4e} s, or "
        ),
        None => String::new(),
    };
    let more = match iterations {
        1 => {
            "give iterations = 2 or more, because one evaluation has nothing to be compared with, "
        }
        _ => "give more iterations, ",
    };
    format!(
        "at t = {t:.6e} s the inner iteration did not converge: {state}. {}or solver = \"newton-krylov\"",
        capital(&format!("{step}{more}"))
    )
}

/// A sentence with a capital letter where it begins with a verb.
fn capital(sentence: &str) -> String {
    match sentence.strip_prefix("give") {
        Some(rest) => format!("Give{rest}"),
        None => sentence.to_owned(),
    }
}
