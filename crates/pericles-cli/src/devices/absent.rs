//! The place of graphics processors in programs built without them.

use std::sync::Arc;

use pericles_deck::Processor;
use pericles_run::{Devices, RunError, no_devices};

use crate::args::{BenchArgs, DevicesArgs};
use crate::error::CliError;
use crate::exit::Exit;

/// There are no graphics processors.
pub(crate) fn devices() -> Option<Arc<dyn Devices>> {
    None
}

/// There are no graphics processors to list.
pub(crate) fn list(_args: &DevicesArgs) -> Result<Exit, CliError> {
    Err(RunError::from(no_devices()).into())
}

/// There are no graphics processors to measure.
pub(crate) fn bench(_args: &BenchArgs, _wanted: Processor) -> Result<Exit, CliError> {
    Err(RunError::from(no_devices()).into())
}
