//! `run` and `resume`: a simulation in its folder, from a first step to its end or to a signal.

use std::cell::Cell;
use std::path::Path;
use std::time::Instant;

use pericles::{Control, Interrupt, Outcome, Saved, Simulation, SimulationError};
use pericles_deck::{Deck, Model};
use pericles_io::{IoError, OutputFolder, PvdSeries, VtuFile};

use crate::animations;
use crate::args::{ResumeArgs, RunArgs};
use crate::charts;
use crate::checkpoint::{Checkpoints, DeckText, Stored};
use crate::console;
use crate::deadline::Deadline;
use crate::error::CliError;
use crate::exit::Exit;
use crate::given;
use crate::plot::TextChart;
use crate::prepare::{self, Facts, Means};
use crate::progress::Progress;
use crate::report::{Audit, Report, Start, Status};
use crate::signals::Signals;
use crate::summary;
use crate::sweep;
use crate::units::{count, quantity};
use crate::watch::Breakage;

/// Runs a deck.
///
/// # Errors
/// A deck that is refused, output that cannot be written, an unstable run.
pub(crate) fn run(args: &RunArgs) -> Result<Exit, CliError> {
    if !args.sweep.is_empty() {
        return sweep::run(args);
    }
    let deadline = Deadline::from_now(args.options.limits.wall_time);
    args.options.execution.threads.start()?;
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let text = DeckText::of(&deck, args.deck.display().to_string());
    let quiet = args.options.execution.quiet;
    if !quiet {
        console::note(format_args!("{}: building the model", text.file));
    }
    // The folder is made once nothing in the deck can be wrong any more.
    let modelled = modelled(&deck, &args.options.means())?;
    let folder = output_folder(args.out.as_deref(), Some(args.force), &args.deck, "")?;
    let session = Session::begun(&deck, text, modelled, folder, quiet)?;
    let session = session.with_chart(args.chart);
    session.drive(deadline, &Signals::watch().map_err(CliError::Signals)?)
}

/// Goes on with a run from its last checkpoint.
///
/// # Errors
/// No usable checkpoint, and what can go wrong with a run.
pub(crate) fn resume(args: &ResumeArgs) -> Result<Exit, CliError> {
    if sweep::is_sweep(&args.dir) {
        return sweep::resume(args);
    }
    let deadline = Deadline::from_now(args.options.limits.wall_time);
    args.options.execution.threads.start()?;
    let quiet = args.options.execution.quiet;
    match Session::resumed(&args.dir, &args.options.means(), quiet)? {
        Some(session) => session
            .with_chart(args.chart)
            .drive(deadline, &Signals::watch().map_err(CliError::Signals)?),
        None => {
            if !quiet {
                let path = args.dir.display();
                console::print(format_args!(
                    "{path}: the run has finished; nothing to resume"
                ))?;
            }
            Ok(Exit::Done)
        }
    }
}

/// The model of a deck with the facts about it.
///
/// # Errors
/// A deck that is refused.
pub(crate) fn modelled(deck: &Deck, means: &Means<'_>) -> Result<(Model, Facts), CliError> {
    let model = prepare::model(deck, means)?;
    let facts = Facts::of(deck, &model);
    Ok((model, facts))
}

/// The folder asked for; without one the first free of `./<deck's name><suffix>`, the same with `-2`, `-3` …
///
/// # Errors
/// A folder that exists, unless `force` lets its results be replaced; one that cannot be made.
pub(crate) fn output_folder(
    out: Option<&Path>,
    force: Option<bool>,
    deck: &Path,
    suffix: &str,
) -> Result<OutputFolder, CliError> {
    let help = match force {
        Some(_) => "choose another --out, or replace the results in it with --force",
        None => "choose another --out, or move the folder away",
    };
    let Some(path) = out else {
        let mut name = deck.file_stem().unwrap_or("run".as_ref()).to_owned();
        name.push(suffix);
        return Ok(OutputFolder::create_numbered(Path::new(".").join(name))?);
    };
    OutputFolder::create(path, force.unwrap_or(false)).map_err(|error| match error {
        IoError::FolderExists { path } => CliError::OutExists { path, help },
        other => other.into(),
    })
}

/// Whether `run.json` says so. A report that cannot be read says nothing: the checkpoints decide.
fn is_finished(folder: &OutputFolder) -> bool {
    let status = || -> Option<String> {
        let text = std::fs::read_to_string(folder.file("run.json")).ok()?;
        let report: serde_json::Value = serde_json::from_str(&text).ok()?;
        Some(report.get("status")?.as_str()?.to_owned())
    };
    status().as_deref() == Some("finished")
}

