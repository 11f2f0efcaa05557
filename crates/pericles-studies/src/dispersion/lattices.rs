//! Wave properties of lattices with tables of coefficients.

use std::cell::RefCell;
use std::rc::Rc;

use pericles::material::StressState;
use pericles_dispersion::tuning::{Combination, Method, Tuning};
use pericles_dispersion::{BondLattice, long_wave_speeds};
use pericles_run::RunError;

use super::figures::{write_curves, write_tables};
use super::models::{NamedTables, constraint_residual, method_of, model_of, targets, verdict};
use crate::data::{Case, Found};

/// Long-wave speeds in a direction relative to the continuum: pressure, then shear.
fn long_waves(lattice: &BondLattice, state: StressState, direction: [f64; 3]) -> Vec<f64> {
    let exact = targets(state).into_iter().flatten();
    let speeds = long_wave_speeds(lattice, direction);
    speeds
        .iter()
        .zip(exact)
        .map(|(found, exact)| found / exact)
        .collect()
}

/// Adds the long-wave speeds at 0° and 45° with their names.
pub(super) fn with_long_waves(found: Found, lattice: &BondLattice, state: StressState) -> Found {
    let directions = [("0°", [1.0, 0.0, 0.0]), ("45°", [1.0, 1.0, 0.0])];
    directions
        .into_iter()
        .fold(found, |found, (name, direction)| {
            let ratios = long_waves(lattice, state, direction);
            let named = ["pressure", "shear"].into_iter().zip(ratios);
            named.fold(found, |found, (wave, ratio)| {
                found.value(format!("{wave} at {name}"), ratio)
            })
        })
}

/// α = 1: errors and long waves: ω²/k² along an axis, which is 1 + 1/N in bars, and speeds relative to the
/// continuum.
pub(super) fn original(case: &Case<'_>) -> Result<Found, RunError> {
    let model = model_of(case)?;
    let ones = vec![1.0; model.classes().len()];
    let lattice = model.lattice(&ones);
    let speed = long_wave_speeds(&lattice, [1.0, 0.0, 0.0])[0];
    let closed = 1.0 + 1.0 / case.number("n")?;
    let found = Found::from([("square", speed * speed), ("closed form", closed)]);
    let found = match model.state() {
        StressState::Uniaxial => found,
        state => with_long_waves(found, &lattice, state),
    };
    // Large horizons take long.
    if case.flag("without_error") {
        return Ok(found);
    }
    let error = model.assess(&ones)?.error;
    Ok(found
        .value("error", error.absolute)
        .value("error over N = 3", error.ratio))
}

/// Table tuned by a choice of method, combination and bound: its error, its wave properties, and the residuals of its
/// constraints.
pub(super) fn of_choice(case: &Case<'_>) -> Result<Found, RunError> {
    let (model, method) = (model_of(case)?, method_of(case)?);
    let combinations = Combination::ALL.map(|combination| (combination.name(), combination));
    let lower_bound = case.optional("lower_bound");
    let table = model.tune(Tuning {
        method,
        combination: case.one_of("combination", &combinations)?,
        lower_bound,
        ..Default::default()
    })?;
    let (n, name) = (case.number("n")?, case.text("name")?);
    let lattice = model.lattice(&table.alpha);
    // Deviation of the long-wave speeds from the continuum along directions that no constraint includes.
    let anisotropy = [[1.0, 1.0, 1.0], [3.0, 1.0, 2.0]]
        .into_iter()
        .flat_map(|direction| long_waves(&lattice, model.state(), direction))
        .map(|ratio| (ratio - 1.0).abs())
        .fold(0.0, f64::max);
    if method == Method::LeastSquares {
        let positive = lower_bound.map_or("", |_| "-positive");
        let (file, title) = (
            format!("curve-{n}{positive}"),
            format!("cubic lattice, N = {n}, {name}"),
        );
        write_curves(case.context, &model, &file, &title, &table.alpha)?;
    }
    let tables = tables(case)?;
    tables.borrow_mut().push((name, table.alpha.clone()));
    let found = &table.assessment;
    Ok(Found::from(found.error.ratio)
        .value("smallest", found.stability.smallest)
        .value("highest", found.stability.omega_max)
        .value("constraint", constraint_residual(&table))
        .value("optimality", table.kkt)
        .value("anisotropy", anisotropy)
        .text("verdict", verdict(&table)))
}

/// Tables computed for the N of the case.
fn tables(case: &Case<'_>) -> Result<Rc<RefCell<NamedTables>>, RunError> {
    case.once(format!("tables {}", case.number("n")?), || {
        Ok(Default::default())
    })
}

/// Writes the coefficients of all tables computed for an N.
pub(super) fn write_coefficients(case: &Case<'_>) -> Result<Found, RunError> {
    let file = format!("coefficients-{}", case.number("n")?);
    write_tables(
        case.context,
        &model_of(case)?,
        &file,
        &tables(case)?.borrow(),
    )?;
    Ok(Found::default())
}
