//! A rigid ball pressed into a block, against Hertz.

use pericles_contact::{Impactor, Reading};
use pericles_run::{Resources, RunError, build};

use crate::common::finish;
use crate::data::{Case, Found};
use crate::decks::deck;

/// Young's modulus (Pa) of the deck; Poisson's ratio is 1/4.
const YOUNG: f64 = 1e9;

/// Runs the deck with the displacement of its outer layers multiplied by a factor; returns the state of the ball and the error
/// of the energy balance relative to the work.
fn press(case: &Case<'_>, factor: f64) -> Result<(Option<Reading>, f64), RunError> {
    let function = format!(r#"constraint.0.function={{kind="expression",expression="{factor}"}}"#);
    let mut run = build(&deck(case, &[function])?, &Resources::default())?.simulation()?;
    finish(&mut run)?;
    let energies = run.snapshot().energies();
    let balance = energies.balance().abs() / energies.work.abs();
    let mut all = run.system().interactions();
    let reading = all.find_map(|one| one.downcast_ref::<Impactor>().map(Impactor::reading));
    Ok((reading, balance))
}

/// Force on the ball over that of Hertz, 4/3 · 16/15 E √R D^1.5, for the radius and depth of the case; points in contact.
///
/// The outer layers have the displacement of a half-space under the force itself. It follows from two runs, because the
/// force is almost linear in that displacement.
pub(super) fn ball(case: &Case<'_>) -> Result<Found, RunError> {
    let (radius, depth) = (case.number("radius")?, case.number("depth")?);
    let expected = 64.0 / 45.0 * YOUNG * radius.sqrt() * depth.powf(1.5);
    let force = |reading: Option<Reading>| {
        let force = reading.map_or(f64::NAN, |reading| reading.force[2]);
        force / expected
    };
    let (first, _) = press(case, 1.0)?;
    let first = force(first);
    let (second, balance) = press(case, first)?;
    let slope = (force(second) - first) / (first - 1.0);
    Ok(Found::default()
        .value("force", (first - slope) / (1.0 - slope))
        .value("points", second.map(|reading| reading.points as f64))
        .value("balance", balance))
}
