//! Influence function printed as a sum of cosines, compared with the table that it represents.

use std::f64::consts::PI;

use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::StressState;
use pericles_dispersion::tuning::{
    Method, ScalingModel, TunedTable, fit_cosines, influence_alebrahim, polygon,
};
use pericles_run::RunError;

use super::figures::write_curves;
use super::lattices::with_long_waves;
use super::models::{model, tuned};
use crate::data::{Case, Found};

const N: f64 = 3.0;

fn on_stretch(function: InfluenceFunction) -> Influence {
    Influence {
        function,
        acts_on: ActsOn::Stretch,
    }
}

/// The model, the table that the function represents, the printed function and its values at the classes.
fn printed() -> Result<(ScalingModel, TunedTable, Influence, Vec<f64>), RunError> {
    let model = model(StressState::PlaneStrain, N)?;
    let table = tuned(&model, Method::LeastSquares, Some(0.5))?;
    let printed = on_stretch(influence_alebrahim(1.0));
    let classes = model.classes().iter();
    let alpha = classes.map(|c| printed.alpha(c.length, N)).collect();
    Ok((model, table, printed, alpha))
}

/// Equally many places up to the horizon.
fn places(count: u32) -> impl Iterator<Item = f64> {
    (1..=count).map(move |k| N * f64::from(k) / f64::from(count))
}

/// Value of the printed function at the class with this `number`, and the coefficient of the table.
pub(super) fn at_class(case: &Case<'_>) -> Result<Found, RunError> {
    let number = case.count("number")?;
    let (_, table, _, alpha) = printed()?;
    let value = Found::default().value("value", alpha.get(number).copied());
    Ok(value.value("table", table.alpha.get(number).copied()))
}

/// Effect of the printed function on the modulus and on waves.
pub(super) fn printed_function(case: &Case<'_>) -> Result<Found, RunError> {
    let (model, _, printed, alpha) = printed()?;
    let values = places(3000).map(|r| printed.alpha(r, N));
    let bonds = model.classes().iter().zip(&alpha);
    let sum: f64 = bonds
        .map(|(c, a)| c.multiplicity as f64 * c.length * a)
        .sum();
    let found = Found::from([
        ("smallest", values.fold(f64::INFINITY, f64::min)),
        ("moment", printed.moment(2.0, N) / 9.0),
        ("sum", sum / (2.0 * PI * N.powi(3) / 3.0)),
        ("error", model.assess(&alpha)?.error.ratio),
    ]);
    let title = "plate, N = 3, printed influence function";
    write_curves(case.context, &model, "curve-printed", title, &alpha)?;
    Ok(with_long_waves(
        found,
        &model.lattice(&alpha),
        model.state(),
    ))
}

/// Root mean square difference between fitted cosines and the linear interpolation of the table.
pub(super) fn fitted_cosines(_: &Case<'_>) -> Result<Found, RunError> {
    let (model, table, printed, _) = printed()?;
    let InfluenceFunction::Classes(classes) = &table.influence(2, 1.0)?.function else {
        return Ok(Found::default());
    };
    let fit = on_stretch(fit_cosines(classes, N, 1.1, 8)?);
    let line = on_stretch(polygon(classes));
    let r: Vec<f64> = places(300).collect();
    let values =
        |influence: &Influence| -> Vec<f64> { r.iter().map(|r| influence.alpha(*r, N)).collect() };
    let (fitted, through) = (values(&fit), values(&line));
    let pairs = fitted.iter().zip(&through);
    let apart = pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / 300.0;
    let lengths: Vec<f64> = model.classes().iter().map(|c| c.length).collect();
    Ok(Found::from(apart.sqrt())
        .labelled(
            "function",
            Some("printed cosines".into()),
            &r,
            &values(&printed),
        )
        .labelled(
            "function",
            Some("linear interpolation of the table".into()),
            &r,
            &through,
        )
        .curve("fit", &r, &fitted)
        .curve("table", &lengths, &table.alpha))
}
