//! Errors of extension crates and of processors beside that of the host.

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

/// An error of a processor that computes whole steps, such as a graphics processor.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum DeviceError {
    /// There is no such processor.
    #[error("{0}")]
    Missing(String),
    /// It does not compute the run.
    #[error("{0}")]
    Unsuitable(String),
    /// It has too little memory.
    #[error("{0}")]
    Memory(String),
    /// It has failed.
    #[error("{0}")]
    Failed(String),
}

impl From<DeviceError> for PericlesError {
    fn from(error: DeviceError) -> Self {
        Self::Extension(Box::new(error))
    }
}
