//! Errors of bodies divided among processes.

use pericles::domain::Domain;
use pericles::{PericlesError, Result};

/// Returns the result of this process, or an error if another process has failed: all processes then stop at the same
/// place, and none of them waits for messages of another one. All processes must call it together.
pub(crate) fn agreed<T>(domain: &Domain, result: Result<T>) -> Result<T> {
    match (domain.all(result.is_ok()), result) {
        (false, Ok(_)) => Err(PericlesError::OnAnotherProcess),
        (_, result) => result,
    }
}
