//! Spectra measured in time-domain runs, compared with the time-discrete curve of the analysis.

use pericles_dispersion::spectrum::{SpectrumRun, measure};
use pericles_dispersion::trace;
use pericles_run::RunError;
use pericles_run::dispersion::{Curves, STEPS, write_spectrum};

use super::models::{method_of, model_of, targets, tuned};
use crate::data::{Case, Found};

/// Largest deviation of a peak from the curve of α = 1 or of the tuned table, in lines and as a frequency.
pub(super) fn spectrum(case: &Case<'_>) -> Result<Found, RunError> {
    let run = SpectrumRun {
        nodes: case.count("nodes")?,
        steps: case.count("steps")?,
        dt: 0.1,
        seed: 1,
    };
    let model = model_of(case)?;
    let (n, name) = (case.number("n")?, case.text("method")?);
    let alpha = match &name[..] {
        "original" => vec![1.0; model.classes().len()],
        _ => tuned(&model, method_of(case)?, None)?.alpha,
    };
    let lattice = model.lattice(&alpha);
    let spectrum = measure(&lattice, model.contour(), run)
        .map_err(|error| RunError::of_run(error, String::new))?;
    let (worst, peaks) = spectrum.worst_deviation();
    if case.context.figures.is_some() {
        let points = trace(&lattice, model.contour(), STEPS);
        let curves = Curves {
            contour: model.contour(),
            points: &points,
            dt: Some(run.dt),
            targets: &targets(model.state()),
        };
        let file = |file: &str| {
            let name = format!("{n}-{name}-{file}");
            case.context.figure(&name).unwrap_or_default()
        };
        write_spectrum(&file, &spectrum, &curves, &format!("N = {n}, {name}"))?;
    }
    Ok([
        ("lines", worst),
        ("frequency", worst * spectrum.line),
        ("peaks", peaks as f64),
    ]
    .into())
}
