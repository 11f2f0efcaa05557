//! Terminal output during a run.

use pericles_run::Event;

use crate::console;
use crate::progress::Progress;
use crate::summary;

/// Shows the events of a run on standard error.
pub(crate) struct Screen {
    quiet: bool,
    silent: bool,
    progress: Option<Progress>,
}

impl Screen {
    /// Creates the display of one run; in quiet mode only notes about the cache are shown.
    pub(crate) fn new(quiet: bool) -> Self {
        Self {
            quiet,
            silent: false,
            progress: None,
        }
    }

    /// Creates the display of a run that several processes share: the first one shows it.
    pub(crate) fn shared(quiet: bool, first: bool) -> Self {
        Self {
            silent: !first,
            ..Self::new(quiet)
        }
    }

    /// Shows an event.
    pub(crate) fn show(&mut self, event: Event<'_>) {
        match event {
            _ if self.silent => {}
            Event::CacheNote(note) => console::note(format_args!("{note}")),
            _ if self.quiet => {}
            Event::Opening { report, folder } => {
                for warning in &report.model.warnings {
                    console::note(format_args!("warning: {warning}"));
                }
                summary::opening(report, folder);
            }
            Event::LoopBegins { first, steps } => {
                self.progress = Some(Progress::new(first, steps));
            }
            Event::Step { step, t } => {
                if let Some(progress) = &mut self.progress {
                    progress.step(step, t);
                }
            }
            Event::Iteration(iteration) => {
                if let Some(progress) = &mut self.progress {
                    progress.iteration(iteration);
                }
            }
            Event::Warning(warning) => match &self.progress {
                Some(progress) => progress.note(format_args!("warning: {warning}")),
                None => console::note(format_args!("warning: {warning}")),
            },
            Event::LoopEnds => {
                if let Some(progress) = self.progress.take() {
                    progress.finish();
                }
            }
            _ => {}
        }
    }
}
