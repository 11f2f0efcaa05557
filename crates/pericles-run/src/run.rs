//! Runs: start, resume, drive to the end, report.

use std::cell::{Cell, RefCell};
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use pericles::observe::{Observer, Schedule};
use pericles::{Archive, Checkpointed, Control, Interrupt, Outcome, Simulation, SimulationError};
use pericles_io::observers::History;
use pericles_io::{CheckpointFolder, OutputFolder, PvdSeries, VtuFile};

use crate::animations;
use crate::assembled::{Assembled, Means};
use crate::audit::{Audit, Start};
use crate::body_record::BodyRecord;
use crate::cancel::Cancel;
use crate::checkpoint::{Checkpoints, Stored};
use crate::deadline::Deadline;
use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::event::{Event, Tell};
use crate::extension::extended;
use crate::facts::Facts;
use crate::observers::{self, Observed};
use crate::origin::Origin;
use crate::processes::{agreed, any, on_first, shared_folder};
use crate::report::{Report, Status};
use crate::sharing::Sharing;
use crate::source::{Source, SourceRecord};
use crate::units::quantity;
use crate::watch::{self, Breakage};

/// A run with its output folder.
pub struct Run {
    simulation: Simulation,
    history: Arc<Mutex<History>>,
    start: Start,
    checkpoints: Checkpoints,
    report: Report,
    folder: OutputFolder,
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// The last step, or a stop condition of the model, was reached.
    Finished,
    /// The run was cancelled; it can be resumed.
    Cancelled,
    /// The run stopped before its deadline with a checkpoint; it can be resumed.
    Deadline,
}

impl Run {
    /// Creates a run at its start with the output of its model. `source`, from which `assembled` was built, is stored
    /// in `run.json` and checkpoints.
    ///
    /// # Errors
    /// Subfolders cannot be created, or files of an earlier run cannot be replaced.
    pub fn begin(
        source: &Source,
        assembled: Assembled,
        folder: OutputFolder,
    ) -> Result<Self, RunError> {
        let Assembled { assembly, facts } = assembled;
        let model = source.model();
        let comm = Arc::clone(assembly.system.domain().comm());
        let body = BodyRecord::of(&assembly.system, assembly.precut_bonds);
        let origin = assembly.origin.clone();
        let observed = observers::observed(model, assembly, &folder);
        let Observed {
            simulation,
            history,
        } = agreed(&*comm, observed)?;
        let kept = match (origin, comm.rank()) {
            (Some((origin, _)), 0) => Origin::keep(&origin, &folder),
            _ => Ok(()),
        };
        agreed(&*comm, kept)?;
        Ok(Self {
            checkpoints: Checkpoints::new(&folder, model.checkpoint, source.record(), body),
            start: Start::of(&simulation),
            simulation,
            history,
            report: Report::new(source, facts, 0),
            folder,
        })
    }

    /// Restores a run from its last checkpoint; `None` if it has finished.
    ///
    /// # Errors
    /// There is no usable checkpoint, or it does not match its deck.
    pub fn resume(path: &Path, means: &Means, tell: Tell<'_>) -> Result<Option<Self>, RunError> {
        Self::extend(path, &[], means, tell)
    }

