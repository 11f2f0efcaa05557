//! Coefficients of bars by all methods.

use pericles::material::StressState;
use pericles_run::RunError;

use super::figures::{write_curves, write_methods};
use super::models::{NamedTables, constraint_residual, model, tuned};
use super::published::{method, number, numbers, published};
use crate::data::{Case, Found};
use crate::row::Row;

const TABLE: &str =
    include_str!("../../decks/validation/dispersion-and-fracture/one-dimensional.csv");

/// Rows of the table.
pub(super) fn published_bars(case: &Case<'_>) -> Result<Found, RunError> {
    let context = case.context;
    let mut rows = Vec::new();
    let mut tables: Vec<(f64, NamedTables)> = Vec::new();
    for cells in published(TABLE) {
        let (Some(n), name) = (number(&cells, 0), cells[1]) else {
            continue;
        };
        let model = model(StressState::Uniaxial, n)?;
        let table = tuned(&model, method(name)?, None)?;
        let what = |quantity: String| format!("N = {n}, {name}: {quantity}");
        for (i, expected) in numbers(&cells, 4).into_iter().enumerate() {
            let case = what(format!("α{}", i + 1));
            let row = Row::new(case, "", table.alpha.get(i).copied()).within_share(expected, 1e-4);
            // Values printed in the text of the paper: 3.72 and −0.86.
            rows.push(match (n == 2.0 && name == "galerkin", i) {
                (true, 0) => row.printed(3.72),
                (true, _) => row.printed(-0.86),
                _ if n == 2.0 && name == "galerkin-literal" => row.note(
                    "with the printed weights; the printed coefficients are those of \"galerkin\"",
                ),
                _ => row,
            });
        }
        let assessed = &table.assessment;
        let error = Row::new(what("error".into()), "", Some(assessed.error.ratio));
        let omega = Row::new(what("ω_max".into()), "", Some(assessed.stability.omega_max));
        if let (Some(expected), Some(highest)) = (number(&cells, 2), number(&cells, 3)) {
            rows.push(
                error
                    .within(expected, 1e-5)
                    .note("relative to α = 1 with N = 3"),
            );
            rows.push(omega.within(highest, 1e-4));
        }
        let residual = Some(constraint_residual(&table));
        let condition = format!(
            "condition number {:.4}: round-off of the coefficients is about 1e-16 times this number",
            table.condition
        );
        rows.push(
            Row::new(what("constraint residual".into()), "", residual)
                .within(0.0, 1e-12)
                .note(if n == 10.0 { condition } else { String::new() }),
        );
        let file = format!("curve-{n}-{name}");
        write_curves(
            context,
            &model,
            &file,
            &format!("bar, N = {n}, {name}"),
            &table.alpha,
        )?;
        match tables.last_mut() {
            Some((last, list)) if *last == n => list.push((name.into(), table.alpha)),
            _ => tables.push((n, vec![(name.into(), table.alpha)])),
        }
    }
    let bars = (StressState::Uniaxial, "bars");
    write_methods(context, bars, &tables, &[("", "", false)])?;
    Ok(rows.into())
}
