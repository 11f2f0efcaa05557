//! Numbers for pair forces: one `f64`, or eight in a vector.
//!
//! A pair law is written once, generic over [`Real`]. With [`F64x8`] the loops over the lanes become vector
//! instructions of the set for which the surrounding function is compiled; with `f64` the same code is the scalar
//! reference used by tests. No operation is contracted or reordered, so that all instruction sets give the same
//! bits.
//!
//! Kernels that must not depend on automatic vectorisation use [`Vector`]: numbers in whole registers of each set,
//! eight doubles ([`Lanes`]) or sixteen floats. Only [`Vector::mul_add`] may round differently between sets.
//!
//! Loops contain no calls. A closure or adapter that the compiler does not inline uses baseline instructions and
//! passes all registers through memory, which is up to three times slower and fails no test. Loops are therefore
//! plain loops; `.ci/inlined.sh` searches the compiled program for calls, and `pericles-bench` compares the operators
//! with a reference loop.

mod doubles;
#[cfg(target_arch = "x86_64")]
#[doc(hidden)]
pub mod doubles_x86;
mod floats;
// On x86-64 only the reference of a test.
#[cfg(any(test, not(target_arch = "x86_64")))]
mod floats_array;
#[cfg(target_arch = "x86_64")]
pub(crate) mod floats_x86;
mod instruction_set;
mod lanewise;
mod numbers;
#[cfg(target_arch = "x86_64")]
mod sse2;

pub use doubles::F64x8;
pub(crate) use floats::FloatLanes;
pub use instruction_set::{InstructionSet, for_each_instruction_set};
pub use numbers::{LANES, Lanes, Real, Row, Vector, dot, vector};

/// Eight doubles of the baseline.
#[cfg(target_arch = "x86_64")]
#[doc(hidden)]
pub type Baseline8 = sse2::Sse2x8;
#[cfg(not(target_arch = "x86_64"))]
#[doc(hidden)]
pub type Baseline8 = F64x8;

/// Sixteen floats of the baseline.
#[cfg(target_arch = "x86_64")]
pub(crate) type Baseline16 = sse2::Sse2x16;
#[cfg(not(target_arch = "x86_64"))]
pub(crate) type Baseline16 = floats_array::F32x16;
