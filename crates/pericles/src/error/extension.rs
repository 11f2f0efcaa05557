//! Errors of extension crates.

use super::PericlesError;

impl PericlesError {
    /// Returns the error of an extension crate if it has type `E`.
    pub fn extension<E: std::error::Error + 'static>(&self) -> Option<&E> {
        match self {
            Self::Extension(error) => error.downcast_ref(),
            _ => None,
        }
    }
}
