//! `reproduce`: recompute published results and compare.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::time::Instant;

use pericles_io::OutputFolder;
use pericles_run::units::duration;
use pericles_studies::{Agreement, Context, Row, Study, all_hold, find, studies, table};
use serde::Serialize;

use crate::args::ReproduceArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::screen::Screen;

/// The JSON output.
#[derive(Serialize)]
struct Results<'a> {
    study: &'a str,
    paper: &'a str,
    rows: &'a [Row],
    pass: bool,
    seconds: f64,
}

/// Runs a study, or lists all of them.
///
/// # Errors
/// The study is unknown, output cannot be written, or a run fails.
pub(crate) fn reproduce(args: &ReproduceArgs) -> Result<Exit, CliError> {
    let Some(id) = &args.id else {
        return list();
    };
    let study = find(id)?;
    args.execution.threads.start()?;
    let json_only = args.json.as_deref() == Some(Path::new("-"));
    // Created first, so that a long study does not fail at the end.
    let folder = match &args.out {
        Some(path) => Some(OutputFolder::create(path, false)?),
        None if json_only => None,
        None => Some(OutputFolder::create_numbered(default_folder(id))?),
    };
    let quiet = args.execution.quiet;
    let screen = RefCell::new(Screen::new(quiet));
    let context = Context {
        full: args.full,
        figures: folder.as_ref().map(OutputFolder::path),
        tell: &|event| screen.borrow_mut().show(event),
    };
    if !quiet {
        console::note(format_args!("{}: {}", study.id, study.title));
    }
    let began = Instant::now();
    let rows = study.run(&context)?;
    let seconds = began.elapsed().as_secs_f64();
    let pass = all_hold(&rows);
    if let Some(path) = &args.json {
        let results = Results {
            study: study.id,
            paper: study.paper,
            rows: &rows,
            pass,
            seconds,
        };
        console::write_json(path, &results)?;
    }
    if !quiet && !json_only {
        console::print(format_args!("{} ({})\n", study.title, study.paper))?;
        console::print(format_args!("{}", table(&rows)))?;
        let judged = rows.iter().filter_map(Row::pass).count();
        let failed = rows.iter().filter(|row| row.pass() == Some(false)).count();
        let with = |agreement| {
            let rows = rows.iter().filter(|row| row.agreement() == Some(agreement));
            rows.count()
        };
        let [inside, partly, outside] =
            [Agreement::Inside, Agreement::Partly, Agreement::Outside].map(with);
        let compared = inside + partly + outside;
        let comparison = match compared {
            0 => String::new(),
            _ => format!(
                "of {compared} rows compared with measurements {inside} are inside and {partly} partly inside; "
            ),
        };
        console::print(format_args!(
            "{comparison}{} of {judged} judged rows pass; {}",
            judged - failed,
            duration(seconds)
        ))?;
    }
    if let (Some(folder), false, false) = (&folder, quiet, json_only) {
        let path = folder.path().display();
        console::print(format_args!("Figures in {path}"))?;
    }
    Ok(if pass { Exit::Done } else { Exit::Comparison })
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

fn default_folder(id: &str) -> PathBuf {
    format!("./reproduce-{}", id.replace('/', "-")).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn study_names_map_to_single_folders() {
        for study in studies() {
            let folder = default_folder(study.id);
            assert_eq!(folder.components().count(), 2, "{}", folder.display());
        }
    }
}
