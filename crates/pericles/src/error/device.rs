//! Errors of processors beside that of the host.

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
