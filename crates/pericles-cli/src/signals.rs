//! Ctrl-C, SIGTERM, SIGHUP (a closed terminal) and SIGUSR1 (the warning of batch systems): the first asks the run to stop, the second ends the process at once.
//!
//! A SIGHUP that is ignored when the program starts, as under `nohup`, stays ignored.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use pericles_run::{Cancel, Ending};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1};
use signal_hook::flag;

use crate::exit::Exit;

/// Signals that stop a run with a checkpoint, and how the program then ends.
const STOPPING: [(i32, Exit); 4] = [
    (SIGINT, Exit::Interrupted),
    (SIGTERM, Exit::Terminated),
    (SIGHUP, Exit::HungUp),
    (SIGUSR1, Exit::Warned),
];

/// Whether a signal is ignored, as the kernel reports it; false where it does not.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

/// What has been asked for so far.
#[derive(Debug, Default)]
pub(crate) struct Signals {
    /// Cancelled for the number of the last signal.
    cancel: Cancel,
}

impl Signals {
    /// Takes the signals over for the rest of the process's life.
    ///
    /// # Errors
    /// The system refuses.
    pub(crate) fn watch() -> std::io::Result<Self> {
        let signals = Self::default();
        let asked = Arc::new(AtomicBool::new(false));
        for (signal, exit) in STOPPING {
            if signal == SIGHUP && is_ignored(SIGHUP) {
                continue;
            }
            // In this order: the first signal finds `asked` unset, the second one set.
            let status = i32::from(exit.status());
            flag::register_conditional_shutdown(signal, status, Arc::clone(&asked))?;
            flag::register(signal, Arc::clone(&asked))?;
            let number = usize::try_from(signal).unwrap_or_default();
            flag::register_usize(signal, signals.cancel.flag(), number)?;
        }
        Ok(signals)
    }

    /// What tells a run of them.
    pub(crate) fn cancel(&self) -> &Cancel {
        &self.cancel
    }

    /// The exit status that a run leads to.
    pub(crate) fn exit_of(&self, ending: Ending) -> Exit {
        match ending {
            Ending::Finished => Exit::Done,
            Ending::Cancelled => self.asked().unwrap_or(Exit::StoppedEarly),
            Ending::Deadline => Exit::StoppedEarly,
        }
    }

    /// How the program is to end, if it was asked to.
    pub(crate) fn asked(&self) -> Option<Exit> {
        let last = i32::try_from(self.cancel.reason()?.get()).unwrap_or_default();
        let asked = STOPPING.iter().find(|(signal, _)| *signal == last);
        asked.map(|(_, exit)| *exit)
    }
}
