//! Time steps on graphics processors, through Vulkan, Metal or Direct3D 12 (wgpu).
//!
//! [`Gpu`] implements [`Device`](pericles::time::Device): it computes whole steps of velocity Verlet (forces and failure of bonds,
//! loads, constraints, damping layers, energy balance) in batches. The host reads the state after a batch: at times of output, and
//! at least every hundred steps, when it checks the run, stop conditions and signals. State and checkpoints are those of the
//! processor: a run may stop on a device and resume without one, and the reverse.
//!
//! **Bodies.** Linear and bond-stretch bonds and linear peridynamic solids on a regular lattice in one, two or three dimensions, with holes, pre-cracks,
//! several materials, scattered strengths, surface correction, periodic faces and bonds that break; loads and prescribed motions
//! that are functions of the position times functions of time; damping layers. [`unsupported`] lists the reasons why a run is not
//! possible.
//!
//! **Layout.** The arrays have one entry per place of the padded rows of the
//! [`GridLayout`](pericles::neighbourhood::GridLayout), so that a neighbour is a constant number of places away. An invocation
//! computes one point, with all bonds of the stencil written out in the text of the shader.
//!
//! **Results** do not depend on the order in which a device computes: each entry is written by one invocation, and sums have a
//! fixed order. Two runs on one device are identical bit for bit, and so is a resumed run. They differ from those of the processor
//! by rounding, because devices may contract products and sums; in mixed precision by about 1e-7 of the largest force.
//!
//! **Bonds for which a step is too long** (see [`CoarseBreak`](pericles::operator::CoarseBreak)) need a correction of the motion
//! of their ends, which the processor computes: the batch is repeated up to this step, and the processor computes the step.
//!
//! **Precision.** [`Precision::Double`] where the adapter has it, else [`Precision::Mixed`]: the state is the sum of two floats,
//! forces are floats.

mod adapter;
mod arrays;
mod batch;
mod body;
mod ceiling;
mod entries;
mod error;
mod flags;
mod limits;
mod precision;
mod shader;
mod speed;
mod verlet;

pub use adapter::{Adapter, adapter, adapters};
pub use ceiling::Ceilings;
pub use error::GpuError;
pub use limits::unsupported;
pub use precision::Precision;
pub use speed::Speed;
pub use verlet::Gpu;
