//! Pictures of the bars, and what they show.

use pericles_io::{Axis, Curve, LineChart};
use pericles_run::RunError;

use super::bar::{Bar, HALF, Kind, SEISMIC_BAR, SPACING, kernels};
use crate::row::Row;
use crate::study::Context;

const DT: f64 = 0.005;

/// Displacement of a node over time.
struct History {
    t: Vec<f64>,
    u: Vec<f64>,
}

impl History {
    fn largest(&self) -> f64 {
        self.u.iter().fold(0.0, |a: f64, u| a.max(u.abs()))
    }
}

/// The histories of nodes up to a time, with exact ends.
fn histories<const N: usize>(
    bar: &Bar,
    nodes: [usize; N],
    end: f64,
) -> Result<[History; N], RunError> {
    let steps = (end / DT).round() as u64;
    let kernels = kernels(Kind::Discrete, DT, steps as usize)?;
    let mut histories = nodes.map(|_| History {
        t: Vec::new(),
        u: Vec::new(),
    });
    bar.follow(&kernels, DT, steps, |state| {
        for (history, &node) in histories.iter_mut().zip(&nodes) {
            history.t.push(state.t);
            history.u.push(state.u[node]);
        }
    })?;
    Ok(histories)
}

/// Two humps that leave.
pub(super) fn homogeneous(context: &Context<'_>) -> Result<(), RunError> {
    let Some(path) = context.figure("fields.png") else {
        return Ok(());
    };
    let times = [2.0, 5.0, 8.0, 10.0, 15.0];
    let states = Bar::infinite(1.0).states(Kind::Discrete, DT, &times)?;
    let x: Vec<f64> = (0..=2 * HALF)
        .map(|i| (i as f64 - HALF as f64) * SPACING)
        .collect();
    let mut chart = LineChart::new(Axis::new("x", ""), Axis::new("u", ""))
        .title("a bell in a bar with absorbing ends")
        .key_beside();
    for (t, state) in times.iter().zip(&states) {
        chart = chart.curve(Curve::line(format!("t = {t}"), &x, &state.u));
    }
    Ok(chart.write(path)?)
}

/// Waves between interfaces leave the slower, the softer the middle is.
pub(super) fn interfaces(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let betas = [1.0, 0.5, 0.1];
    let mut chart = LineChart::new(Axis::new("t", ""), Axis::new("u", ""))
        .title("displacement at x = 0 between interfaces of stiffness β")
        .key_beside();
    let mut left = Vec::new();
    for beta in betas {
        let [middle] = histories(&Bar::infinite(beta), [HALF], 60.0)?;
        let late = middle.t.iter().zip(&middle.u).filter(|(t, _)| **t > 40.0);
        left.push(late.fold(0.0, |a: f64, (_, u)| a.max(u.abs())));
        chart = chart.curve(Curve::line(format!("β = {beta}"), &middle.t, &middle.u));
    }
    if let Some(path) = context.figure("interfaces.png") {
        chart.write(path)?;
    }
    let ordered = left[0] < left[1] && left[1] < left[2];
    Ok(vec![
        Row::new(
            "β = 1, 0.5, 0.1: what is left after t = 40 grows",
            "",
            Some(f64::from(u8::from(ordered))),
        )
        .within(1.0, 0.0)
        .note(format!("{:.1e}, {:.1e}, {:.1e}", left[0], left[1], left[2])),
        Row::new(
            "β = 1: largest displacement after t = 40",
            "",
            Some(left[0]),
        )
        .within(0.0, 1e-9),
    ])
}

/// The free end moves twice as far as the wavelet.
pub(super) fn seismic(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let [left, right] = histories(&SEISMIC_BAR, [0, 2 * HALF], 40.0)?;
    if let Some(path) = context.figure("seismic.png") {
        LineChart::new(Axis::new("t", ""), Axis::new("u", ""))
            .title("a wavelet from x = 0")
            .key_beside()
            .curve(Curve::line("absorbing end", &left.t, &left.u))
            .curve(Curve::line("free end", &right.t, &right.u))
            .write(path)?;
    }
    Ok(vec![
        Row::new("peak at the absorbing end", "", Some(left.largest())).within_share(0.943, 0.002),
        Row::new("peak at the free end", "", Some(right.largest())).within_share(1.936, 0.002),
    ])
}
