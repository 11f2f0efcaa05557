//! Figures 1, 3 and 4: waves on the line and on a period, and where the error of a period lies.

use std::f64::consts::PI;

use pericles_io::{Axis, Curve, LineChart};
use pericles_run::RunError;
use pericles_waves::exact::ExactSolution;

use super::convergence::LINE;
use super::line::{Method, UNIT, integrator, march, nodes, pulse, system};
use super::paper::PAPER;
use super::spectral::{displacement, errors, ring};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "nonlocal-wave/figures",
    paper: PAPER,
    title: "The waves of figures 1 and 3, the errors of figure 4",
    run,
};

fn run(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = vec![line(context)?];
    rows.push(period(context)?);
    rows.push(error_over_place(context)?);
    Ok(rows)
}

fn chart(title: &str, y: Axis) -> LineChart {
    LineChart::new(Axis::new("x", ""), y).title(title)
}

/// Figure 1: MSV on the piece of line, until waves have met its ends.
fn line(context: &Context<'_>) -> Result<Row, RunError> {
    const H: f64 = 0.1;
    let cloud = nodes(Method::Msv, H)?;
    let mut system = system(&cloud, &UNIT.material())?;
    let mut scheme = integrator(Method::Msv, H, &system)?;
    let mut state = pulse(&cloud, 1.0);
    let x = cloud.axis(0).to_vec();
    let mut figure = chart("MSV on [−10, 10], h = τ = 0.1", Axis::new("u", ""))
        .curve(Curve::line("t = 0", &x, &state.u));
    let mut shown = Some(figure);
    let mut symmetry = 0.0f64;
    march(&mut system, &mut *scheme, &mut state, H, 300, |_, state| {
        if state.step.is_multiple_of(60) {
            let name = format!("t = {}", state.step / 10);
            shown = shown
                .take()
                .map(|chart| chart.curve(Curve::line(name, &x, &state.u)));
        }
        let pairs = state.u.iter().zip(state.u.iter().rev());
        symmetry = pairs.fold(symmetry, |m, (a, b)| m.max((a - b).abs()));
    })?;
    if let (Some(path), Some(chart)) = (context.figure("line.png"), shown) {
        figure = chart;
        figure.write(path)?;
    }
    let row = Row::new("figure 1: largest asymmetry to t = 30", "", Some(symmetry));
    Ok(row.within(0.0, 1e-12))
}

/// Figure 3: the spectral method at six times.
fn period(context: &Context<'_>) -> Result<Row, RunError> {
    let cloud = ring(2.5, 320)?;
    let x = cloud.axis(0).to_vec();
    let mut figure = chart("Spectral method, period 5π", Axis::new("u", ""));
    let mut worst = 0.0f64;
    for t in [0.5, 1.0, 1.5, 2.0, 2.5, 3.0] {
        let state = displacement(&cloud, t)?;
        figure = figure.curve(Curve::line(format!("t = {t}"), &x, &state.u));
        let mut exact = vec![0.0; x.len()];
        LINE.displacement_into(t, &x, &mut exact);
        let inside = (0..x.len()).filter(|&i| x[i].abs() <= PI);
        worst = inside.fold(worst, |m, i| m.max((state.u[i] - exact[i]).abs()));
    }
    if let Some(path) = context.figure("spectral.png") {
        figure.write(path)?;
    }
    let row = Row::new(
        "figure 3: largest error on [−π, π] to t = 3",
        "",
        Some(worst),
    );
    Ok(row
        .within(0.0, 2.15e-8)
        .note("allowed: the error at t = 3.5, when more of the neighbouring wave has arrived"))
}

/// Figure 4: the error grows towards the ends of the period.
fn error_over_place(context: &Context<'_>) -> Result<Row, RunError> {
    let found = errors(2.5, 320, f64::INFINITY)?;
    if let Some(path) = context.figure("spectral-error.png") {
        let (x, e): (Vec<f64>, Vec<f64>) = found
            .at
            .iter()
            .map(|(x, e)| (*x, e.abs().max(1e-17)))
            .unzip();
        chart(
            "Error of the spectral method, period 5π, t = 3.5",
            Axis::new("error", "").logarithmic(),
        )
        .curve(Curve::line("", &x, &e))
        .write(path)?;
    }
    let row = Row::new(
        "figure 4: largest error on the period, t = 3.5",
        "",
        Some(found.largest),
    );
    Ok(row.within_share(1.38e-3, 0.01))
}
