//! Points with random positions, so that cracks do not follow the lines of a lattice.
//!
//! | points | function | volumes |
//! |---|---|---|
//! | a lattice whose nodes are displaced | [`jittered`] | those of the lattice's cells |
//! | blue noise: random, but nowhere nearer than a radius (Poisson disc) | [`blue_noise`] | [`nearest_volumes`] |
//!
//! Every number is a function of the seed, a cell and a trial: results do not depend on the number of threads.

mod disc;
mod hash;
mod jitter;
mod volumes;

pub use disc::blue_noise;
pub use jitter::jittered;
pub use volumes::nearest_volumes;

/// Whether a position is inside of a body.
pub type Inside<'a> = dyn Fn([f64; 3]) -> bool + Sync + 'a;
