//! How the program ends: one status per kind of ending.

use std::process::ExitCode;

/// Exit statuses. Scripts may rely on them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Exit {
    Done = 0,
    Internal = 1,
    Usage = 2,
    Input = 3,
    Numerical = 4,
    Comparison = 5,
    Output = 6,
    StoppedEarly = 7,
    Memory = 8,
    HungUp = 129,
    Interrupted = 130,
    Warned = 138,
    Terminated = 143,
}

impl Exit {
    /// All statuses in the order of their numbers.
    const ALL: [Self; 13] = [
        Self::Done,
        Self::Internal,
        Self::Usage,
        Self::Input,
        Self::Numerical,
        Self::Comparison,
        Self::Output,
        Self::StoppedEarly,
        Self::Memory,
        Self::HungUp,
        Self::Interrupted,
        Self::Warned,
        Self::Terminated,
    ];

    /// The number the shell sees.
    pub(crate) fn status(self) -> u8 {
        self as u8
    }

    fn meaning(self) -> &'static str {
        match self {
            Self::Done => "done",
            Self::Internal => "internal error: a bug in Pericles",
            Self::Usage => "wrong command line, or an unknown study",
            Self::Input => "the deck or another input is refused",
            Self::Numerical => "numerical stop: the run became unstable",
            Self::Comparison => "a comparison failed (reproduce, diff)",
            Self::Output => "the output cannot be written, is full or in use",
            Self::StoppedEarly => "stopped early at a limit, with a checkpoint",
            Self::Memory => {
                "more memory would be needed than there is, or than --max-memory allows"
            }
            Self::Interrupted => "Ctrl-C, with a checkpoint (a second one ends at once)",
            Self::HungUp => "SIGHUP (the terminal was closed), with a checkpoint",
            Self::Warned => "SIGUSR1 (such as the warning of a batch system), with a checkpoint",
            Self::Terminated => "SIGTERM, with a checkpoint",
        }
    }

    /// The table for the help page.
    pub(crate) fn table() -> String {
        let mut table = String::from("Exit status:\n");
        for exit in Self::ALL {
            table += &format!("  {:>3}  {}\n", exit.status(), exit.meaning());
        }
        table
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        ExitCode::from(exit.status())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_help_page_lists_every_status_once() {
        let table = Exit::table();
        for status in [0, 1, 2, 3, 4, 5, 6, 7, 8, 129, 130, 138, 143] {
            let line = format!("\n  {status:>3}  ");
            assert_eq!(table.matches(&line).count(), 1, "{status}");
        }
    }
}
