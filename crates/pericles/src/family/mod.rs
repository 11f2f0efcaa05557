//! Families: the neighbours of each point within the horizon, and the weights of their volumes.
//!
//! The family of a point contains all points within the horizon δ. [`BondList`] stores all families;
//! [`VolumeCorrection`] weights cells that the horizon cuts; [`Crack`] removes bonds before the run starts.

mod bonds;
mod crack;
mod reverse;
mod search;
mod volume;

pub use bonds::{BondCut, BondList};
pub use crack::{Crack, Cutter, EndRule};
pub(crate) use reverse::ReverseEntries;
pub(crate) use search::pairs_of_sites;
pub use search::{pairs_where, pairs_within};
pub use volume::VolumeCorrection;
