//! Facts of the initial state, the frequencies and the time step.

use pericles::time::DevicePlan;
use pericles_deck::{Model, Scheme};
use serde_json::json;

use super::list::{Facts, Section};
use crate::build::Assembly;
use crate::refinement::RefinementFacts;
use crate::units::{bytes, count, frequency, percent, quantity};

impl Facts {
    pub(super) fn time(&mut self, model: &Model, assembly: &Assembly) {
        let section = Section::Time;
        if let Some((checkpoint, t)) = &assembly.origin {
            let checkpoint = checkpoint.display().to_string();
            let text = format!("state of {checkpoint} at t = {}", quantity(*t, "s"));
            self.line(section, "start", text).fact(
                "start",
                "",
                json!({ "checkpoint": checkpoint, "t": t }),
            );
        }
        self.frequencies(model, assembly);
        let (dt, scheme) = (assembly.dt, assembly.integrator.name());
        let limit = assembly.stable_step();
        let text = match limit {
            Some(limit) => format!("{} ({scheme})", quantity(limit, "s")),
            None => String::new(),
        };
        self.line(section, "stable step", text)
            .fact("stable_step", "s", limit)
            .fact("scheme", "", scheme);
        let ratio = limit.map(|limit| dt / limit);
        let share = ratio.map(step_share).unwrap_or_default();
        let end = assembly.steps as f64 * dt;
        let text = format!(
            "{} of {}{share}; end at {}",
            count(assembly.steps),
            quantity(dt, "s"),
            quantity(end, "s")
        );
        let above = ratio.map(|ratio| (ratio - 1.0).max(0.0));
        self.line(section, "steps", text)
            .fact("dt", "s", dt)
            .fact("steps", "", assembly.steps)
            .checked("end", "s", end)
            .checked("dt_over_stable_step", "", ratio)
            .checked("dt_above_stable_step", "", above);
        if let Scheme::Static(options) = &model.time.scheme
            && let Some(control) = &options.control
        {
            let text = format!(
                "the loads follow {}: {} per step, {} at the end",
                control.quantity,
                quantity(control.rate * dt, "m"),
                quantity(control.rate * end, "m")
            );
            self.line(section, "control", text)
                .fact("control", "", control);
        }
    }

    /// Adds the device that computes the steps, if it is not the processor of the machine.
    pub(super) fn device(&mut self, assembly: &Assembly) {
        let Some(DevicePlan {
            name,
            interface,
            precision,
            reason,
            memory,
        }) = &assembly.device
        else {
            return;
        };
        let text = format!(
            "{name} ({interface}), {precision} precision ({reason}), {} of its memory",
            bytes(*memory)
        );
        let device = json!({
            "name": name,
            "interface": interface,
            "precision": precision,
            "reason": reason,
            "memory": memory,
        });
        self.line(Section::Time, "device", text)
            .fact("device", "", device);
    }

    fn frequencies(&mut self, model: &Model, assembly: &Assembly) {
        let refinement = RefinementFacts::of(model, assembly);
        let body = assembly.body_frequency;
        let estimate = body.map(|body| body.estimate);
        let bound = body.map(|body| body.bound);
        let probability = body.map(|body| body.failure_probability);
        let certainty = match probability {
            Some(probability) if probability > 0.0 => {
                format!(" (bound from random vectors, fails with probability {probability:.0e})")
            }
            _ => String::new(),
        };
        let text = body.map(|body| range(body.estimate, body.bound) + &certainty);
        let line = self.line(Section::Time, "highest frequency", text.unwrap_or_default());
        line.fact("highest_frequency", "rad/s", estimate)
            .fact("highest_frequency_bound", "rad/s", bound)
            .fact("highest_frequency_failure_probability", "", probability)
            .fact("frequency_converged", "", body.map(|body| body.converged));
        if let Some(body) = body {
            line.checked(
                "highest_frequency_margin",
                "",
                body.bound / body.estimate - 1.0,
            );
        }
        let limiting = assembly.frequency;
        let coarse = limiting.filter(|_| refinement.is_some());
        let text = coarse.map(|coarse| range(coarse.estimate, coarse.bound));
        let line = self.line(Section::Time, "coarse frequency", text.unwrap_or_default());
        line.fact(
            "limiting_frequency",
            "rad/s",
            limiting.map(|found| found.estimate),
        )
        .fact(
            "limiting_frequency_bound",
            "rad/s",
            limiting.map(|found| found.bound),
        )
        .fact("refinement", "", refinement);
        if let Some(coarse) = coarse {
            let margin = coarse.bound / coarse.estimate - 1.0;
            line.checked("limiting_frequency_margin", "", margin);
        }
    }
}

/// Formats a frequency with its estimate and upper bound.
fn range(omega: f64, bound: f64) -> String {
    format!(
        "{} 1/s, upper bound {} larger",
        frequency(omega),
        percent((bound / omega - 1.0).max(0.0))
    )
}

/// Formats the ratio of the time step to the stable one. A step above it is never printed as 100 %.
fn step_share(ratio: f64) -> String {
    if ratio > 1.0 {
        format!(", {} above the stable step", percent(ratio - 1.0))
    } else {
        format!(", {} of the stable step", percent(ratio))
    }
}