/// What may make a resumed run differ from an uninterrupted one.
fn doubts(stored: &Stored, deck: &Deck, facts: &Facts) -> Vec<String> {
    let mut doubts: Vec<String> = stored
        .refused
        .iter()
        .map(|error| format!("{error}; the checkpoint before it is used"))
        .collect();
    let metadata = &stored.metadata;
    let version = env!("CARGO_PKG_VERSION");
    if metadata.version != version {
        doubts.push(format!(
            "the run was begun by version {} and goes on with version {version}: it may not be the same bit for bit",
            metadata.version
        ));
    }
    if metadata.instruction_set != facts.instruction_set {
        doubts.push(format!(
            "the run was begun with instruction set {} and goes on with {}: it may not be the same bit for bit",
            metadata.instruction_set, facts.instruction_set
        ));
    }
    let files = deck.files();
    if let (Some(file), true) = (files.first(), metadata.deck.inputs.is_empty()) {
        let file = file.display();
        doubts.push(format!(
            "the version that began the run did not record the content of {file}: whether it has changed since is not known"
        ));
    }
    doubts
}

/// Field files that the series lists and that are missing or cut short. The run needs none of them to go on, but its results lack them.
///
/// # Errors
/// A series that cannot be read.
fn incomplete(folder: &OutputFolder) -> Result<Option<String>, CliError> {
    let series = folder.file("fields.pvd");
    if !series.exists() {
        return Ok(None);
    }
    let states = PvdSeries::read(&series)?;
    let broken: Vec<_> = (states.iter())
        .filter(|(_, file)| !VtuFile::is_whole(folder.file(file)))
        .collect();
    Ok(broken.first().map(|(time, first)| {
        format!(
            "{} of the {} field files of the run so far are missing or cut short, the first of them {} at t = {}: the series will have gaps there",
            broken.len(),
            states.len(),
            first.display(),
            quantity(*time, "s")
        )
    }))
}

/// A run in its folder.
pub(crate) struct Session {
    simulation: Simulation,
    start: Start,
    checkpoints: Checkpoints,
    report: Report,
    folder: OutputFolder,
    quiet: bool,
    chart: bool,
}

impl Session {
    /// The same, with its histories drawn at the end if so.
    fn with_chart(mut self, chart: bool) -> Self {
        self.chart = chart;
        self
    }

    /// A run at its start.
    ///
    /// # Errors
    /// Sub-folders that cannot be made.
    pub(crate) fn begun(
        deck: &Deck,
        text: DeckText,
        (model, facts): (Model, Facts),
        folder: OutputFolder,
        quiet: bool,
    ) -> Result<Self, CliError> {
        let simulation = prepare::simulation(deck, model, &folder)?;
        Ok(Self {
            checkpoints: Checkpoints::new(&folder, deck.checkpoint, text.clone()),
            start: Start::of(&simulation),
            simulation,
            report: Report::new(deck, text, facts, 0),
            folder,
            quiet,
            chart: false,
        })
    }

    /// A run at its last checkpoint; none if it has finished.
    ///
    /// # Errors
    /// No usable checkpoint, one that does not go with its deck.
    pub(crate) fn resumed(
        path: &Path,
        means: &Means<'_>,
        quiet: bool,
    ) -> Result<Option<Self>, CliError> {
        if path.is_dir() && !path.join("checkpoints").is_dir() {
            return Err(CliError::NoRun { path: path.into() });
        }
        let folder = OutputFolder::open(path)?;
        if is_finished(&folder) {
            return Ok(None);
        }
        let stored = Stored::latest(&folder, means.memory)?;
        let deck = stored.metadata.deck.read()?;
        let (model, mut facts) = modelled(&deck, means)?;
        facts.warnings.extend(doubts(&stored, &deck, &facts));
        facts.warnings.extend(incomplete(&folder)?);
        let mut simulation = prepare::simulation(&deck, model, &folder)?;
        // The state is still that of the start.
        let start = Start::of(&simulation);
        simulation
            .restore(&stored.archive)
            .map_err(|error| CliError::Checkpoint {
                path: stored.path.clone(),
                reason: error.to_string(),
            })?;
        let step = simulation.state().step;
        if !quiet {
            let path = folder.path().display();
            let (steps, t) = (count(simulation.steps()), simulation.state().t);
            let step = count(step);
            console::note(format_args!(
                "{path}: going on from step {step} of {steps}, t = {}",
                quantity(t, "s")
            ));
        }
        let text = stored.metadata.deck;
        let checkpoints = Checkpoints::new(&folder, deck.checkpoint, text.clone());
        checkpoints.forget_failed();
        Ok(Some(Self {
            checkpoints,
            start,
            simulation,
            report: Report::new(&deck, text, facts, step),
            folder,
            quiet,
            chart: false,
        }))
    }

