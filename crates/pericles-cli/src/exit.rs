//! Exit statuses of the program.

/// Exit statuses; scripts may rely on them.
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
    Processes = 9,
    Device = 10,
    HungUp = 129,
    Interrupted = 130,
    Warned = 138,
    Terminated = 143,
}

impl Exit {
    /// All statuses in ascending order.
    const ALL: [Self; 15] = [
        Self::Done,
        Self::Internal,
        Self::Usage,
        Self::Input,
        Self::Numerical,
        Self::Comparison,
        Self::Output,
        Self::StoppedEarly,
        Self::Memory,
        Self::Processes,
        Self::Device,
        Self::HungUp,
        Self::Interrupted,
        Self::Warned,
        Self::Terminated,
    ];

    /// Returns the number that the shell receives.
    pub(crate) fn status(self) -> u8 {
        self as u8
    }

    fn meaning(self) -> &'static str {
        match self {
            Self::Done => "success",
            Self::Internal => "internal error: a bug in Pericles",
            Self::Usage => "invalid command line or unknown study",
            Self::Input => "invalid deck or other input",
            Self::Numerical => "numerical failure: the run became unstable",
            Self::Comparison => "comparison failed (reproduce, diff), or a fit has not converged",
            Self::Output => "output cannot be written: disk full, or folder exists or in use",
            Self::StoppedEarly => "stopped at the --wall-time limit, with a checkpoint",
            Self::Memory => "estimated memory exceeds --max-memory or the available memory",
            Self::Processes => {
                "several processes (mpirun, srun) without MPI support, or for a command of one process"
            }
            Self::Device => "no graphics processor (--device), or one that has failed",
            Self::Interrupted => "Ctrl-C, with a checkpoint (a second Ctrl-C exits immediately)",
            Self::HungUp => "SIGHUP (terminal closed), with a checkpoint",
            Self::Warned => "SIGUSR1 (for example from a batch system), with a checkpoint",
            Self::Terminated => "SIGTERM, with a checkpoint",
        }
    }

    /// Returns the table of exit statuses for the help text.
    pub(crate) fn table() -> String {
        let mut table = String::from("Exit status:\n");
        for exit in Self::ALL {
            table += &format!("  {:>3}  {}\n", exit.status(), exit.meaning());
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn help_lists_every_exit_status_once() {
        let table = Exit::table();
        for status in [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 129, 130, 138, 143] {
            let line = format!("\n  {status:>3}  ");
            assert_eq!(table.matches(&line).count(), 1, "{status}");
        }
    }
}
