//! Collective decisions: every process gets the same result.
//!
//! Every condition that leads to a message or ends a run is a maximum or an exact sum over all processes: signals,
//! time limits and checkpoints at the ends of steps, errors of observers, causes of instability. An error of another
//! process is [`PericlesError::OnAnotherProcess`], which is not printed.

use super::{Comm, Domain};
use crate::error::PericlesError;

/// Returns whether a condition holds on all processes. All processes must call it together.
pub fn all(comm: &dyn Comm, holds: bool) -> bool {
    let mut flag = [f64::from(u8::from(!holds))];
    comm.max(&mut flag);
    flag[0] == 0.0
}

/// Returns the result of this process, or the error `elsewhere()` if only another process has failed: all processes then stop at
/// the same place, and none of them waits for messages of another one. All processes must call it together.
///
/// # Errors
/// The own error, and `elsewhere()`.
pub fn agreed<T, E>(
    comm: &dyn Comm,
    result: Result<T, E>,
    elsewhere: impl FnOnce() -> E,
) -> Result<T, E> {
    match (all(comm, result.is_ok()), result) {
        (false, Ok(_)) => Err(elsewhere()),
        (_, result) => result,
    }
}

impl Domain {
    /// Returns whether a condition holds on all processes. All processes must call it together.
    pub fn all(&self, holds: bool) -> bool {
        all(&*self.comm, holds)
    }

    /// Returns the result of this process, or an error if only another process has failed; see [`agreed`]. All processes must call
    /// it together.
    ///
    /// # Errors
    /// The own error, and [`PericlesError::OnAnotherProcess`].
    pub fn agreed<T, E: From<PericlesError>>(&self, result: Result<T, E>) -> Result<T, E> {
        agreed(&*self.comm, result, || {
            PericlesError::OnAnotherProcess.into()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Threads;

    #[test]
    fn an_error_of_one_process_is_an_error_of_all() {
        let found = Threads::run(3, |comm| {
            let own = match comm.rank() {
                1 => Err("own"),
                rank => Ok(rank),
            };
            let agreed = |own| agreed(&*comm, own, || "of another process");
            [agreed(own), agreed(Ok(comm.rank()))]
        });
        let other = "of another process";
        assert_eq!(
            found,
            [
                [Err(other), Ok(0)],
                [Err("own"), Ok(1)],
                [Err(other), Ok(2)]
            ]
        );
    }
}
