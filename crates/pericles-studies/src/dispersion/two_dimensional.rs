//! Signed and bounded coefficients of plates, and their wave properties over the whole zone.

use pericles::material::StressState;
use pericles_dispersion::polar_speeds;
use pericles_dispersion::tuning::{Method, Tuning};
use pericles_run::RunError;
use pericles_run::dispersion::write_polar;

use super::figures::{write_curves, write_methods};
use super::models::{NamedTables, constraint_residual, model, model_of, tuned, verdict};
use super::published::{combination, method, number, numbers, published, rounding};
use crate::common::difference;
use crate::data::{Case, Found};
use crate::row::Row;

const TABLE: &str =
    include_str!("../../decks/validation/dispersion-and-fracture/two-dimensional.csv");

/// Rows of the table.
pub(super) fn published_plates(case: &Case<'_>) -> Result<Found, RunError> {
    let mut rows = Vec::new();
    let mut tables: Vec<(f64, NamedTables)> = Vec::new();
    for cells in published(TABLE) {
        let (Some(n), Some(tolerance)) = (number(&cells, 0), number(&cells, 4)) else {
            continue;
        };
        let model = model(StressState::PlaneStrain, n)?;
        let lower_bound = number(&cells, 3);
        let tuning = Tuning {
            method: method(cells[1])?,
            combination: combination(cells[2])?,
            lower_bound,
            ..Default::default()
        };
        let table = model.tune(tuning)?;
        let bound = lower_bound.map_or(String::new(), |b| format!(", α ≥ {b}"));
        let name = format!("{} {}{bound}", cells[2], cells[1]);
        let what = |quantity: String| format!("N = {n}, {name}: {quantity}");
        for (class, expected) in numbers(&cells, 8).into_iter().enumerate() {
            let [a, b, _] = model.classes()[class].offset;
            let row = Row::new(
                what(format!("α({a},{b})")),
                "",
                table.alpha.get(class).copied(),
            );
            // Values with few digits are accurate to half a unit of the last one.
            let allowed =
                (tolerance * expected.abs()).max(if tolerance < 5e-3 { 6e-5 } else { 6e-3 });
            let row = row.within(expected, allowed);
            rows.push(if cells[9].is_empty() {
                row
            } else {
                row.note(format!(
                    "an earlier independent code stopped at {}, where the nearly flat functional is larger by a \
                    relative 1e-4",
                    numbers(&cells, 9).get(class).copied().unwrap_or(f64::NAN)
                ))
            });
        }
        let found = &table.assessment;
        let rough = if tolerance < 1e-3 { 6e-4 } else { 6e-3 };
        if let (Some(error), Some(smallest)) = (number(&cells, 5), number(&cells, 6)) {
            rows.push(
                Row::new(what("error".into()), "", Some(found.error.ratio))
                    .within(error, 1.1e-3)
                    .note("∮|R_p|+|R_s| relative to α = 1"),
            );
            rows.push(
                Row::new(
                    what("smallest ω²/k²".into()),
                    "",
                    Some(found.stability.smallest),
                )
                .within(smallest, rough)
                .note(verdict(&table)),
            );
        }
        if let Some(omega) = number(&cells, 7) {
            let highest = Some(found.stability.omega_max);
            rows.push(
                Row::new(what("ω_max".into()), "", highest)
                    .within(omega, (3.0 * rough).max(rounding(&cells, 7))),
            );
        }
        let (constraint, optimality) = (constraint_residual(&table), table.kkt);
        rows.push(
            Row::new(what("constraint residual".into()), "", Some(constraint)).within(0.0, 1e-12),
        );
        rows.push(
            Row::new(what("optimality residual".into()), "", Some(optimality)).within(0.0, 1e-9),
        );
        match tables.last_mut() {
            Some((last, list)) if *last == n => list.push((name, table.alpha)),
            _ => tables.push((n, vec![(name, table.alpha)])),
        }
    }
    let groups = [
        ("-separated", "separated", false),
        ("-absolute", "absolute", false),
        ("-positive", "separated", true),
    ];
    let plates = (StressState::PlaneStrain, "plates");
    write_methods(case.context, plates, &tables, &groups)?;
    Ok(rows.into())
}

/// Draws the curves of α = 1 and of least squares, and the speeds of α = 1 by direction.
pub(super) fn polar(case: &Case<'_>) -> Result<Found, RunError> {
    let (context, model, n) = (case.context, model_of(case)?, case.number("n")?);
    let ones = vec![1.0; model.classes().len()];
    let (file, title) = (
        format!("curve-{n}-original"),
        format!("plate, N = {n}, α = 1"),
    );
    write_curves(context, &model, &file, &title, &ones)?;
    let table = tuned(&model, Method::LeastSquares, None)?;
    let (file, title) = (
        format!("curve-{n}-least-squares"),
        format!("plate, N = {n}, least squares"),
    );
    write_curves(context, &model, &file, &title, &table.alpha)?;
    let file = |ending: &str| context.figure(&format!("polar-{n}-original.{ending}"));
    if let (Some(csv), Some(picture)) = (file("csv"), file("png")) {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let polar = polar_speeds(&model.lattice(&ones), axes, 360);
        write_polar(&csv, &picture, &polar, &["p", "s"])?;
    }
    Ok(Found::default())
}

/// Largest difference between the coefficients of both plane states, which should be equal.
pub(super) fn plane_states(_: &Case<'_>) -> Result<Found, RunError> {
    let of = |state| tuned(&model(state, 3.0)?, Method::LeastSquares, None);
    let (strain, stress) = (of(StressState::PlaneStrain)?, of(StressState::PlaneStress)?);
    Ok(difference(&strain.alpha, &stress.alpha).into())
}

/// No coefficients exist for another Poisson's ratio: for ν = 0.3 the pair A = V_p², B = V_s² holds along an axis
/// only, because the speed of pressure waves at 45° is that of (A + 3B)/2.
pub(super) fn other_ratio(_: &Case<'_>) -> Result<Found, RunError> {
    let (a, b): (f64, f64) = ((1.0 - 0.3) / (1.3 * 0.4), 1.0 / 2.6);
    Ok([("0°", a), ("45°", 0.5 * (a + 3.0 * b))].into())
}
