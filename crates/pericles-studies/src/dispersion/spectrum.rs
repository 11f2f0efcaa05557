//! Spectra measured in time-domain runs, against the time-discrete curve of the analysis.

use pericles::material::StressState;
use pericles_dispersion::spectrum::{SpectrumRun, measure};
use pericles_dispersion::trace;
use pericles_dispersion::tuning::Method;
use pericles_run::RunError;
use pericles_run::dispersion::write_spectrum;
use pericles_run::dispersion::{Curves, STEPS};

use super::models::{model, targets, tuned};
use super::published::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

/// Bars.
pub(crate) const BARS: Study = Study {
    id: "dispersion/spectrum-1d",
    paper: PAPER,
    title: "Measured spectra of bars",
    run: bars,
};

/// Plates.
pub(crate) const PLATES: Study = Study {
    id: "dispersion/spectrum-2d",
    paper: PAPER,
    title: "Measured spectra of plates",
    run: plates,
};

fn bars(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let run = SpectrumRun {
        nodes: 512,
        steps: 8192,
        dt: 0.1,
        seed: 1,
    };
    spectra(
        context,
        StressState::Uniaxial,
        &[1.0, 2.0, 3.0],
        Method::Galerkin,
        run,
    )
}

fn plates(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let run = SpectrumRun {
        nodes: 48,
        steps: 4096,
        dt: 0.1,
        seed: 1,
    };
    spectra(
        context,
        StressState::PlaneStrain,
        &[2.0, 3.0],
        Method::LeastSquares,
        run,
    )
}

fn spectra(
    context: &Context<'_>,
    state: StressState,
    horizons: &[f64],
    method: Method,
    run: SpectrumRun,
) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    for n in horizons {
        let model = model(state, *n)?;
        let cases = [
            ("original", vec![1.0; model.classes().len()]),
            (method.name(), tuned(&model, method, None)?.alpha),
        ];
        for (name, alpha) in cases {
            let lattice = model.lattice(&alpha);
            let spectrum = measure(&lattice, model.contour(), run)
                .map_err(|error| RunError::of_run(error, String::new))?;
            let (worst, peaks) = spectrum.worst_deviation();
            let what = |quantity: &str| format!("N = {n}, {name}: {quantity}");
            rows.push(
                Row::new(what("worst peak off the curve, in lines"), "", Some(worst))
                    .within(0.0, 0.25)
                    .note(format!("{peaks} peaks beyond four lines, where a line and its mirror image are apart")),
            );
            rows.push(Row::new(
                what("the same as a frequency"),
                "",
                Some(worst * spectrum.line),
            ));
            if context.figure("").is_none() {
                continue;
            }
            let points = trace(&lattice, model.contour(), STEPS);
            let curves = Curves {
                contour: model.contour(),
                points: &points,
                dt: Some(run.dt),
                targets: &targets(state),
            };
            let folder = |file: &str| {
                context
                    .figure(&format!("{n}-{name}-{file}"))
                    .unwrap_or_default()
            };
            write_spectrum(&folder, &spectrum, &curves, &format!("N = {n}, {name}"))?;
        }
    }
    Ok(rows)
}
