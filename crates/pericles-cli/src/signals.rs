//! Handling of Ctrl-C, SIGTERM, SIGHUP (closed terminal) and SIGUSR1 (batch systems): the first signal stops the run
//! with a checkpoint, the second one ends the process immediately.
//!
//! If SIGHUP is ignored when the program starts, as under `nohup`, it stays ignored.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use pericles_run::{Cancel, Ending};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1};
use signal_hook::flag;

use crate::exit::Exit;

/// Signals that stop a run with a checkpoint, and the exit statuses.
const STOPPING: [(i32, Exit); 4] = [
    (SIGINT, Exit::Interrupted),
    (SIGTERM, Exit::Terminated),
    (SIGHUP, Exit::HungUp),
    (SIGUSR1, Exit::Warned),
];

/// Returns whether a signal is ignored according to `/proc`; false where this is not available.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

/// The signals received so far.
#[derive(Debug, Default)]
pub(crate) struct Signals {
    /// Cancelled with the number of the last signal as the reason.
    cancel: Cancel,
}

impl Signals {
    /// Installs the handlers for the lifetime of the process.
    ///
    /// # Errors
    /// The system does not allow it.
    pub(crate) fn watch() -> std::io::Result<Self> {
        let signals = Self::default();
        let asked = Arc::new(AtomicBool::new(false));
        for (signal, exit) in STOPPING {
            if signal == SIGHUP && is_ignored(SIGHUP) {
                continue;
            }
            // The order matters: at the first signal `asked` is unset, at the second one set.
            let status = i32::from(exit.status());
            flag::register_conditional_shutdown(signal, status, Arc::clone(&asked))?;
            flag::register(signal, Arc::clone(&asked))?;
            let number = usize::try_from(signal).unwrap_or_default();
            flag::register_usize(signal, signals.cancel.flag(), number)?;
        }
        Ok(signals)
    }

    /// Returns the flag that stops a run.
    pub(crate) fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    /// Returns the exit status for the end of a run.
    pub(crate) fn exit_of(&self, ending: Ending) -> Exit {
        match ending {
            Ending::Finished => Exit::Done,
            Ending::Cancelled => self.asked().unwrap_or(Exit::StoppedEarly),
            Ending::Deadline => Exit::StoppedEarly,
        }
    }

    /// Returns the exit status of the last signal, if there was one.
    pub(crate) fn asked(&self) -> Option<Exit> {
        let last = i32::try_from(self.cancel.reason()?.get()).unwrap_or_default();
        let asked = STOPPING.iter().find(|(signal, _)| *signal == last);
        asked.map(|(_, exit)| *exit)
    }
}
