//! Families: which points are bonded, and how strongly a neighbour's volume counts.
//!
//! A point's family are the points within the horizon δ. [`BondList`] stores all families; [`VolumeCorrection`] weighs cells that the
//! horizon cuts; [`Crack`] removes bonds before the run starts.

mod crack;

mod volume;

pub use crack::{Crack, EndRule};

pub use volume::VolumeCorrection;