    /// Runs to the end, to a signal or close to the deadline.
    ///
    /// # Errors
    /// Output that cannot be written, an unstable run.
    pub(crate) fn drive(
        mut self,
        deadline: Option<Deadline>,
        signals: &Signals,
    ) -> Result<Exit, CliError> {
        if !self.quiet {
            for warning in &self.report.model.warnings {
                console::note(format_args!("warning: {warning}"));
            }
            summary::opening(&self.report, self.folder.path());
        }
        self.report.write(&self.folder.file("run.json"))?;
        let began = Instant::now();
        let ended = self.integrate(deadline, signals);
        self.report
            .note_progress(&self.simulation, began.elapsed().as_secs_f64());
        let outcome = match ended {
            Ok(outcome) => outcome,
            Err(error) => {
                self.report.status = Status::Failed;
                self.report.error = Some(error.to_string());
                // The first error is the one to report; on a full disk this one fails for the same reason.
                let _ = self.report.write(&self.folder.file("run.json"));
                return Err(error);
            }
        };
        self.close(outcome, signals)
    }

    fn integrate(
        &mut self,
        mut deadline: Option<Deadline>,
        signals: &Signals,
    ) -> Result<Outcome, CliError> {
        if self.simulation.state().step == 0 {
            self.checkpoints.write(&self.simulation)?;
        }
        let (first, steps) = (self.simulation.state().step, self.simulation.steps());
        let mut progress = Progress::new(self.quiet, first, steps);
        let checkpoints = &mut self.checkpoints;
        if let Some(deadline) = &mut deadline {
            deadline.begin();
        }
        let mut trouble = None;
        let mut breakage = Breakage::from(&self.simulation);
        let (warnings, quiet) = (&mut self.report.model.warnings, self.quiet);
        let cost = Cell::new(checkpoints.cost());
        let end = deadline.as_ref().map(Deadline::end);
        // Asked within steps that iterate, which may take longer than any other part of a run.
        let is_over = || {
            let late = |end: Instant| Instant::now() + 2 * cost.get() >= end;
            signals.asked().is_some() || end.is_some_and(late)
        };
        let interrupt = Interrupt::when(&is_over);
        let outcome = self.simulation.run_interruptible(interrupt, |simulation| {
            let state = simulation.state();
            progress.step(state.step, state.t);
            if let Some(warning) = breakage.look(simulation) {
                if !quiet {
                    progress.note(format_args!("warning: {warning}"));
                }
                warnings.push(warning);
            }
            let late = |deadline: &mut Deadline| deadline.is_near(checkpoints.cost());
            if signals.asked().is_some() || deadline.as_mut().is_some_and(late) {
                return Control::Stop;
            }
            if checkpoints.is_due(simulation)
                && let Err(error) = checkpoints.write(simulation)
            {
                trouble = Some(error);
                return Control::Stop;
            }
            cost.set(checkpoints.cost());
            Control::Continue
        });
        progress.finish();
        if let Some(error) = trouble {
            return Err(error);
        }
        let outcome = outcome.map_err(|error| self.sorted(error))?;
        if outcome == Outcome::Stopped {
            self.checkpoints.write(&self.simulation)?;
        }
        Ok(outcome)
    }

    /// The failure of the run, with what is left of it.
    fn sorted(&self, error: SimulationError) -> CliError {
        CliError::of_run(error, || {
            let mut left = match self.checkpoints.write_failed(&self.simulation) {
                Ok(path) => format!("the failing state is in {}", path.display()),
                Err(error) => format!("the failing state could not be kept ({error})"),
            };
            if let Some(step) = self.checkpoints.last_step() {
                let folder = self.folder.path().display();
                left += &format!(
                    "; the last good checkpoint, from which `pericles resume {folder}` would go on, is that of step {step}"
                );
            }
            left
        })
    }

    fn close(mut self, outcome: Outcome, signals: &Signals) -> Result<Exit, CliError> {
        let history = self.folder.file("history.csv");
        let mut audit = Audit::of(&self.simulation, &self.start, &history, &self.report)?;
        audit
            .warnings
            .extend(animations::gaps(&self.folder.file("pictures")));
        self.report.audit = Some(audit);
        self.report.stop_reason = self.simulation.stop_reason().map(ToString::to_string);
        let exit = match outcome {
            Outcome::Finished => {
                self.report.status = Status::Finished;
                Exit::Done
            }
            Outcome::Stopped => {
                self.report.status = Status::Stopped;
                signals.asked().unwrap_or(Exit::StoppedEarly)
            }
        };
        self.report.write(&self.folder.file("run.json"))?;
        if !self.quiet {
            summary::closing(&self.report, self.folder.path())?;
        }
        if self.chart {
            let charts = charts::of_table(&self.folder.file("history.csv"), |_| true)?;
            for chart in &charts {
                console::print(format_args!("{}", TextChart::of(chart)))?;
            }
        }
        Ok(exit)
    }
}
