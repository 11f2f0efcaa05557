//! Points with random positions, so that cracks do not follow lattice directions.
//!
//! | points | function | volumes |
//! |---|---|---|
//! | a lattice with randomly displaced nodes | [`jittered`] | volumes of the lattice cells |
//! | blue noise: random with a minimum distance (Poisson disc) | [`blue_noise`] | [`nearest_volumes`] |
//!
//! Every random number is a function of the seed, a cell and a trial, so that results do not depend on the
//! number of threads.

mod disc;
mod hash;
mod jitter;
mod volumes;

pub use disc::blue_noise;
pub use jitter::jittered;
pub use volumes::nearest_volumes;

/// Predicate: whether a position is inside a body.
pub type Inside<'a> = dyn Fn([f64; 3]) -> bool + Sync + 'a;
