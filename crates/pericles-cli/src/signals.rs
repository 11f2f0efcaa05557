//! Ctrl-C and SIGTERM: the first asks the run to stop between two steps, the second ends the process at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use crate::exit::Exit;

/// What has been asked for so far.
#[derive(Debug, Default)]
pub(crate) struct Signals {
    last: Arc<AtomicUsize>,
}

impl Signals {
    /// Takes the signals over for the rest of the process's life.
    ///
    /// # Errors
    /// The system refuses.
    pub(crate) fn watch() -> std::io::Result<Self> {
        let signals = Self::default();
        let asked = Arc::new(AtomicBool::new(false));
        for (signal, exit) in [(SIGINT, Exit::Interrupted), (SIGTERM, Exit::Terminated)] {
            // In this order: the first signal finds `asked` unset, the second one set.
            let status = i32::from(exit.status());
            flag::register_conditional_shutdown(signal, status, Arc::clone(&asked))?;
            flag::register(signal, Arc::clone(&asked))?;
            let number = usize::try_from(signal).unwrap_or_default();
            flag::register_usize(signal, Arc::clone(&signals.last), number)?;
        }
        Ok(signals)
    }

    /// How the program is to end, if it was asked to.
    pub(crate) fn asked(&self) -> Option<Exit> {
        let last = i32::try_from(self.last.load(Ordering::Relaxed)).unwrap_or_default();
        match last {
            SIGINT => Some(Exit::Interrupted),
            SIGTERM => Some(Exit::Terminated),
            _ => None,
        }
    }
}
