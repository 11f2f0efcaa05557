//! Prediction of runs on several processes.

use pericles_run::units::{bytes, count, percent, quantity, significant};
use pericles_run::{Assembly, BANDWIDTH, Forecast, LATENCY, Source};
use serde_json::json;

use super::StepCost;
use super::line::Line;
use crate::error::CliError;

/// Divides the body among each of the numbers of processes.
///
/// # Errors
/// A model that cannot be divided, or not into so many parts.
pub(super) fn forecasts(
    source: &Source,
    assembly: &Assembly,
    counts: &[u32],
) -> Result<Vec<Forecast>, CliError> {
    let forecast = |&processes: &u32| {
        let found = assembly.forecast(source.model(), processes as usize);
        found.map_err(|error| source.rejection(error).into())
    };
    counts.iter().map(forecast).collect()
}

/// Returns the lines about all numbers of processes; without the cost of a step, times are not predicted.
pub(super) fn lines(forecasts: &[Forecast], cost: Option<StepCost>) -> Vec<Line> {
    let mut lines: Vec<Line> = forecasts.iter().map(|one| line(one, cost)).collect();
    if let (Some(_), Some(cost)) = (forecasts.first(), cost) {
        let text = format!(
            "model, not measured: this machine per process ({} per step of the whole body), {} per message, {} per second; no \
             overlap, no output",
            quantity(cost.seconds, "s"),
            quantity(LATENCY, "s"),
            quantity(BANDWIDTH, "B"),
        );
        let model = Line::new("time on processes", text)
            .with("step_seconds", cost.seconds)
            .with("message_latency", LATENCY)
            .with("message_bandwidth", BANDWIDTH);
        lines.push(model);
    }
    lines
}

fn line(forecast: &Forecast, cost: Option<StepCost>) -> Line {
    let Forecast {
        processes,
        points,
        halo,
        boundary,
        messages,
        memory,
        ..
    } = forecast;
    let step = cost.map(|cost| forecast.step(cost.seconds, cost.evaluations));
    let time = step.map_or_else(String::new, |step| {
        format!(", {} per step", quantity(step, "s"))
    });
    let text = format!(
        "{}: {} points each (largest {}), ghosts {} of own points (largest {}), {} of points with ghosts, {} messages (largest {}), \
         about {} of memory (largest {}){time}",
        count(*processes as u64),
        count(points.mean.round() as u64),
        count(points.largest as u64),
        percent(halo.mean),
        percent(halo.largest),
        percent(boundary.mean),
        significant(messages.mean, 3),
        count(messages.largest as u64),
        bytes(memory.mean as u64),
        bytes(memory.largest as u64),
    );
    let mut value = json!(forecast);
    value["step_seconds"] = json!(step);
    Line::new("processes", text).with_entry("processes", value)
}
