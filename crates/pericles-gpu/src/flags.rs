//! Flags of places, which the shaders read.

/// Flag of places that are own points.
pub(crate) const OWN: u32 = 1;
/// Flag of places whose bonds never break.
pub(crate) const HELD: u32 = 2;
/// Flag of places whose first component is constrained; the next two flags belong to the other components.
pub(crate) const GUIDED: u32 = 4;
/// Number of bits before the number of the material in the flags.
pub(crate) const MATERIAL: u32 = 8;
