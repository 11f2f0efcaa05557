//! Errors of graphics processors.

use pericles::units::quantity;
use pericles::{DeviceError, PericlesError};

/// Errors of graphics processors.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GpuError {
    /// No adapter.
    #[error(
        "no graphics processor was found; install a driver with Vulkan, Metal or Direct3D 12 (`pericles devices` lists what is found), or run without --device"
    )]
    NoAdapter,
    /// An adapter that does not exist.
    #[error("there is no graphics processor {number}; allowed: 0 to {} (`pericles devices` lists them)", count - 1)]
    NoSuchAdapter {
        /// The number given.
        number: usize,
        /// Number of adapters.
        count: usize,
    },
    /// A precision that the adapter lacks.
    #[error("{adapter} does not compute in double precision; allowed: precision \"mixed\"")]
    NoDoubles {
        /// Name of the adapter.
        adapter: String,
    },
    /// A part of the run that devices do not compute.
    #[error(
        "this run is not possible on a graphics processor: {reason}; change the deck, or use --device cpu"
    )]
    NotSupported {
        /// What it is.
        reason: &'static str,
    },
    /// More memory than the device has, or than one array may have.
    #[error("the body needs {} of memory of {adapter}, in arrays of up to {}; {reason}", quantity(*.bytes as f64, "B"), quantity(*.largest as f64, "B"))]
    Memory {
        /// Name of the adapter.
        adapter: String,
        /// Memory of all arrays, bytes.
        bytes: u64,
        /// Memory of the largest array, bytes.
        largest: u64,
        /// What is exceeded.
        reason: String,
    },
    /// The driver has failed.
    #[error(
        "{adapter} has failed: {reason}; resume the run from its last checkpoint, on this device or without --device"
    )]
    Lost {
        /// Name of the adapter.
        adapter: String,
        /// The message of the driver.
        reason: String,
    },
}

impl From<GpuError> for PericlesError {
    fn from(error: GpuError) -> Self {
        let text = error.to_string();
        let error = match error {
            GpuError::NoAdapter | GpuError::NoSuchAdapter { .. } | GpuError::NoDoubles { .. } => {
                DeviceError::Missing(text)
            }
            GpuError::NotSupported { .. } => DeviceError::Unsuitable(text),
            GpuError::Memory { .. } => DeviceError::Memory(text),
            GpuError::Lost { .. } => DeviceError::Failed(text),
        };
        error.into()
    }
}