    /// Restores a run from its last checkpoint with another end, given by the override `time.end=VALUE`; without changes
    /// as [`Run::resume`].
    ///
    /// # Errors
    /// There is no usable checkpoint, it does not match its deck, or the run cannot be extended in this way.
    pub fn extend(
        path: &Path,
        changes: &[String],
        means: &Means,
        tell: Tell<'_>,
    ) -> Result<Option<Self>, RunError> {
        let comm = &*means.comm;
        let words = |folder: &Option<OutputFolder>| match folder {
            Some(_) => "unfinished".to_owned(),
            None => String::new(),
        };
        let (folder, unfinished) = on_first(comm, || opened(path, !changes.is_empty()), words)?;
        if unfinished.is_empty() {
            return Ok(None);
        }
        let folder = folder.flatten();
        let folder = folder.unwrap_or_else(|| OutputFolder::following(path));
        let stored = Stored::latest(&folder, means.memory, comm)?;
        let origin = Origin::of_run(&folder, means.memory, comm)?;
        let source = extended(&stored.metadata, changes).and_then(SourceRecord::read);
        let source = agreed(comm, source)?;
        let model = source.model();
        let Assembled {
            assembly,
            mut facts,
        } = Assembled::starting(&source, origin.as_ref().into(), means, tell)?;
        let is_first = comm.rank() == 0;
        if is_first {
            facts.warnings.extend(resume_warnings(&stored, &facts));
        }
        let gaps = match is_first {
            true => incomplete(&folder),
            false => Ok(None),
        };
        facts.warnings.extend(agreed(comm, gaps)?);
        let warnings = stored.metadata.warnings.clone();
        facts.warnings.extend(warnings.iter().cloned());
        let body = BodyRecord::of(&assembly.system, assembly.precut_bonds);
        let observed = observers::observed(model, assembly, &folder);
        let Observed {
            mut simulation,
            history,
        } = agreed(comm, observed)?;
        // The state is still the initial state.
        let start = Start::of(&simulation);
        stored.restore(&mut simulation)?;
        let step = simulation.state().step;
        let mut checkpoints = Checkpoints::new(&folder, model.checkpoint, source.record(), body);
        warnings.into_iter().for_each(|one| checkpoints.warn(one));
        if is_first {
            checkpoints.forget_failed();
        }
        Ok(Some(Self {
            checkpoints,
            start,
            simulation,
            history,
            report: Report::new(&source, facts, step),
            folder,
        }))
    }

    /// Resumes the run of a deck in a folder, or begins it, from the state of the run `from` if that is given; `None` if it
    /// has finished. A run that was killed before its first checkpoint begins again. All processes must call it together.
    ///
    /// # Errors
    /// Those of [`Assembled::starting`], [`Run::begin`] and [`Run::resume`].
    pub(crate) fn resume_or_begin(
        path: &Path,
        deck: &DeckText,
        from: Option<&Path>,
        means: &Means,
        tell: Tell<'_>,
    ) -> Result<Option<Self>, RunError> {
        let comm = &*means.comm;
        let checkpoints = CheckpointFolder::new(path.join("checkpoints"));
        let has_begun = || Ok::<_, RunError>(checkpoints.steps().is_ok_and(|all| !all.is_empty()));
        let (_, word) = on_first(comm, has_begun, bool::to_string)?;
        if word == "true" {
            return Self::resume(path, means, tell);
        }
        let source = SourceRecord::Deck(deck.clone()).read()?;
        let open = |from: &Path| Origin::open(from, means.memory, comm);
        let origin = from.map(open).transpose()?;
        let assembled = Assembled::starting(&source, origin.as_ref().into(), means, tell)?;
        let create = || Ok::<_, RunError>(OutputFolder::create(path, path.exists())?);
        let folder = shared_folder(comm, create)?;
        Self::begin(&source, assembled, folder).map(Some)
    }

    /// Returns the simulation.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// Adds an observer of the program to those of the model. It is saved in checkpoints after them, so that a run with
    /// further observers is resumed with the same ones.
    pub fn observe(&mut self, schedule: Schedule, observer: Box<dyn Observer>) {
        self.simulation.observe(schedule, observer);
    }

    /// Replaces the state of the simulation by the state of a checkpoint of the same run.
    ///
    /// # Errors
    /// The archive does not match the run.
    pub fn restore(&mut self, archive: &Archive) -> Result<(), RunError> {
        Ok(self.simulation.restore(archive)?)
    }

    /// Returns the content of `run.json`.
    pub fn report(&self) -> &Report {
        &self.report
    }

