//! Agreement between the processes that share a run: the first one reads and writes all files except checkpoints.

use std::path::PathBuf;

use pericles::PericlesError;
use pericles::domain::{self, Comm, all, distribute, text_message, text_of};
use pericles_io::OutputFolder;

use crate::error::RunError;

/// Calls `make` on the first process and returns its value there, with the message for all processes that `words` makes of it;
/// `None` and the message on the others. All processes must call it together.
///
/// # Errors
/// The error of the first process, and [`PericlesError::OnAnotherProcess`] on the others.
pub(crate) fn on_first<T, E: From<PericlesError>>(
    comm: &dyn Comm,
    make: impl FnOnce() -> Result<T, E>,
    words: impl FnOnce(&T) -> String,
) -> Result<(Option<T>, String), E> {
    let made = (comm.rank() == 0).then(make);
    // The first number states whether there was no error.
    let message = match &made {
        Some(Ok(made)) => {
            let text = text_message(&words(made));
            std::iter::once(1.0).chain(text).collect()
        }
        Some(Err(_)) => vec![0.0],
        None => Vec::new(),
    };
    let messages = made.as_ref().map(|_| vec![message; comm.size()]);
    let message = distribute(comm, messages);
    let made = made.transpose()?;
    if message.first() != Some(&1.0) {
        return Err(PericlesError::OnAnotherProcess.into());
    }
    Ok((made, text_of(&message[1..])))
}

/// Returns whether a condition holds on any process. All processes must call it together.
pub(crate) fn any(comm: &dyn Comm, holds: bool) -> bool {
    !all(comm, !holds)
}

/// Returns the result of this process, or an error if another process has failed. All processes must call it together.
///
/// # Errors
/// Own errors, and [`PericlesError::OnAnotherProcess`].
pub(crate) fn agreed<T, E: From<PericlesError>>(
    comm: &dyn Comm,
    result: Result<T, E>,
) -> Result<T, E> {
    domain::agreed(comm, result, || PericlesError::OnAnotherProcess.into())
}

/// Creates the output folder of a run on the first process, by `create`; the others follow it. All processes must call it
/// together.
///
/// # Errors
/// The errors of `create`, and [`PericlesError::OnAnotherProcess`] on the others.
pub fn shared_folder<E: From<PericlesError> + From<RunError>>(
    comm: &dyn Comm,
    create: impl FnOnce() -> Result<OutputFolder, E>,
) -> Result<OutputFolder, E> {
    let path = |folder: &OutputFolder| folder.path().display().to_string();
    let (folder, path) = on_first(comm, create, path)?;
    Ok(folder.unwrap_or_else(|| OutputFolder::following(PathBuf::from(path))))
}
