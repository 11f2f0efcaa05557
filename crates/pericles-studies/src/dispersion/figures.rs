//! Curves and coefficients of the studies as files.

use std::path::PathBuf;

use pericles::material::StressState;
use pericles_dispersion::trace;
use pericles_dispersion::tuning::ScalingModel;
use pericles_io::{Axis, Curve, LineChart};
use pericles_run::RunError;
use pericles_run::dispersion::{Curves, STEPS, write_classes};

use super::models::{NamedTables, model, targets};
use crate::context::Context;

/// Writes the curves of a table, if figures are requested: `<name>.png`, `<name>.csv`.
pub(super) fn write_curves(
    context: &Context<'_>,
    model: &ScalingModel,
    name: &str,
    title: &str,
    alpha: &[f64],
) -> Result<(), RunError> {
    let (Some(picture), Some(csv)) = figures(context, name) else {
        return Ok(());
    };
    let lattice = model.lattice(alpha);
    let points = trace(&lattice, model.contour(), STEPS);
    let targets = targets(model.state());
    let curves = Curves {
        contour: model.contour(),
        points: &points,
        dt: None,
        targets: &targets,
    };
    curves.write(&csv)?;
    Ok(curves.draw(&picture, title)?)
}

/// Draws one branch of several tables of a model in one chart, if figures are requested: `<name>-<branch>.png`.
fn write_comparison(
    context: &Context<'_>,
    model: &ScalingModel,
    name: &str,
    title: &str,
    tables: &[(&str, &[f64])],
) -> Result<(), RunError> {
    /// Height of a chart relative to that of the continuum's curve.
    const ROOM: f64 = 1.6;
    let targets = targets(model.state());
    for (branch, branch_name) in model.contour().branches.iter().enumerate() {
        let Some(path) = context.figure(&format!("{name}-{branch_name}.png")) else {
            return Ok(());
        };
        let ones = vec![1.0; model.classes().len()];
        let all = [("original", &ones[..])]
            .into_iter()
            .chain(tables.iter().copied());
        let mut chart: Option<LineChart> = None;
        for (table, alpha) in all {
            let lattice = model.lattice(alpha);
            let points = trace(&lattice, model.contour(), STEPS);
            let curves = Curves {
                contour: model.contour(),
                points: &points,
                dt: None,
                targets: &targets,
            };
            let x: Vec<f64> = points.iter().map(|point| point.abscissa).collect();
            let omega: Vec<f64> = points.iter().map(|p| p.branches[branch].omega()).collect();
            let drawn = chart.take().unwrap_or_else(|| {
                let target: Vec<f64> = points.iter().map(|p| curves.target(branch, p)).collect();
                // Space for the key above the curves.
                let top = target.iter().copied().fold(0.0, f64::max);
                let y = Axis::new("ω", "").range(0.0, ROOM * top);
                LineChart::new(Axis::new(curves.along(), ""), y)
                    .title(format!("{title}, branch {branch_name}"))
                    .curve(Curve::line("continuum", &x, &target).dashed())
            });
            chart = Some(drawn.curve(Curve::line(table, &x, &omega)));
        }
        if let Some(chart) = chart {
            chart.write(path)?;
        }
    }
    Ok(())
}

pub(super) fn figures(context: &Context<'_>, name: &str) -> (Option<PathBuf>, Option<PathBuf>) {
    let file = |ending: &str| context.figure(&format!("{name}.{ending}"));
    (file("png"), file("csv"))
}

/// Writes the coefficients of tables by N, and draws those of each group in one chart. A group is given by its file
/// name ending, the prefix of the names of its tables, and whether they are bounded.
pub(super) fn write_methods(
    context: &Context<'_>,
    (state, body): (StressState, &str),
    tables: &[(f64, NamedTables)],
    groups: &[(&str, &str, bool)],
) -> Result<(), RunError> {
    for (n, list) in tables {
        let model = model(state, *n)?;
        write_tables(context, &model, &format!("coefficients-{n}"), list)?;
        for (ending, kind, bounded) in groups {
            let wanted = |name: &str| name.starts_with(kind) && name.contains("α ≥") == *bounded;
            let group = list.iter().filter(|(name, _)| wanted(name));
            let group: Vec<_> = group.map(|(name, a)| (name.as_str(), &a[..])).collect();
            let (file, title) = (format!("methods-{n}{ending}"), format!("{body}, N = {n}"));
            write_comparison(context, &model, &file, &title, &group)?;
        }
    }
    Ok(())
}

/// Writes the coefficients of tables of one model.
pub(super) fn write_tables(
    context: &Context<'_>,
    model: &ScalingModel,
    name: &str,
    tables: &[(String, Vec<f64>)],
) -> Result<(), RunError> {
    match context.figure(&format!("{name}.csv")) {
        Some(path) => Ok(write_classes(&path, model.classes(), tables)?),
        None => Ok(()),
    }
}