    /// Returns the output folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Runs until the end, cancellation or the deadline, and writes checkpoints and `run.json`. A stopped run may be
    /// driven again.
    ///
    /// # Errors
    /// Output cannot be written, or the run becomes unstable.
    pub fn drive(
        &mut self,
        deadline: Option<Deadline>,
        cancel: &Cancel,
        tell: Tell<'_>,
    ) -> Result<Ending, RunError> {
        self.report.begin_session(self.simulation.state().step);
        tell(Event::Opening {
            report: &self.report,
            folder: self.folder.path(),
        });
        self.write_agreed_report()?;
        let comm = Arc::clone(self.simulation.system().domain().comm());
        let (began, waited) = (Instant::now(), comm.waited());
        let ended = self.integrate(deadline, cancel, tell);
        let (seconds, waited) = (began.elapsed().as_secs_f64(), comm.waited() - waited);
        self.report.note_progress(&self.simulation, seconds);
        match ended {
            Ok(outcome) => {
                let domain = self.simulation.system().domain();
                self.report.sharing = Sharing::of(domain, seconds, waited);
                self.close(outcome, cancel)
            }
            Err(error) => {
                self.report.status = Status::Failed;
                self.report.error = Some(error.to_string());
                // The first error is reported; on a full disk this write fails for the same reason.
                let _ = self.write_report();
                Err(error)
            }
        }
    }

    fn write_report(&self) -> Result<(), RunError> {
        let domain = self.simulation.system().domain();
        match domain.is_first() {
            true => self.report.write(&self.folder.file("run.json")),
            false => Ok(()),
        }
    }

    /// Writes the report, or returns an error if this fails on any process.
    fn write_agreed_report(&self) -> Result<(), RunError> {
        agreed(
            &**self.simulation.system().domain().comm(),
            self.write_report(),
        )
    }

    fn integrate(
        &mut self,
        mut deadline: Option<Deadline>,
        cancel: &Cancel,
        tell: Tell<'_>,
    ) -> Result<Outcome, RunError> {
        let first = self.simulation.state().step;
        if first == 0 {
            self.checkpoints.write(&self.simulation)?;
        }
        tell(Event::LoopBegins {
            first,
            steps: self.simulation.steps(),
        });
        let checkpoints = &mut self.checkpoints;
        if let Some(deadline) = &mut deadline {
            deadline.begin();
        }
        let mut trouble = None;
        let mut warned = false;
        let mut breakage = Breakage::new(&self.simulation, !checkpoints.warnings().is_empty());
        let warnings = &mut self.report.model.warnings;
        let cost = Cell::new(checkpoints.cost());
        let end = deadline.as_ref().map(Deadline::end);
        // Checked within iterative steps, which may take longer than any other part of a run.
        // All processes stop together.
        let comm = Arc::clone(self.simulation.system().domain().comm());
        let any = |holds: bool| any(&*comm, holds);
        let is_over = || {
            let late = |end: Instant| Instant::now() + 2 * cost.get() >= end;
            any(cancel.is_cancelled() || end.is_some_and(late))
        };
        let tell = RefCell::new(tell);
        let tell = |event: Event<'_>| (*tell.borrow_mut())(event);
        let follow = |progress| tell(Event::Iteration(progress));
        let interrupt = Interrupt::when(&is_over).following(&follow);
        let outcome = self.simulation.run_interruptible(interrupt, |simulation| {
            let state = simulation.state();
            if let (Some(found), false) = (simulation.instability(), warned) {
                warned = true;
                tell(Event::Warning(&found.to_string()));
            }
            tell(Event::Step {
                step: state.step,
                t: state.t,
            });
            if let Some(warning) = breakage.look(simulation) {
                tell(Event::Warning(&warning));
                checkpoints.warn(warning.clone());
                warnings.push(warning);
            }
            let late = |deadline: &mut Deadline| deadline.is_near(checkpoints.cost());
            if any(cancel.is_cancelled() || deadline.as_mut().is_some_and(late)) {
                return Control::Stop;
            }
            // The clock of the first process decides.
            let due = comm.rank() == 0 && checkpoints.is_due(simulation);
            if any(due)
                && let Err(error) = checkpoints.write(simulation)
            {
                trouble = Some(error);
                return Control::Stop;
            }
            cost.set(checkpoints.cost());
            Control::Continue
        });
        tell(Event::LoopEnds);
        if let Some(error) = trouble {
            return Err(error);
        }
        let outcome = outcome.map_err(|error| self.sorted(error))?;
        // Also at the end, because another run may start from it.
        self.checkpoints.write(&self.simulation)?;
        Ok(outcome)
    }

