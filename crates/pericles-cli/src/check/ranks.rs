//! Prediction of runs on several processes.

use pericles_run::units::{bytes, count, percent, quantity, significant};
use pericles_run::{Assembly, BANDWIDTH, Facts, Forecast, LATENCY, Section, Source};
use serde_json::{Value, json};

use super::StepCost;
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

/// Adds the lines about all numbers of processes; without the cost of a step, times are not predicted.
pub(super) fn add_lines(facts: &mut Facts, forecasts: &[Forecast], cost: Option<StepCost>) {
    let entries = forecasts.iter().map(|one| entry(one, cost));
    facts.list(Section::Cost, "processes", false, entries);
    if let (Some(_), Some(cost)) = (forecasts.first(), cost) {
        let text = format!(
            "model, not measured: this machine per process ({} per step of the whole body), {} per message, {} per second; no \
             overlap, no output",
            quantity(cost.seconds, "s"),
            quantity(LATENCY, "s"),
            quantity(BANDWIDTH, "B"),
        );
        facts
            .line(Section::Cost, "time on processes", text)
            .checked("step_seconds", "s", cost.seconds)
            .checked("message_latency", "s", LATENCY)
            .checked("message_bandwidth", "B/s", BANDWIDTH);
    }
}

fn entry(forecast: &Forecast, cost: Option<StepCost>) -> (&'static str, String, Value) {
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
    ("processes", text, value)
}
