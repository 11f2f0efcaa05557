//! Stopping a step that is under way.

use std::fmt;

use crate::error::{PericlesError, Result};

/// A request to stop, polled in the inner iterations of schemes and solvers.
///
/// The library does not catch signals and knows no clock: the caller supplies a closure that returns true once the run is to stop. A step that finds it true fails
/// with [`PericlesError::Interrupted`]; [`Simulation::run_interruptible`](crate::Simulation::run_interruptible) then returns to the last complete step.
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
    /// No request, ever.
    pub const fn never() -> Self {
        Self { asked: None }
    }

    /// A request once `asked` returns true. It is called once per inner iteration and should take no longer than reading a flag and a clock.
    pub fn when(asked: &'a dyn Fn() -> bool) -> Self {
        Self { asked: Some(asked) }
    }

    /// Whether a request can ever come.
    pub fn is_possible(&self) -> bool {
        self.asked.is_some()
    }

    /// Returns an error if the run is to stop.
    ///
    /// # Errors
    /// [`PericlesError::Interrupted`] if so.
    pub fn poll(&self) -> Result<()> {
        match self.asked {
            Some(asked) if asked() => Err(PericlesError::Interrupted),
            _ => Ok(()),
        }
    }
}
