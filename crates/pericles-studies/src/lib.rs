//! Studies of papers, computed again and compared with the published numbers.
//!
//! A [`Study`] is a function that computes rows; it knows nothing of files but the figures it may draw, and does not print. Studies and their decks are inside
//! the library, so that they run from any directory. A row is judged if it has an expected number ([`Row`]); a printed number known not to reproduce is shown
//! beside the verified one that is judged, with the reason. The same studies are run by the tests.
//!
//! A new study is one file with a `STUDY`, listed in its topic's `STUDIES`; a new topic is listed in `TOPICS`.
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
mod dispersion;
mod fracture;
mod manifolds;
mod multi_time_step;
mod nonlocal_wave;
mod numerics;
mod row;
mod state_based;
mod study;
mod table;

use pericles_run::RunError;

pub use row::Row;
pub use study::{Context, Study};
pub use table::table;

/// All studies, by topic.
const TOPICS: [&[Study]; 8] = [
    &absorbing_boundaries::STUDIES,
    &dispersion::STUDIES,
    &fracture::STUDIES,
    &manifolds::STUDIES,
    &multi_time_step::STUDIES,
    &nonlocal_wave::STUDIES,
    &numerics::STUDIES,
    &state_based::STUDIES,
];

/// All studies, by topic.
pub fn studies() -> impl Iterator<Item = &'static Study> {
    TOPICS.into_iter().flatten()
}

/// The study of a name.
///
/// # Errors
/// A name that no study has.
pub fn find(id: &str) -> Result<&'static Study, RunError> {
    studies().find(|study| study.id == id).ok_or_else(|| {
        let all = "`pericles reproduce --list` shows all studies";
        RunError::unknown("study", id, studies().map(|study| study.id), all)
    })
}

/// Whether every judged row holds.
pub fn all_hold(rows: &[Row]) -> bool {
    rows.iter().all(|row| row.pass() != Some(false))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn studies_are_found_by_name_only() {
        for study in studies() {
            assert_eq!(find(study.id).ok().map(|s| s.id), Some(study.id));
        }
        let Err(RunError::Unknown { hint, .. }) = find("fracture/branch") else {
            panic!("found");
        };
        assert!(hint.contains("fracture/branching"), "{hint}");
        let Err(RunError::Unknown { hint, .. }) = find("zzz") else {
            panic!("found");
        };
        assert!(!hint.contains("did you mean"), "{hint}");
    }

    #[test]
    fn one_failing_row_fails_the_study() {
        let information = Row::new("a", "", Some(f64::NAN));
        let holds = Row::new("b", "", Some(1.0)).within(1.0, 0.0);
        let fails = Row::new("c", "", None).within(1.0, 1.0);
        assert!(all_hold(&[]));
        assert!(all_hold(&[information.clone(), holds.clone()]));
        assert!(!all_hold(&[information, fails, holds]));
    }

    #[test]
    fn names_are_unique() {
        for (k, study) in studies().enumerate() {
            assert!(studies().take(k).all(|other| other.id != study.id));
        }
    }
}
