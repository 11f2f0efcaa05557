//! Coefficients of cubic lattices, which the paper does not treat.

use pericles::material::StressState;
use pericles_dispersion::tuning::{Combination, Method, Tuning, continuum_speeds};
use pericles_dispersion::{BondLattice, long_wave_speeds};
use pericles_run::RunError;

use super::figures::{write_curves, write_tables};
use super::models::{constraint_residual, model, optimality_residual};
use super::published::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(crate) const STUDY: Study = Study {
    id: "dispersion/three-dimensional",
    paper: PAPER,
    title: "Coefficients of cubic lattices tuned against dispersion (beyond the paper)",
    run,
};

fn run(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let separated = Combination::Separated;
    let choices = [
        (Method::LeastSquares, separated, None),
        (Method::PointCollocation, separated, None),
        (Method::Subdomain, separated, None),
        (Method::Galerkin, separated, None),
        (Method::Absolute, Combination::Absolute, None),
        (Method::LeastSquares, separated, Some(0.3)),
    ];
    let mut rows = Vec::new();
    for n in [2.0, 3.0] {
        let model = model(StressState::Spatial, n)?;
        let mut tables = Vec::new();
        for (method, combination, lower_bound) in choices {
            let table = model.tune(Tuning {
                method,
                combination,
                lower_bound,
                ..Default::default()
            })?;
            let bound = lower_bound.map_or(String::new(), |b| format!(", α ≥ {b}"));
            let name = format!("{}{bound}", method.name());
            let what = |quantity: String| format!("N = {n}, {name}: {quantity}");
            for (class, alpha) in model.classes().iter().zip(&table.alpha) {
                let [a, b, c] = class.offset;
                rows.push(Row::new(what(format!("α({a},{b},{c})")), "", Some(*alpha)));
            }
            let found = &table.assessment;
            rows.push(
                Row::new(what("error".into()), "", Some(found.error.ratio))
                    .note("over that of α = 1"),
            );
            let verdict = if found.stability.is_stable() {
                "stable"
            } else {
                "UNSTABLE: some waves grow"
            };
            rows.push(
                Row::new(
                    what("smallest ω²/k²".into()),
                    "",
                    Some(found.stability.smallest),
                )
                .note(verdict),
            );
            rows.push(Row::new(
                what("ω_max".into()),
                "",
                Some(found.stability.omega_max),
            ));
            rows.push(constraint_residual(&what, &table));
            rows.push(optimality_residual(&what, &table));
            let miss = anisotropy(&model.lattice(&table.alpha));
            rows.push(
                Row::new(what("anisotropy of long waves".into()), "", Some(miss))
                    .within(0.0, 1e-10),
            );
            if method == Method::LeastSquares {
                let file = format!(
                    "curve-{n}{}",
                    if lower_bound.is_some() {
                        "-positive"
                    } else {
                        ""
                    }
                );
                write_curves(
                    context,
                    &model,
                    &file,
                    &format!("cubic lattice, N = {n}, {name}"),
                    &table.alpha,
                )?;
            }
            tables.push((name, table.alpha));
        }
        write_tables(context, &model, &format!("coefficients-{n}"), &tables)?;
    }
    Ok(rows)
}

/// How far long waves are from the speeds of the continuum along directions that no constraint names.
fn anisotropy(lattice: &BondLattice) -> f64 {
    let exact = continuum_speeds(StressState::Spatial);
    [[1.0, 1.0, 1.0], [3.0, 1.0, 2.0]]
        .into_iter()
        .flat_map(|direction| {
            let speeds = long_wave_speeds(lattice, direction);
            [
                speeds[0] / exact.pressure,
                speeds[1] / exact.shear,
                speeds[2] / exact.shear,
            ]
        })
        .map(|ratio| (ratio - 1.0).abs())
        .fold(0.0, f64::max)
}
