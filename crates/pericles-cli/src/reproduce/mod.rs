//! `reproduce`: studies of papers, computed again and compared with the published numbers.
//!
//! A [`Study`] is a function that computes rows; it knows nothing of files but the figures it may draw. Studies and their decks are inside the program,
//! so that they run from any directory. A row is judged if it has an expected number ([`row::Row`]); a printed number known not to reproduce is shown
//! beside the verified one that is judged, with the reason. The same studies are run by the tests.
//!
//! A new study is one file with a `STUDY`, listed in its topic's `STUDIES`; a new topic is listed in [`TOPICS`].

mod absorbing_boundaries;
mod dispersion;
mod fracture;
mod manifolds;
mod multi_time_step;
mod nonlocal_wave;
mod numerics;
mod row;
mod table;

use std::path::{Path, PathBuf};
use std::time::Instant;

use pericles_io::OutputFolder;
use pericles_run::RunError;
use pericles_run::units::duration;
use serde::Serialize;

use crate::args::ReproduceArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::progress::Progress;
use row::Row;

/// A study of a paper.
pub(crate) struct Study {
    /// Its name on the command line, `topic/name`.
    pub(crate) id: &'static str,
    /// The paper, short.
    pub(crate) paper: &'static str,
    /// What it shows.
    pub(crate) title: &'static str,
    /// Computes the rows and draws the figures.
    pub(crate) run: fn(&Context<'_>) -> Result<Vec<Row>, RunError>,
}

/// All studies, by topic.
const TOPICS: [&[Study]; 7] = [
    &absorbing_boundaries::STUDIES,
    &dispersion::STUDIES,
    &fracture::STUDIES,
    &manifolds::STUDIES,
    &multi_time_step::STUDIES,
    &nonlocal_wave::STUDIES,
    &numerics::STUDIES,
];

fn studies() -> impl Iterator<Item = &'static Study> {
    TOPICS.into_iter().flatten()
}

/// What a study is run with.
pub(crate) struct Context<'a> {
    /// Whether rows that take long are wanted.
    pub(crate) full: bool,
    /// Say nothing about progress.
    pub(crate) quiet: bool,
    figures: Option<&'a Path>,
}

impl Context<'_> {
    /// For tests.
    #[cfg(test)]
    pub(crate) fn without_figures() -> Self {
        Self {
            full: false,
            quiet: true,
            figures: None,
        }
    }

    /// A bar for a run of so many steps, unless the study is quiet.
    pub(crate) fn progress(&self, steps: u64) -> Option<Progress> {
        (!self.quiet).then(|| Progress::new(0, steps))
    }

    /// The file of a figure; none if no figures are wanted.
    pub(crate) fn figure(&self, name: &str) -> Option<PathBuf> {
        self.figures.map(|folder| folder.join(name))
    }
}

/// The results as JSON.
#[derive(Serialize)]
struct Results<'a> {
    study: &'a str,
    paper: &'a str,
    rows: &'a [Row],
    pass: bool,
    seconds: f64,
}

/// Runs a study, or lists all.
///
/// # Errors
/// An unknown study, output that cannot be written, and what can go wrong with a run.
pub(crate) fn reproduce(args: &ReproduceArgs) -> Result<Exit, CliError> {
    let Some(id) = &args.id else {
        return list();
    };
    let study = find(id)?;
    args.execution.threads.start()?;
    let json_only = args.json.as_deref() == Some(Path::new("-"));
    // Made first: nobody wants to wait for a study and lose its figures.
    let folder = match &args.out {
        Some(path) => Some(OutputFolder::create(path, false)?),
        None if json_only => None,
        None => Some(OutputFolder::create_numbered(default_folder(id))?),
    };
    let quiet = args.execution.quiet;
    let context = Context {
        full: args.full,
        quiet,
        figures: folder.as_ref().map(OutputFolder::path),
    };
    if !quiet {
        console::note(format_args!("{}: {}", study.id, study.title));
    }
    let began = Instant::now();
    let rows = (study.run)(&context)?;
    let seconds = began.elapsed().as_secs_f64();
    let exit = verdict(&rows);
    if let Some(path) = &args.json {
        let results = Results {
            study: study.id,
            paper: study.paper,
            rows: &rows,
            pass: exit == Exit::Done,
            seconds,
        };
        console::write_json(path, &results)?;
    }
    if !quiet && !json_only {
        console::print(format_args!("{} ({})\n", study.title, study.paper))?;
        console::print(format_args!("{}", table::table(&rows)))?;
        let judged = rows.iter().filter_map(Row::pass).count();
        let failed = rows.iter().filter(|row| row.pass() == Some(false)).count();
        console::print(format_args!(
            "{} of {judged} judged rows hold; {}",
            judged - failed,
            duration(seconds)
        ))?;
    }
    if let (Some(folder), false, false) = (&folder, quiet, json_only) {
        let path = folder.path().display();
        console::print(format_args!("figures in {path}"))?;
    }
    Ok(exit)
}

/// Done only if every judged row holds.
fn verdict(rows: &[Row]) -> Exit {
    if rows.iter().all(|row| row.pass() != Some(false)) {
        Exit::Done
    } else {
        Exit::Comparison
    }
}

fn list() -> Result<Exit, CliError> {
    let width = studies().map(|study| study.id.len()).max();
    for study in studies() {
        let Study {
            id, title, paper, ..
        } = study;
        let width = width.unwrap_or_default();
        console::print(format_args!("{id:<width$}  {title} ({paper})"))?;
    }
    Ok(Exit::Done)
}

fn find(id: &str) -> Result<&'static Study, RunError> {
    studies().find(|study| study.id == id).ok_or_else(|| {
        let all = "`pericles reproduce --list` shows all studies";
        RunError::unknown("study", id, studies().map(|study| study.id), all)
    })
}

fn default_folder(id: &str) -> PathBuf {
    format!("./reproduce-{}", id.replace('/', "-")).into()
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
        assert_eq!(verdict(&[]), Exit::Done);
        assert_eq!(verdict(&[information.clone(), holds.clone()]), Exit::Done);
        assert_eq!(verdict(&[information, fails, holds]), Exit::Comparison);
    }

    #[test]
    fn names_are_unique_and_make_folders() {
        for (k, study) in studies().enumerate() {
            assert!(studies().take(k).all(|other| other.id != study.id));
            let folder = default_folder(study.id);
            assert_eq!(folder.components().count(), 2, "{}", folder.display());
        }
    }
}
