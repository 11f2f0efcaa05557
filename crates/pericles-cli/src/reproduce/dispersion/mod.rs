//! Dispersion: coefficients tuned against it, spectra measured in the time domain, influence functions and critical stretches that go with them.
//!
//! Alebrahim, Packo, Zaccariotto, Galvanetto, Improved wave dispersion properties in 1D and 2D bond-based peridynamic media, Computational Particle
//! Mechanics (2022). The paper's tables of coefficients are not in print; the expected numbers were computed by separate codes and are kept in
//! `validation/dispersion-and-fracture/`. Units of the spacing and of √(E/ρ) unless a row says otherwise; full node volumes.

mod critical_stretch;
mod influence;
mod one_dimensional;
mod pulse;
mod spectrum;
mod three_dimensional;
mod two_dimensional;

use std::path::PathBuf;

use pericles::family::VolumeCorrection;
use pericles::material::StressState;
use pericles_dispersion::trace;
use pericles_dispersion::tuning::{
    Combination, Method, ScalingModel, TunedTable, Tuning, continuum_speeds,
};
use pericles_io::{Axis, Curve, LineChart};

use super::{Context, Study};
use pericles_run::RunError;
use pericles_run::dispersion::{Curves, STEPS, write_classes};

const PAPER: &str = "Alebrahim et al. 2022, Comput. Part. Mech.";

/// The studies of this topic.
pub(super) const STUDIES: [Study; 8] = [
    one_dimensional::STUDY,
    two_dimensional::STUDY,
    three_dimensional::STUDY,
    spectrum::BARS,
    spectrum::PLATES,
    influence::STUDY,
    critical_stretch::STUDY,
    pulse::STUDY,
];

/// Coefficients with their names.
type NamedTables = Vec<(String, Vec<f64>)>;

/// The rows of a table of published numbers: cells by column, comments and header left out.
fn published(text: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.skip(1).map(|line| line.split(',').collect())
}

/// A number of such a table; none where it is empty.
fn number(row: &[&str], column: usize) -> Option<f64> {
    row.get(column)?.parse().ok()
}

/// The numbers of one cell.
fn numbers(row: &[&str], column: usize) -> Vec<f64> {
    let cell = row.get(column).copied().unwrap_or_default();
    cell.split(' ').filter_map(|x| x.parse().ok()).collect()
}

/// Half a unit of the last digit given, and a little.
fn rounding(row: &[&str], column: usize) -> f64 {
    let cell = row.get(column).copied().unwrap_or_default();
    let places = cell.split_once('.').map_or(0, |(_, digits)| digits.len());
    0.6 * 10f64.powi(-(places as i32))
}

fn method(name: &str) -> Result<Method, RunError> {
    let named = Method::ALL.map(|method| (method.name(), method));
    known("method of tuning", name, &named)
}

fn combination(name: &str) -> Result<Combination, RunError> {
    let named = Combination::ALL.map(|combination| (combination.name(), combination));
    known("combination of branches", name, &named)
}

/// The value that a word of a study's data names.
fn known<T: Copy>(kind: &'static str, name: &str, all: &[(&str, T)]) -> Result<T, RunError> {
    let found = all.iter().find(|(word, _)| *word == name);
    found.map(|(_, value)| *value).ok_or_else(|| {
        let words: Vec<&str> = all.iter().map(|(word, _)| *word).collect();
        RunError::unknown(
            kind,
            name,
            &words,
            &format!("allowed: {}", words.join(", ")),
        )
    })
}

fn model(state: StressState, n: f64) -> Result<ScalingModel, RunError> {
    Ok(ScalingModel::new(state, n, VolumeCorrection::None)?)
}

fn tuned(
    model: &ScalingModel,
    method: Method,
    lower_bound: Option<f64>,
) -> Result<TunedTable, RunError> {
    Ok(model.tune(Tuning {
        method,
        lower_bound,
        ..Default::default()
    })?)
}

/// Draws and writes the curves of a table, if figures are wanted: `<name>.png`, `<name>.csv`.
fn write_curves(
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

/// Draws one branch of several tables of a model over each other, if figures are wanted: `<name>-<branch>.png`.
fn write_comparison(
    context: &Context<'_>,
    model: &ScalingModel,
    name: &str,
    title: &str,
    tables: &[(&str, &[f64])],
) -> Result<(), RunError> {
    /// Height of a chart over that of the continuum's curve.
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
                // Room above the curves for the key.
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

fn figures(context: &Context<'_>, name: &str) -> (Option<PathBuf>, Option<PathBuf>) {
    let file = |ending: &str| context.figure(&format!("{name}.{ending}"));
    (file("png"), file("csv"))
}

/// Speed of the continuum for each branch.
fn targets(state: StressState) -> Vec<Option<f64>> {
    let speeds = continuum_speeds(state);
    let mut targets = vec![Some(speeds.shear); state.dimension()];
    targets[0] = Some(speeds.pressure);
    targets
}

/// Writes the coefficients of tables of one model.
fn write_tables(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::{Study, row::Row};

    #[test]
    fn misspelt_words_of_the_data_are_refused() {
        assert_eq!(method("galerkin").unwrap(), Method::Galerkin);
        let refused = method("galerkyn").unwrap_err().to_string();
        assert_eq!(refused, "there is no method of tuning \"galerkyn\"");
        assert!(combination("seperated").is_err());
        assert!(combination("").is_err());
    }

    /// Every study but the slow ones: all judged rows hold, and there are some.
    #[test]
    fn studies_hold() {
        let context = Context::without_figures();
        let studies: [&Study; 5] = [
            &one_dimensional::STUDY,
            &two_dimensional::STUDY,
            &three_dimensional::STUDY,
            &influence::STUDY,
            &critical_stretch::STUDY,
        ];
        for study in studies {
            let rows = (study.run)(&context).unwrap();
            let wrong: Vec<&Row> = rows.iter().filter(|r| r.pass() == Some(false)).collect();
            assert!(wrong.is_empty(), "{}: {wrong:?}", study.id);
            assert!(
                rows.iter().any(|row| row.pass() == Some(true)),
                "{}",
                study.id
            );
        }
    }
}
