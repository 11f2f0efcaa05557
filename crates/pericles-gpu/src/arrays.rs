//! Arrays and pipelines of a body on a device.

use std::ops::Range;

use crate::adapter::{ARRAYS, Context};
use crate::body::Body;
use crate::entries::Entries;
use crate::error::GpuError;
use crate::shader;

/// Distance of the numbers of steps in their array, bytes; the largest alignment that devices need.
const STEP: u64 = 256;
/// Bytes of the numbers of a step.
const STEP_BYTES: u64 = 16;

/// The arrays by their bindings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Array {
    U,
    V,
    A,
    Bits,
    Lost,
    Control,
    Books,
    Pressures,
    Lists,
    Numbers,
    Amplitudes,
    Course,
}

impl Array {
    const ALL: [Self; ARRAYS as usize] = [
        Self::U,
        Self::V,
        Self::A,
        Self::Bits,
        Self::Lost,
        Self::Control,
        Self::Books,
        Self::Pressures,
        Self::Lists,
        Self::Numbers,
        Self::Amplitudes,
        Self::Course,
    ];

    fn is_written(self) -> bool {
        (self as usize) < Self::Lists as usize
    }
}

/// The shaders of a step.
struct Pipelines {
    force: wgpu::ComputePipeline,
    /// The pass over the points of a solid, and the images of its result.
    solid: Option<[wgpu::ComputePipeline; 2]>,
    turn: wgpu::ComputePipeline,
    guide: wgpu::ComputePipeline,
    load: wgpu::ComputePipeline,
    react: wgpu::ComputePipeline,
    damp: wgpu::ComputePipeline,
    repeat: wgpu::ComputePipeline,
}

/// The numbers of a step in the shaders.
#[derive(Debug, Clone, Copy)]
struct Now {
    number: u32,
    finish: u32,
    begin: u32,
}

/// Arrays and shaders of a body.
pub(crate) struct Arrays {
    context: Context,
    arrays: Vec<wgpu::Buffer>,
    pipelines: Pipelines,
    group: wgpu::BindGroup,
    now: wgpu::Buffer,
    /// Workgroups of loops over places.
    groups: [u32; 3],
    /// Loaded, constrained and damped components, and images.
    counts: [usize; 4],
    /// Largest number of steps of a batch.
    steps: usize,
    /// Steps of one submission.
    per_submission: usize,
}

/// Bonds that a device computes in one submission, so that drivers do not take a long one for a failure: 50 ms at ten thousand
/// million bonds per second.
const BONDS_PER_SUBMISSION: u64 = 500_000_000;

/// Returns the bytes of each array for batches of `steps` steps.
fn sizes(
    body: &Body,
    entries: &Entries,
    steps: usize,
    context: &Context,
) -> [u64; ARRAYS as usize] {
    let (state, real) = (8, context.precision.bytes_of_real());
    let lengths = |lists: Vec<usize>| lists.into_iter().sum::<usize>();
    let lists = entries.lists(body).into_iter().map(|(_, list)| list.len());
    let numbers = body.numbers().into_iter().map(|(_, list)| list.len());
    let amplitudes = entries.amplitudes().into_iter().map(|(_, list)| list.len());
    let bytes = [
        state * body.entries(),
        state * body.entries(),
        real * body.entries(),
        4 * body.words() * body.places,
        real * body.places,
        4,
        real * entries.books(),
        match body.is_solid() {
            true => real * (body.pitch() + body.margin),
            false => 0,
        },
        4 * lengths(lists.collect()),
        real * lengths(numbers.collect()),
        state * lengths(amplitudes.collect()),
        state * entries.columns() * steps,
    ];
    // Bindings must not be empty.
    bytes.map(|bytes| (bytes as u64).max(16))
}

