//! Parts of messages.

use crate::units::{precise, significant};

/// Ends a message with the spacings that divide all sides.
pub(super) fn spacings_that_fit(fitting: &[f64]) -> String {
    let spacings: Vec<String> = fitting.iter().map(|dx| precise(*dx, "m")).collect();
    match spacings.is_empty() {
        true => String::new(),
        false => format!(
            "; spacings that divide all sides: {}",
            spacings.join(" and ")
        ),
    }
}

/// The message of [`PericlesError::NoEquilibrium`](super::PericlesError::NoEquilibrium).
pub(super) fn no_equilibrium(t: f64, iterations: u32, residual: f64, tolerance: f64) -> String {
    if residual.is_finite() {
        format!(
            "no equilibrium at t = {} s: the relative residual is {residual:.3e} after {iterations} iterations, the tolerance {tolerance:.1e}",
            significant(t, 4)
        )
    } else {
        format!(
            "no equilibrium at t = {} s: the forces grow without bound after {iterations} iterations, as when a body stiffens strongly within a load step",
            significant(t, 4)
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
            "after {evaluations} the velocity still changes by {change:.3e} m/s (tolerance: {tolerance:.3e} m/s)"
        )
    } else {
        format!("the iteration diverged within {evaluations}: velocities are NaN or infinite")
    };
    let step = match safe {
        Some(safe) => format!(
            "The step is {} s and the highest frequency {} 1/s: give dt ≤ {} s, or ",
            significant(dt, 4),
            significant(omega, 4),
            significant(safe, 5)
        ),
        None => String::new(),
    };
    let more = match iterations {
        1 => "give iterations = 2 or more (one evaluation has no predecessor to compare with), ",
        _ => "give more iterations, ",
    };
    format!(
        "at t = {} s the inner iteration did not converge: {state}. {}or use solver = \"newton-krylov\"",
        significant(t, 6),
        capital(&format!("{step}{more}"))
    )
}

/// Capitalises a sentence that begins with "give".
fn capital(sentence: &str) -> String {
    match sentence.strip_prefix("give") {
        Some(rest) => format!("Give{rest}"),
        None => sentence.to_owned(),
    }
}
