//! Tables 2 to 6: errors of the truncated bar relative to the solution in continuous time.

use pericles::time::State;
use pericles_run::RunError;

use super::bar::{Bar, HALF, Kind, SEISMIC_BAR, SPACING, kernels};
use crate::common::{difference, largest};
use crate::data::{Case, Found};

/// Time step of the figures.
const DT: f64 = 0.005;

/// Bar of the case: homogeneous or with a soft middle of stiffness `beta` and absorbing boundaries, or excited by a
/// wavelet.
fn bar_of(case: &Case<'_>) -> Bar {
    case.optional("beta").map_or(SEISMIC_BAR, Bar::infinite)
}

/// Largest errors over all nodes at the `times` with time step dt and a kind of boundary.
fn errors(case: &Case<'_>, kind: Kind, dt: f64) -> Result<Vec<f64>, RunError> {
    let (bar, times) = (bar_of(case), case.numbers("times")?);
    let velocity = case.flag("velocity");
    let reference = case.once("reference".into(), || bar.reference(&times))?;
    let states = case.once(format!("{kind:?} {dt}"), || bar.states(kind, dt, &times))?;
    let pairs = states.iter().zip(&*reference);
    let errors = pairs.map(|(a, b)| match velocity {
        true => difference(&a.v, &b.v),
        false => difference(&a.u, &b.u),
    });
    Ok(errors.collect())
}

/// Error at the time with this `number`, with the boundaries of the paper and with those exact for the scheme.
pub(super) fn error(case: &Case<'_>) -> Result<Found, RunError> {
    let (number, dt) = (case.count("number")?, case.number("dt")?);
    let of = |kind| errors(case, kind, dt).map(|errors| errors.get(number).copied());
    let paper = Found::default().value("value", of(Kind::SemiDiscrete)?);
    Ok(paper.value("exact", of(Kind::Discrete)?))
}

/// Order of the error from step `coarse` to step `fine`. For the wavelet only the two finest steps are used: its
/// late errors have a part of higher order at the coarsest, also in the printed values.
pub(super) fn order(case: &Case<'_>) -> Result<Found, RunError> {
    let [coarse, fine] = [case.number("coarse")?, case.number("fine")?];
    let number = case.count("number")?;
    let [a, b] = [coarse, fine].map(|dt| errors(case, Kind::SemiDiscrete, dt));
    let errors = a?.get(number).copied().zip(b?.get(number).copied());
    let order = errors.map(|(a, b)| (a / b).ln() / (coarse / fine).ln());
    Ok(Found::default().value("value", order))
}

/// Displacement of a node over time.
struct History {
    t: Vec<f64>,
    u: Vec<f64>,
}

/// Time histories of nodes, with exact boundaries.
fn histories<const N: usize>(
    bar: &Bar,
    nodes: [usize; N],
    end: f64,
) -> Result<[History; N], RunError> {
    let steps = (end / DT).round() as u64;
    let kernels = kernels(Kind::Discrete, DT, steps as usize)?;
    let mut histories = nodes.map(|_| History {
        t: Vec::new(),
        u: Vec::new(),
    });
    bar.follow(&kernels, DT, steps, |state| {
        for (history, &node) in histories.iter_mut().zip(&nodes) {
            history.t.push(state.t);
            history.u.push(state.u[node]);
        }
    })?;
    Ok(histories)
}

/// Pulse that leaves in two halves; for the figure only.
pub(super) fn fields(case: &Case<'_>) -> Result<Found, RunError> {
    if case.context.figures.is_none() {
        return Ok(Found::default());
    }
    let times = [2.0, 5.0, 8.0, 10.0, 15.0];
    let states = Bar::infinite(1.0).states(Kind::Discrete, DT, &times)?;
    let x: Vec<f64> = (0..=2 * HALF)
        .map(|i| (i as f64 - HALF as f64) * SPACING)
        .collect();
    let draw = |found: Found, (t, state): (&f64, &State)| {
        found.labelled("fields", Some(format!("t = {t}")), &x, &state.u)
    };
    Ok(times.iter().zip(&states).fold(Found::default(), draw))
}

/// The softer the middle, the more slowly waves between interfaces leave: checks that the remaining amplitude grows
/// in this order.
pub(super) fn interfaces(_: &Case<'_>) -> Result<Found, RunError> {
    let mut found = Found::default();
    let mut left = Vec::new();
    for beta in [1.0, 0.5, 0.1] {
        let [middle] = histories(&Bar::infinite(beta), [HALF], 60.0)?;
        let late = middle.t.iter().zip(&middle.u).filter(|(t, _)| **t > 40.0);
        left.push(late.fold(0.0, |a: f64, (_, u)| a.max(u.abs())));
        let label = Some(format!("β = {beta}"));
        found = found.labelled("interfaces", label, &middle.t, &middle.u);
    }
    let ordered = left[0] < left[1] && left[1] < left[2];
    Ok(found
        .value("ordered", f64::from(u8::from(ordered)))
        .value("hard", left[0])
        .value("half", left[1])
        .value("tenth", left[2]))
}

/// Peaks at both ends; the free end moves twice as far as the wavelet.
pub(super) fn wavelet(_: &Case<'_>) -> Result<Found, RunError> {
    let [left, right] = histories(&SEISMIC_BAR, [0, 2 * HALF], 40.0)?;
    let found = Found::from([("absorbing", largest(&left.u)), ("free", largest(&right.u))]);
    let names = ["absorbing boundary", "free end"].map(|name| Some(name.to_owned()));
    let ends = names.into_iter().zip([&left, &right]);
    Ok(ends.fold(found, |found, (name, end)| {
        found.labelled("wavelet", name, &end.t, &end.u)
    }))
}
