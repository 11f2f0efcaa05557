//! Ceilings of a device: arithmetic and memory traffic.

use std::time::Instant;

use crate::adapter::{Adapter, Context};
use crate::error::GpuError;
use crate::precision::Precision;

/// What a device does at most, measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ceilings {
    /// Products with sums (two operations each) per second in double precision; `None` without it.
    pub doubles: Option<f64>,
    /// The same in single precision.
    pub floats: f64,
    /// Bytes read and written per second by a copy.
    pub copied: f64,
}

/// Invocations of the loops of products.
const INVOCATIONS: u32 = 1 << 16;
/// Independent chains of products in an invocation.
const CHAINS: u32 = 8;
/// Numbers of four bytes that are copied.
const COPIED: u32 = 1 << 24;
/// Shortest time of a measurement, s.
const LONG: f64 = 0.02;

impl Adapter {
    /// Measures the ceilings.
    ///
    /// # Errors
    /// The driver fails.
    pub fn ceilings(&self) -> Result<Ceilings, GpuError> {
        let products = |precision| {
            let context = self.open(Some(precision))?;
            let real = match precision {
                Precision::Double => "f64",
                Precision::Mixed => "f32",
            };
            let (one, small) = (precision.literal(1.0), precision.literal(1e-7));
            let text = format!(
                "@group(0) @binding(0) var<storage, read_write> numbers: array<{real}>;\n\
                 @group(0) @binding(1) var<storage, read_write> count: array<u32>;\n\
                 @compute @workgroup_size(256)\n\
                 fn run(@builtin(global_invocation_id) id: vec3<u32>) {{\n\
                 {starts}\
                 let factor = {one} - {small} * {real}(id.x);\n\
                 for (var k = 0u; k < count[0]; k++) {{\n{chains}}}\n\
                 numbers[id.x] = {sum};\n}}\n",
                starts = list(|c| format!("var x{c} = {real}(id.x + {c}u);\n"), ""),
                chains = list(|c| format!("x{c} = fma(x{c}, factor, {small});\n"), ""),
                sum = list(|c| format!("x{c}"), " + "),
            );
            let bytes = u64::from(INVOCATIONS) * precision.bytes_of_real() as u64;
            let per_count = f64::from(INVOCATIONS) * f64::from(CHAINS);
            Ok::<_, GpuError>(rate(&context, &text, bytes, INVOCATIONS)? * per_count)
        };
        let context = self.open(Some(Precision::Mixed))?;
        let half = COPIED / 2;
        let text = format!(
            "@group(0) @binding(0) var<storage, read_write> numbers: array<u32>;\n\
             @group(0) @binding(1) var<storage, read_write> count: array<u32>;\n\
             @compute @workgroup_size(256)\n\
             fn run(@builtin(global_invocation_id) id: vec3<u32>) {{\n\
             let threads = {INVOCATIONS}u;\n\
             for (var k = 0u; k < count[0]; k++) {{\n\
             for (var i = id.x; i < {half}u; i += threads) {{ numbers[{half}u + i] = numbers[i] + k; }}\n\
             }}\n}}\n"
        );
        let copies = rate(&context, &text, 4 * u64::from(COPIED), INVOCATIONS)?;
        Ok(Ceilings {
            doubles: match self.has_doubles {
                true => Some(products(Precision::Double)?),
                false => None,
            },
            floats: products(Precision::Mixed)?,
            copied: copies * 4.0 * f64::from(COPIED),
        })
    }
}

/// Returns text for each chain.
fn list(text: impl Fn(u32) -> String, between: &str) -> String {
    (0..CHAINS).map(text).collect::<Vec<_>>().join(between)
}

/// Returns the turns of a loop per second.
fn rate(context: &Context, text: &str, bytes: u64, invocations: u32) -> Result<f64, GpuError> {
    let device = &context.device;
    let buffer = |size: u64| {
        device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    };
    let (numbers, count) = (buffer(bytes), buffer(16));
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("run"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let buffers = [&numbers, &count];
    let entries = buffers
        .into_iter()
        .zip(0..)
        .map(|(buffer, binding)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        });
    let entries: Vec<wgpu::BindGroupEntry<'_>> = entries.collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let mut turns: u32 = 1;
    loop {
        context
            .queue
            .write_buffer(&count, 0, bytemuck::cast_slice(&[turns]));
        let mut best = f64::INFINITY;
        for _ in 0..3 {
            let mut encoder =
                device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            {
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
                pass.set_pipeline(&pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.dispatch_workgroups(invocations / 256, 1, 1);
            }
            let start = Instant::now();
            context.queue.submit([encoder.finish()]);
            context.wait()?;
            best = best.min(start.elapsed().as_secs_f64());
        }
        if best > LONG || turns > u32::MAX / 4 {
            return Ok(f64::from(turns) / best);
        }
        turns *= 4;
    }
}
