//! Families: which points are bonded, and how strongly a neighbour's volume counts.
//!
//! A point's family are the points within the horizon δ. [`BondList`] stores all families; [`VolumeCorrection`] weighs cells that the
//! horizon cuts; [`Crack`] removes bonds before the run starts.

mod bonds;
mod crack;
mod search;
mod volume;

pub use bonds::{BondList, Cut};
pub use crack::{Crack, Cutter, EndRule};
pub use search::{pairs_where, pairs_within};
pub use volume::VolumeCorrection;
