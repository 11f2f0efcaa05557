//! Cracks in glass plates: branching from a notch, and an inclined crack under biaxial tension.
//!
//! Alebrahim, Packo, Zaccariotto, Galvanetto, Improved wave dispersion properties in 1D and 2D bond-based
//! peridynamic media, Computational Particle Mechanics (2022). Original influence function (α = 1), δ = 3 Δx = 0.75
//! mm, plane strain, full node volumes.
//!
//! Definitions. The crack is the set of points with damage above 0.35 that is connected to the pre-crack; its front
//! is sampled every 0.5 µs. Speeds are least-squares slopes over a time window, short enough to follow the crack
//! and long enough to average over single points.

mod branching;
mod front;
mod inclined;
mod record;

pub(crate) use front::slopes;

use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[data!("fracture/branching"), data!("fracture/inclined")],
    measures: &[
        ("branching", branching::branching),
        ("inclined", inclined::inclined),
    ],
};
