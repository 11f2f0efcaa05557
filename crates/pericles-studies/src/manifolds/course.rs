//! Runs of the presets, and what is seen of them.

use pericles::{Control, Simulation};
use pericles_io::{Axis, Curve, LineChart};
use pericles_manifold::SurfaceMeasure;
use pericles_run::{Resources, RunError, build};

use super::presets::Preset;
use crate::study::Context;

/// What is seen of a run at every step.
#[derive(Debug, Default)]
pub(super) struct Course {
    pub(super) t: Vec<f64>,
    /// S/S₀ − 1.
    pub(super) stretch: Vec<f64>,
    pub(super) kinetic: Vec<f64>,
    pub(super) elastic: Vec<f64>,
    /// Inner iterations of the step, none before the first.
    pub(super) iterations: Vec<f64>,
}

impl Course {
    /// The surface stretch at the step nearest to a time.
    pub(super) fn stretch_at(&self, t: f64) -> f64 {
        self.at(t, &self.stretch)
    }

    pub(super) fn at(&self, t: f64, values: &[f64]) -> f64 {
        let after = self.t.partition_point(|&x| x < t - 1e-9);
        values[after.min(values.len() - 1)]
    }

    pub(super) fn peak(&self) -> f64 {
        self.stretch
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// (max E − min E)/E(0)
    pub(super) fn energy_spread(&self) -> f64 {
        let total = |k: usize| self.kinetic[k] + self.elastic[k];
        let (mut low, mut high) = (total(0), total(0));
        for k in 0..self.t.len() {
            low = low.min(total(k));
            high = high.max(total(k));
        }
        (high - low) / total(0)
    }
}

/// Runs a preset with changes, and calls `look` after every step.
pub(super) fn run(
    preset: Preset,
    changes: &[String],
    mut look: impl FnMut(&Simulation) -> Result<(), RunError>,
) -> Result<(Simulation, Course), RunError> {
    let assembly = build(&preset.deck(changes)?, &Resources::default())?;
    let measure = assembly.surface.clone().map(SurfaceMeasure::new);
    let mut simulation = assembly.simulation()?;
    let mut course = Course::default();
    let mut note = |run: &Simulation| {
        let energies = run.snapshot().energies();
        course.t.push(run.state().t);
        let stretch = measure
            .as_ref()
            .map_or(f64::NAN, |measure| measure.stretch(&run.state().u));
        course.stretch.push(stretch);
        course.kinetic.push(energies.kinetic);
        course.elastic.push(energies.elastic);
        if run.state().step > 0 {
            let inner = run.integrator().inner_iterations().unwrap_or_default();
            course.iterations.push(inner.last as f64);
        }
    };
    note(&simulation);
    let mut trouble = None;
    simulation
        .run(|run| {
            note(run);
            match look(run) {
                Ok(()) => Control::Continue,
                Err(error) => {
                    trouble = Some(error);
                    Control::Stop
                }
            }
        })
        .map_err(RunError::Simulation)?;
    // The loop does not ask after the last step.
    note(&simulation);
    match trouble {
        Some(error) => Err(error),
        None => Ok((simulation, course)),
    }
}

/// A chart of curves over time.
pub(super) fn chart(
    context: &Context<'_>,
    name: &str,
    title: &str,
    axis: Axis,
    curves: &[(String, &[f64], &[f64])],
) -> Result<(), RunError> {
    let Some(path) = context.figure(name) else {
        return Ok(());
    };
    let mut chart = LineChart::new(Axis::new("t", "s"), axis).title(title);
    for (label, t, values) in curves {
        chart = chart.curve(Curve::line(label, t, values));
    }
    Ok(chart.write(path)?)
}
