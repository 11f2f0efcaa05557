//! Graphics processors of the machine.

use std::sync::{Arc, Mutex, PoisonError};

use crate::error::GpuError;
use crate::precision::Precision;

/// A graphics processor of the machine.
#[derive(Debug, Clone)]
pub struct Adapter {
    inner: wgpu::Adapter,
    /// Name, such as that of the card.
    pub name: String,
    /// Interface to the driver, such as Vulkan.
    pub interface: String,
    /// Kind of processor.
    pub kind: &'static str,
    /// Version of the driver.
    pub driver: String,
    /// Whether it computes in double precision.
    pub has_doubles: bool,
    /// Largest array, bytes.
    pub largest_array: u64,
}

/// An opened device.
#[derive(Debug, Clone)]
pub(crate) struct Context {
    pub adapter: String,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub precision: Precision,
    pub largest_array: u64,
    /// The message of a driver that has failed.
    failure: Arc<Mutex<Option<String>>>,
}

/// Bindings of the shaders that are arrays.
pub(crate) const ARRAYS: u32 = 12;

/// Returns the graphics processors of the machine, in the order of their numbers: hardware before software.
pub fn adapters() -> Vec<Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        flags: wgpu::InstanceFlags::empty(),
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let found = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let mut adapters: Vec<Adapter> = found.into_iter().filter_map(Adapter::new).collect();
    adapters.sort_by_key(|adapter| rank(adapter.inner.get_info().device_type));
    adapters
}

fn rank(kind: wgpu::DeviceType) -> u32 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Cpu => 3,
        wgpu::DeviceType::Other => 4,
    }
}

/// Returns an adapter by its number; the first one without a number.
///
/// # Errors
/// No adapter, or none with this number.
pub fn adapter(number: Option<usize>) -> Result<Adapter, GpuError> {
    let mut adapters = adapters();
    let count = adapters.len();
    match number.unwrap_or(0) {
        _ if count == 0 => Err(GpuError::NoAdapter),
        number if number < count => Ok(adapters.swap_remove(number)),
        number => Err(GpuError::NoSuchAdapter { number, count }),
    }
}

impl Adapter {
    /// Returns `None` for adapters without compute shaders or with fewer arrays than the shaders need.
    fn new(inner: wgpu::Adapter) -> Option<Self> {
        let (info, limits) = (inner.get_info(), inner.limits());
        if limits.max_storage_buffers_per_shader_stage < ARRAYS {
            return None;
        }
        Some(Self {
            name: info.name.clone(),
            interface: info.backend.to_string(),
            kind: match info.device_type {
                wgpu::DeviceType::DiscreteGpu => "card",
                wgpu::DeviceType::IntegratedGpu => "integrated",
                wgpu::DeviceType::VirtualGpu => "virtual",
                wgpu::DeviceType::Cpu => "software",
                wgpu::DeviceType::Other => "unknown",
            },
            driver: format!("{} {}", info.driver, info.driver_info),
            has_doubles: inner.features().contains(wgpu::Features::SHADER_F64),
            largest_array: limits
                .max_buffer_size
                .min(limits.max_storage_buffer_binding_size),
            inner,
        })
    }

    /// Opens the device, by default in the highest precision.
    pub(crate) fn open(&self, precision: Option<Precision>) -> Result<Context, GpuError> {
        let precision = match (precision, self.has_doubles) {
            (Some(Precision::Double), false) => {
                return Err(GpuError::NoDoubles {
                    adapter: self.name.clone(),
                });
            }
            (Some(precision), _) => precision,
            (None, true) => Precision::Double,
            (None, false) => Precision::Mixed,
        };
        let features = match precision {
            Precision::Double => wgpu::Features::SHADER_F64,
            Precision::Mixed => wgpu::Features::empty(),
        };
        let opened = pollster::block_on(self.inner.request_device(&wgpu::DeviceDescriptor {
            label: Some("pericles"),
            required_features: features,
            required_limits: self.inner.limits(),
            ..wgpu::DeviceDescriptor::default()
        }));
        let (device, queue) = opened.map_err(|error| self.lost(error.to_string()))?;
        let failure = Arc::new(Mutex::new(None));
        let note = |failure: &Arc<Mutex<Option<String>>>, reason: String| {
            let mut failure = failure.lock().unwrap_or_else(PoisonError::into_inner);
            failure.get_or_insert(reason);
        };
        let of_error = Arc::clone(&failure);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            note(&of_error, error.to_string());
        }));
        let of_loss = Arc::clone(&failure);
        device.set_device_lost_callback(move |_, reason| note(&of_loss, reason));
        Ok(Context {
            adapter: self.name.clone(),
            largest_array: self.largest_array,
            device,
            queue,
            precision,
            failure,
        })
    }

    fn lost(&self, reason: String) -> GpuError {
        GpuError::Lost {
            adapter: self.name.clone(),
            reason,
        }
    }
}

impl Context {
    /// Fails if the driver has reported an error.
    pub(crate) fn check(&self) -> Result<(), GpuError> {
        let failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        match &*failure {
            None => Ok(()),
            Some(reason) => Err(self.lost(reason)),
        }
    }

    pub(crate) fn lost(&self, reason: &impl ToString) -> GpuError {
        GpuError::Lost {
            adapter: self.adapter.clone(),
            reason: reason.to_string(),
        }
    }

    /// Waits until the device has finished its work.
    pub(crate) fn wait(&self) -> Result<(), GpuError> {
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        waited.map_err(|error| self.lost(&error))?;
        self.check()
    }
}
