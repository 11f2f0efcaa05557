//! Interrupting and following a step.

use std::fmt;

use crate::error::{PericlesError, Result};

/// A request to stop, polled in the inner iterations of schemes and solvers.
///
/// The engine catches no signals and reads no clock: the caller supplies a closure that returns true when the run
/// is to stop. The step then fails with [`PericlesError::Interrupted`], and
/// [`Simulation::run_interruptible`](crate::Simulation::run_interruptible) returns to the last complete step.
///
/// ```
/// use std::cell::Cell;
/// use pericles::Interrupt;
/// let asked = Cell::new(false);
/// let is_asked = || asked.get();
/// let interrupt = Interrupt::when(&is_asked);
/// assert!(interrupt.poll().is_ok());
/// asked.set(true);
/// assert!(interrupt.poll().is_err());
/// assert!(Interrupt::never().poll().is_ok());
/// ```
#[derive(Clone, Copy, Default)]
pub struct Interrupt<'a> {
    asked: Option<&'a dyn Fn() -> bool>,
    follow: Option<&'a dyn Fn(IterationProgress)>,
}

/// How far a step that iterates is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IterationProgress {
    /// Iterations made for the present state of the step.
    pub iteration: u64,
    /// Relative residual.
    pub residual: f64,
    /// Relative residual at which the step is done.
    pub tolerance: f64,
    /// Evaluations of the force or its tangent within the step so far.
    pub evaluations: u64,
}

impl fmt::Debug for Interrupt<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let form = if self.is_possible() {
            "when asked"
        } else {
            "never"
        };
        write!(f, "Interrupt({form})")
    }
}

impl<'a> Interrupt<'a> {
    /// An interrupt that never requests a stop.
    pub const fn never() -> Self {
        Self {
            asked: None,
            follow: None,
        }
    }

    /// An interrupt that requests a stop when `asked` returns true. `asked` is called once per inner iteration and
    /// should not cost more than reading a flag and a clock.
    pub fn when(asked: &'a dyn Fn() -> bool) -> Self {
        Self {
            asked: Some(asked),
            ..Self::never()
        }
    }

    /// The same; `follow` is called with the progress of schemes that report their iterations, and must not change what they compute.
    pub fn following(self, follow: &'a dyn Fn(IterationProgress)) -> Self {
        Self {
            follow: Some(follow),
            ..self
        }
    }

    /// Reports an iteration to whoever follows the step.
    pub fn report(&self, progress: IterationProgress) {
        if let Some(follow) = self.follow {
            follow(progress);
        }
    }

    /// Returns whether a request is possible.
    pub fn is_possible(&self) -> bool {
        self.asked.is_some()
    }

    /// Returns an error if a stop is requested.
    ///
    /// # Errors
    /// [`PericlesError::Interrupted`].
    pub fn poll(&self) -> Result<()> {
        match self.asked {
            Some(asked) if asked() => Err(PericlesError::Interrupted),
            _ => Ok(()),
        }
    }
}
