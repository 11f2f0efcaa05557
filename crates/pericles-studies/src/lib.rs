//! Studies that reproduce published results and compare them with the printed values.
//!
//! A [`Study`] is a data file: its rows with the printed and the expected values, and the functions that compute
//! them with their arguments. Every row but wall times is judged ([`Row`]), by a tolerance or a one-sided bound, and
//! never by a clock; a printed value known not to be reproducible is shown beside the verified one that is judged,
//! with the reason. Values of experiments are compared with the measured range instead ([`Agreement`]): that a model
//! does not agree is a result and not a failure. Studies, their data and their
//! decks are part of the library, so they run from any directory; they write no files except requested figures and
//! temporary ones, and print nothing. The tests run the same studies.
//!
//! A new study is a file `data/TOPIC/NAME.toml`, listed in the `studies` of its topic; functions that it needs are
//! listed in the topic's `measures`. A new topic is listed in `TOPICS`.
//!
//! ```no_run
//! use pericles_studies::{Context, find, table};
//!
//! let study = find("fracture/branching")?;
//! let rows = study.run(&Context { full: false, figures: None, tell: &|_| {} })?;
//! println!("{}", table(&rows));
//! # Ok::<(), pericles_run::RunError>(())
//! ```

mod absorbing_boundaries;
mod common;
mod contact;
mod context;
mod data;
mod decks;
mod dispersion;
mod fracture;
mod heat;
mod manifolds;
mod multi_time_step;
mod nonlocal_wave;
mod numerics;
mod row;
mod state_based;
mod statics;
mod study;
mod table;
mod validation;

use std::sync::LazyLock;

use pericles_run::RunError;

pub use context::Context;
pub use row::{Agreement, Row, Rule};
pub use study::Study;
pub use table::table;

use study::Topic;

const TOPICS: [&Topic; 12] = [
    &absorbing_boundaries::TOPIC,
    &contact::TOPIC,
    &dispersion::TOPIC,
    &fracture::TOPIC,
    &heat::TOPIC,
    &manifolds::TOPIC,
    &multi_time_step::TOPIC,
    &nonlocal_wave::TOPIC,
    &numerics::TOPIC,
    &state_based::TOPIC,
    &statics::TOPIC,
    &validation::TOPIC,
];

static STUDIES: LazyLock<Vec<Study>> =
    LazyLock::new(|| TOPICS.into_iter().flat_map(Topic::read).collect());

/// All studies by topic.
pub fn studies() -> impl Iterator<Item = &'static Study> {
    STUDIES.iter()
}

/// Returns the study with a name.
///
/// # Errors
/// No study has this name.
pub fn find(id: &str) -> Result<&'static Study, RunError> {
    studies().find(|study| study.id == id).ok_or_else(|| {
        let all = "list all studies with `pericles reproduce --list`";
        RunError::unknown("study", id, studies().map(|study| study.id), all)
    })
}

/// Returns true if every judged row is within its tolerance.
pub fn all_hold(rows: &[Row]) -> bool {
    rows.iter().all(|row| row.pass() != Some(false))
}

#[cfg(test)]
mod tests;
