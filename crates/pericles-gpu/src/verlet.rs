//! Velocity Verlet on a graphics processor.

use pericles::archive::{Archive, Checkpointed};
use pericles::time::{Device as Processor, DevicePlan, Integrator, State, VelocityVerlet};
use pericles::{Interrupt, PericlesError, StepKind, System};

use crate::adapter::{Adapter, Context};
use crate::batch::Device;
use crate::body::Body;
use crate::error::GpuError;
use crate::limits::supported;
use crate::precision::{Precision, Units};

/// Largest number of steps of a batch: the state is read by the host after each batch.
const STEPS: usize = 100;

/// A graphics processor for runs.
#[derive(Debug, Clone)]
pub struct Gpu {
    adapter: Adapter,
    context: Context,
    chosen: bool,
}

impl Gpu {
    /// Opens an adapter in a precision, by default in the highest.
    ///
    /// # Errors
    /// An adapter without this precision, or a driver that fails.
    pub fn open(adapter: &Adapter, precision: Option<Precision>) -> Result<Self, GpuError> {
        Ok(Self {
            context: adapter.open(precision)?,
            adapter: adapter.clone(),
            chosen: precision.is_some(),
        })
    }

    /// Returns the precision.
    pub fn precision(&self) -> Precision {
        self.context.precision
    }

    /// Returns the adapter.
    pub fn adapter(&self) -> &Adapter {
        &self.adapter
    }

    /// Prepares the device for a system in batches of up to `steps` steps.
    pub(crate) fn device(
        &self,
        system: &System,
        integrator: &dyn Integrator,
        (dt, steps): (f64, usize),
    ) -> Result<Device, GpuError> {
        let data = supported(system, integrator)?;
        let units = Units::new(self.context.precision, system.cloud().spacing(), dt);
        let body = Body::new(system, &data, units);
        Device::new(self.context.clone(), system, body, steps)
    }
}

impl Processor for Gpu {
    fn prepare(
        &self,
        system: &System,
        integrator: &dyn Integrator,
        dt: f64,
    ) -> Result<(Box<dyn Integrator>, DevicePlan), PericlesError> {
        let device = self.device(system, integrator, (dt, STEPS))?;
        let plan = DevicePlan {
            name: self.adapter.name.clone(),
            interface: self.adapter.interface.clone(),
            precision: self.context.precision.name(),
            reason: match (self.context.precision, self.chosen) {
                (_, true) => "chosen",
                (Precision::Double, false) => "the device computes in double precision",
                (Precision::Mixed, false) => "the device does not compute in double precision",
            },
            memory: device.bytes(),
        };
        Ok((Box::new(DeviceVerlet { device }), plan))
    }
}

/// Velocity Verlet whose steps a device computes in batches. Steps that are too long for bonds that break in them are computed
/// by [`VelocityVerlet`].
struct DeviceVerlet {
    device: Device,
}

impl Integrator for DeviceVerlet {
    fn name(&self) -> &'static str {
        VelocityVerlet.name()
    }

    fn step_kind(&self) -> StepKind {
        VelocityVerlet.step_kind()
    }

    fn order(&self) -> u32 {
        VelocityVerlet.order()
    }

    fn stability_limit(&self) -> Option<f64> {
        VelocityVerlet.stability_limit()
    }

    fn energy_correction(&self, system: &System, state: &State, dt: f64) -> f64 {
        VelocityVerlet.energy_correction(system, state, dt)
    }

    fn steps_at_once(&self) -> u64 {
        STEPS as u64
    }

    fn advance(
        &mut self,
        system: &mut System,
        state: &mut State,
        (dt, steps): (f64, u64),
        interrupt: Interrupt<'_>,
    ) -> Result<(), PericlesError> {
        match self.device.advance(system, state, dt, steps)? {
            0 => self.step(system, state, (state.step + 1) as f64 * dt, interrupt),
            _ => Ok(()),
        }
    }

    /// One step of the host.
    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<(), PericlesError> {
        self.device.forget();
        VelocityVerlet.step(system, state, t_next, interrupt)
    }
}

/// Everything that a step changes is in the state and the system.
impl Checkpointed for DeviceVerlet {
    fn save(&self, archive: &mut Archive) {
        VelocityVerlet.save(archive);
    }

    fn restore(&mut self, archive: &Archive) -> Result<(), PericlesError> {
        self.device.forget();
        VelocityVerlet.restore(archive)
    }
}
