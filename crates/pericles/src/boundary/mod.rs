//! Loads, prescribed motion, and the seam for other boundaries.

mod function;

pub use function::TimeFunction;