    /// Converts an error of the simulation, and saves the failed state.
    fn sorted(&self, error: SimulationError) -> RunError {
        RunError::of_run(error, || {
            let mut left = match self.checkpoints.write_failed(&self.simulation) {
                Ok(path) => format!("the failed state is in {}", path.display()),
                Err(error) => format!("the failed state could not be saved ({error})"),
            };
            if self.simulation.integrator().is_static() {
                left += "; it is the last state of the field files and pictures";
            }
            if let Some(step) = self.checkpoints.last_step() {
                let folder = self.folder.path().display();
                left += &format!(
                    "; `pericles resume {folder}` continues from the last regular checkpoint, at step {step}"
                );
            }
            left
        })
    }

    fn close(&mut self, outcome: Outcome, cancel: &Cancel) -> Result<Ending, RunError> {
        let domain = self.simulation.system().domain();
        let history = self.history.lock().unwrap_or_else(PoisonError::into_inner);
        let largest_balance = history.largest_balance();
        drop(history);
        let model = &self.report.model;
        let mut audit = Audit::of(&self.simulation, &self.start, largest_balance, model);
        audit.warnings = watch::warnings(&self.simulation, &audit);
        if domain.is_first() {
            let gaps = animations::gaps(&self.folder.file("pictures"));
            audit.warnings.extend(gaps);
        }
        self.report.audit = Some(audit);
        self.report.stop_reason = self.simulation.stop_reason().map(ToString::to_string);
        let comm = self.simulation.system().domain().comm();
        let cancelled = any(&**comm, cancel.is_cancelled());
        let ending = match outcome {
            Outcome::Finished => Ending::Finished,
            Outcome::Stopped if cancelled => Ending::Cancelled,
            Outcome::Stopped => Ending::Deadline,
        };
        self.report.status = match ending {
            Ending::Finished => Status::Finished,
            Ending::Cancelled | Ending::Deadline => Status::Stopped,
        };
        self.write_agreed_report()?;
        Ok(ending)
    }
}

/// Opens the folder of a run; `None` if it has finished and is not extended.
fn opened(path: &Path, is_extended: bool) -> Result<Option<OutputFolder>, RunError> {
    if path.is_dir() && !path.join("checkpoints").is_dir() {
        return Err(RunError::NoRun { path: path.into() });
    }
    let folder = OutputFolder::open(path)?;
    Ok((is_extended || !is_finished(&folder)).then_some(folder))
}

/// Returns whether the run has finished according to `run.json`. If it cannot be read, the checkpoints decide.
fn is_finished(folder: &OutputFolder) -> bool {
    let status = || -> Option<String> {
        let text = std::fs::read_to_string(folder.file("run.json")).ok()?;
        let report: serde_json::Value = serde_json::from_str(&text).ok()?;
        Some(report.get("status")?.as_str()?.to_owned())
    };
    status().as_deref() == Some("finished")
}

/// Returns warnings about differences between a resumed and an uninterrupted run.
fn resume_warnings(stored: &Stored, facts: &Facts) -> Vec<String> {
    let mut warnings: Vec<String> = stored
        .rejected
        .iter()
        .map(|error| format!("{error}; the previous checkpoint is used"))
        .collect();
    let metadata = &stored.metadata;
    let version = env!("CARGO_PKG_VERSION");
    if metadata.version != version {
        warnings.push(format!(
            "the run was started with version {} and is resumed with version {version}: results may not be bitwise identical",
            metadata.version
        ));
    }
    let instruction_set = facts.text("instruction_set");
    if metadata.instruction_set != instruction_set {
        warnings.push(format!(
            "the run was started with instruction set {} and is resumed with {instruction_set}: results may not be bitwise identical",
            metadata.instruction_set
        ));
    }
    warnings
}

/// Returns a warning about missing or truncated field files. The run does not need them, but its results have gaps.
///
/// # Errors
/// The series cannot be read.
fn incomplete(folder: &OutputFolder) -> Result<Option<String>, RunError> {
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
            "{} of the {} field files written so far are missing or truncated, first {} at t = {}: the series has gaps there",
            broken.len(),
            states.len(),
            first.display(),
            quantity(*time, "s")
        )
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_can_be_sent_to_another_thread() {
        fn is_send<T: Send>() {}
        is_send::<Simulation>();
        is_send::<Run>();
    }
}
