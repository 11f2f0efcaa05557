//! Processors that compute whole steps.

use std::fmt;

use super::Integrator;
use crate::error::Result;
use crate::system::System;

/// A processor beside that of the host which computes whole steps, such as a graphics processor.
pub trait Device: fmt::Debug + Send + Sync {
    /// Returns the scheme whose steps the device computes, for steps of length `dt` (s) and a system whose loads, constraints and
    /// boundaries are complete, and what the run needs.
    ///
    /// # Errors
    /// The device does not compute the run, has too little memory, or fails.
    fn prepare(
        &self,
        system: &System,
        integrator: &dyn Integrator,
        dt: f64,
    ) -> Result<(Box<dyn Integrator>, DevicePlan)>;
}

/// What a run on a device needs.
#[derive(Debug, Clone, PartialEq)]
pub struct DevicePlan {
    /// Name of the device.
    pub name: String,
    /// Interface to its driver.
    pub interface: String,
    /// Precision of the steps.
    pub precision: &'static str,
    /// Reason for this precision.
    pub reason: &'static str,
    /// Memory of the device, bytes.
    pub memory: u64,
}
