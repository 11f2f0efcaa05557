//! A rigid ball pressed into a block, against Hertz.

use pericles_contact::Impactor;
use pericles_run::{Resources, RunError, build};

use crate::common::finish;
use crate::data::{Case, Found};
use crate::decks::deck;

/// Young's modulus (Pa) of the deck; Poisson's ratio is 1/4.
const YOUNG: f64 = 1e9;

/// Force on the ball over that of Hertz, 4/3 · 16/15 E √R D^1.5, for the radius and depth of the case; points in contact.
pub(super) fn ball(case: &Case<'_>) -> Result<Found, RunError> {
    let (radius, depth) = (case.number("radius")?, case.number("depth")?);
    let deck = deck(case, &[])?;
    let mut run = build(&deck, &Resources::default())?.simulation()?;
    finish(&mut run)?;
    let mut all = run.system().interactions();
    let reading = all.find_map(|one| one.downcast_ref::<Impactor>().map(Impactor::reading));
    let expected = 64.0 / 45.0 * YOUNG * radius.sqrt() * depth.powf(1.5);
    let energies = run.snapshot().energies();
    Ok(Found::default()
        .value("force", reading.map(|reading| reading.force[2] / expected))
        .value("points", reading.map(|reading| reading.points as f64))
        .value("balance", energies.balance().abs() / energies.work.abs()))
}
