//! Numbers on which pair forces are written: one `f64`, or eight side by side.
//!
//! A pair law is written once, generic over [`Real`]. With [`F64x8`] the loops over the lanes become vector instructions of the
//! set the surrounding function is compiled for; with `f64` the same text is the naive twin used by tests. No
//! operation is contracted or reassociated, so all instruction sets give the same bits.
//!
//! Kernels whose speed must not depend on how well a compiler finds vectors are written on [`Vector`]: numbers held in whole registers of each set, eight
//! doubles ([`Lanes`]) or sixteen floats. Only [`Vector::mul_add`] may round differently from set to set.

mod doubles;
#[cfg(target_arch = "x86_64")]
#[doc(hidden)]
pub mod doubles_x86;
mod floats;
#[cfg(target_arch = "x86_64")]
pub(crate) mod floats_x86;
mod instruction_set;
mod lanewise;
mod numbers;

pub use doubles::F64x8;
pub(crate) use floats::{F32x16, FloatLanes};
pub use instruction_set::{InstructionSet, for_each_instruction_set};
pub use numbers::{LANES, Lanes, Real, Row, Vector, dot, vector};
