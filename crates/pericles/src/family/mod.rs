//! Families: which points are bonded, and how strongly a neighbour's volume counts.
//!
//! A point's family are the points within the horizon δ. [`BondList`] stores all families; [`VolumeCorrection`] weighs cells that the
//! horizon cuts; [`Crack`] removes bonds before the run starts. Distances along surfaces are found by [`geodesic`].

mod bonds;
mod crack;
pub mod geodesic;
mod search;
mod volume;

pub use bonds::{BondList, Cut, LANES};
pub use crack::{Crack, Cutter, EndRule};
pub use search::pairs_within;
pub use volume::VolumeCorrection;
