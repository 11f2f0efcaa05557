//! Decks of the studies.

use pericles_deck::Deck;
use pericles_run::RunError;

use crate::data::Case;

/// Decks in a list of files of the repository.
macro_rules! decks {
    ($($file:literal),* $(,)?) => {
        [$(($file, include_str!(concat!("../decks/", $file)))),*]
    };
}

const DECKS: [(&str, &str); 27] = decks![
    "examples/contact/kalthoff-winkler.toml",
    "examples/fracture/branching.toml",
    "examples/heat/bimaterial-strip.toml",
    "examples/heat/thermal-shock.toml",
    "examples/multi-time-step/inclusion.toml",
    "validation/contact/hertz.toml",
    "validation/contact/kalthoff-prescribed.toml",
    "validation/contact/kalthoff-rigid.toml",
    "validation/dispersion-and-fracture/inclined.toml",
    "validation/experiments/eccentric-beam.toml",
    "validation/experiments/glass-crack-speed.toml",
    "validation/experiments/half-notched-beam.toml",
    "validation/experiments/inclined-crack.toml",
    "validation/experiments/kalthoff-winkler.toml",
    "validation/experiments/taylor-impact.toml",
    "validation/manifolds/paper-calibrated.toml",
    "validation/manifolds/poles.toml",
    "validation/manifolds/standard.toml",
    "validation/multi-time-step/block.toml",
    "validation/multi-time-step/clamped.toml",
    "validation/multi-time-step/crack.toml",
    "validation/multi-time-step/free.toml",
    "validation/multi-time-step/plate-nonlinear.toml",
    "validation/multi-time-step/plate.toml",
    "validation/multi-time-step/pull.toml",
    "validation/multi-time-step/speed.toml",
    "validation/multi-time-step/two-grid.toml",
];

/// Returns the deck of a case: the argument `deck` is a file of the repository or the text of a deck, `set` a list
/// of overrides.
pub(crate) fn deck(case: &Case<'_>, changes: &[String]) -> Result<Deck, RunError> {
    let given = case.text("deck")?;
    let (name, text) = match given.contains('\n') {
        true => ("study.toml", &given[..]),
        false => {
            let name = given.rsplit('/').next().unwrap_or(&given);
            (name, case.one_of("deck", &DECKS)?)
        }
    };
    let mut all = case.texts("set")?;
    all.extend_from_slice(changes);
    Ok(Deck::parse(text, name, &all)?)
}
