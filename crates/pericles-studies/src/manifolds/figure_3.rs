//! Inner iterations of the P-(EC)^k scheme.

use pericles_io::Axis;
use pericles_run::RunError;

use super::course::{chart, run};
use super::presets::{CALIBRATED, PAPER, STANDARD};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "manifolds/figure-3",
    paper: PAPER,
    title: "Inner iterations of the P-(EC)^k scheme, p = 2",
    run: study,
};

fn study(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for (preset, expected) in [(STANDARD, 2.0), (CALIBRATED, 3.0)] {
        let (_, course) = run(preset, &[], |_| Ok(()))?;
        let most = course.iterations.iter().copied().fold(0.0, f64::max);
        let mean = course.iterations.iter().sum::<f64>() / course.iterations.len() as f64;
        rows.push(
            Row::new(
                format!("most iterations of a step, {}", preset.name),
                "",
                Some(most),
            )
            .printed(4.0)
            .within(expected, 1.0)
            .note("printed: 2 to 4. The printed predictor has 1 + γ where 1 − γ is consistent; it was not used, for it is unstable"),
        );
        rows.push(Row::new(
            format!("mean iterations, {}", preset.name),
            "",
            Some(mean),
        ));
        curves.push((preset.name.to_owned(), course));
    }
    let curves: Vec<_> = curves
        .iter()
        .map(|(label, course)| (label.clone(), &course.t[1..], &course.iterations[..]))
        .collect();
    chart(
        context,
        "iterations.png",
        "evaluations per step, α = 0.0001",
        Axis::new("iterations", ""),
        &curves,
    )?;
    Ok(rows)
}