impl Arrays {
    /// Allocates the arrays of a body and compiles its shaders.
    pub(crate) fn new(
        context: &Context,
        body: &Body,
        entries: &Entries,
        steps: usize,
    ) -> Result<Self, GpuError> {
        let sizes = sizes(body, entries, steps, context);
        let total = sizes.iter().sum::<u64>();
        let largest = sizes.iter().copied().max().unwrap_or(0);
        let memory = |reason: String| GpuError::Memory {
            adapter: context.adapter.clone(),
            bytes: total,
            largest,
            reason,
        };
        if largest > context.largest_array {
            let most = pericles::units::quantity(context.largest_array as f64, "B");
            return Err(memory(format!("its largest possible array has {most}")));
        }
        let device = &context.device;
        let scope = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let buffer = |size: u64, usage: wgpu::BufferUsages| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size,
                usage: usage | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            })
        };
        let arrays = sizes.map(|size| buffer(size, wgpu::BufferUsages::STORAGE));
        let now = buffer(STEP * (steps as u64 + 1), wgpu::BufferUsages::UNIFORM);
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(memory(error.to_string()));
        }
        let layout = layout(device);
        let mut bindings = vec![wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &now,
                offset: 0,
                size: wgpu::BufferSize::new(STEP_BYTES),
            }),
        }];
        bindings.extend(
            arrays
                .iter()
                .zip(1..)
                .map(|(array, binding)| wgpu::BindGroupEntry {
                    binding,
                    resource: array.as_entire_binding(),
                }),
        );
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &layout,
            entries: &bindings,
        });
        let text = shader::text(body, entries, context.precision);
        let pipelines = pipelines(device, &layout, text, body.is_solid());
        let sides = shader::group(body.dimension);
        let arrays = Self {
            groups: [0, 1, 2].map(|axis| (body.shape[axis] as u32).div_ceil(sides[axis])),
            counts: [
                entries.loaded(),
                entries.constrained(),
                entries.damped(),
                body.images.len(),
            ],
            arrays: arrays.to_vec(),
            pipelines,
            group,
            now,
            steps,
            per_submission: (BONDS_PER_SUBMISSION / body.directed_bonds.max(1)).max(1) as usize,
            context: context.clone(),
        };
        let lists: Vec<u32> = entries
            .lists(body)
            .into_iter()
            .flat_map(|(_, list)| list)
            .collect();
        arrays.write(Array::Lists, bytemuck::cast_slice(&lists));
        let precision = context.precision;
        let numbers: Vec<f64> = body
            .numbers()
            .into_iter()
            .flat_map(|(_, list)| list.to_vec())
            .collect();
        arrays.write(Array::Numbers, &precision.reals(&numbers));
        let amplitudes = entries
            .amplitudes()
            .into_iter()
            .flat_map(|(_, list)| list.to_vec());
        arrays.write(
            Array::Amplitudes,
            &precision.states(&amplitudes.collect::<Vec<_>>()),
        );
        context.wait()?;
        Ok(arrays)
    }

    fn of(&self, array: Array) -> &wgpu::Buffer {
        &self.arrays[array as usize]
    }

    /// Returns the memory of all arrays, bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.arrays.iter().map(wgpu::Buffer::size).sum()
    }

    /// Copies bytes to an array.
    pub(crate) fn write(&self, array: Array, bytes: &[u8]) {
        if !bytes.is_empty() {
            self.context.queue.write_buffer(self.of(array), 0, bytes);
        }
    }

    /// Copies arrays from the device.
    pub(crate) fn read<const N: usize>(
        &self,
        wanted: [Array; N],
    ) -> Result<[Vec<u8>; N], GpuError> {
        let device = &self.context.device;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let copies = wanted.map(|array| {
            let size = self.of(array).size();
            let copy = device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            encoder.copy_buffer_to_buffer(self.of(array), 0, &copy, 0, size);
            copy
        });
        self.context.queue.submit([encoder.finish()]);
        for copy in &copies {
            // A failure is reported by `wait`.
            copy.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        }
        self.context.wait()?;
        let mut read = [const { Vec::new() }; N];
        for (read, copy) in read.iter_mut().zip(&copies) {
            let mapped = copy.slice(..).get_mapped_range();
            let mapped = mapped.map_err(|error| self.context.lost(&error))?;
            read.extend_from_slice(&mapped);
        }
        Ok(read)
    }

    /// Computes a batch of steps from the state in the arrays. Returns the first step with a bond for which the step was too
    /// long, if any; the arrays are then of no use.
    pub(crate) fn run(&self, steps: usize) -> Result<Option<usize>, GpuError> {
        let steps = steps.min(self.steps);
        self.write(Array::Control, bytemuck::cast_slice(&[u32::MAX]));
        let turn = |number: usize| Now {
            number: number as u32,
            finish: number as u32,
            begin: if number < steps { number as u32 + 1 } else { 0 },
        };
        let mut nows = vec![0; STEP as usize * (steps + 1)];
        for (number, bytes) in nows.chunks_mut(STEP as usize).enumerate() {
            let Now {
                number,
                finish,
                begin,
            } = turn(number);
            bytes[..STEP_BYTES as usize]
                .copy_from_slice(bytemuck::cast_slice(&[number, finish, begin, 0]));
        }
        self.context.queue.write_buffer(&self.now, 0, &nows);
        let mut first = 0;
        while first < steps {
            let last = (first + self.per_submission).min(steps);
            self.submit(first..last, first == 0);
            first = last;
        }
        let [control] = self.read([Array::Control])?;
        let stopped: Vec<u32> = bytemuck::pod_collect_to_vec(&control);
        Ok((stopped[0] != u32::MAX).then_some(stopped[0] as usize))
    }

    fn submit(&self, steps: Range<usize>, starts: bool) {
        let device = &self.context.device;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if starts {
            encoder.clear_buffer(self.of(Array::Lost), 0, None);
        }
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            let [loaded, constrained, damped, images] = self.counts;
            let mut call = |pipeline: &wgpu::ComputePipeline, groups: [u32; 3], number: usize| {
                pass.set_pipeline(pipeline);
                pass.set_bind_group(0, &self.group, &[(STEP as usize * number) as u32]);
                pass.dispatch_workgroups(groups[0], groups[1], groups[2]);
            };
            let all = self.groups;
            let some = shader::list_groups;
            let of = &self.pipelines;
            let turn =
                |number: usize, call: &mut dyn FnMut(&wgpu::ComputePipeline, [u32; 3], usize)| {
                    call(&of.turn, all, number);
                    if constrained > 0 {
                        call(&of.guide, some(constrained), number);
                    }
                    if images > 0 {
                        call(&of.repeat, some(images), number);
                    }
                };
            if starts {
                turn(0, &mut call);
            }
            for number in steps {
                if let Some([dilate, repeat]) = &of.solid {
                    call(dilate, all, number);
                    if images > 0 {
                        call(repeat, some(images), number);
                    }
                }
                call(&of.force, all, number);
                if loaded > 0 {
                    call(&of.load, some(loaded), number);
                }
                if constrained > 0 {
                    call(&of.react, some(constrained), number);
                }
                if damped > 0 {
                    call(&of.damp, some(damped), number);
                }
                turn(number + 1, &mut call);
            }
        }
        self.context.queue.submit([encoder.finish()]);
    }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let binding = |binding: u32, ty: wgpu::BindingType| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty,
        count: None,
    };
    let mut entries = vec![binding(
        0,
        wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: true,
            min_binding_size: wgpu::BufferSize::new(STEP_BYTES),
        },
    )];
    entries.extend(Array::ALL.into_iter().map(|array| {
        let read_only = !array.is_written();
        binding(
            array as u32 + 1,
            wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
        )
    }));
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &entries,
    })
}

fn pipelines(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    text: String,
    is_solid: bool,
) -> Pipelines {
    let descriptor = wgpu::ShaderModuleDescriptor {
        label: Some("pericles"),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    };
    // SAFETY: all indices of the shaders lie within their arrays: places of own points and their neighbours, at most one margin
    // away, and lists that end with the counts in the text. Loops end.
    let module = unsafe {
        device.create_shader_module_trusted(descriptor, wgpu::ShaderRuntimeChecks::unchecked())
    };
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    let pipeline = |name: &str| {
        device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(name),
            layout: Some(&layout),
            module: &module,
            entry_point: Some(name),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        })
    };
    Pipelines {
        force: pipeline("force"),
        solid: is_solid.then(|| [pipeline("dilate"), pipeline("repeat_pressures")]),
        turn: pipeline("turn"),
        guide: pipeline("guide"),
        load: pipeline("load"),
        react: pipeline("react"),
        damp: pipeline("damp"),
        repeat: pipeline("repeat"),
    }
}
