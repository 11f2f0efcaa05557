//! Stencil force kernel for lattice bodies.
//!
//! Eight nodes of a row are in the lanes, offsets are the inner loop, and forces stay in registers. Small strains use
//! a polynomial, large ones the exact law; the choice depends on the bonds of the point only. Bond failure and
//! dissipated energy are identical to those of the neighbour-list kernel.
//!
//! Single precision is used inside the loops only: they read a copy of the displacements in floats, while states,
//! energies and tangents are doubles. Layout, bits and blocks are the same for both precisions.

mod arrays;
pub(in crate::operator) mod block;
mod breaking;
mod damage;
mod factors;
mod force;
mod heated;
mod kernels;
mod numbers;
mod offsets;
mod operator;
pub(in crate::operator) mod padded;
mod thresholds;
mod view;
pub(in crate::operator) mod wanted;
mod working;
mod zoned;

pub use force::GridForce;

use std::sync::Arc;

use crate::error::{PericlesError, Result};
use crate::family::{Crack, EndRule, VolumeCorrection};
use crate::neighbourhood::Lattice;
use crate::space::PointCloud;

/// Returns the bonds of a lattice body for a kernel of a dimension; the arguments are those of [`Lattice::new`].
///
/// # Errors
/// A body of another dimension; the errors of [`Lattice::new`].
pub(super) fn lattice<const D: usize>(
    cloud: &Arc<PointCloud>,
    horizons: (f64, Option<&[f64]>),
    correction: VolumeCorrection,
    cracks: &[(Crack, EndRule)],
    no_fail: &[u32],
) -> Result<Lattice> {
    if cloud.lattice().is_some() && cloud.dimension() != D {
        return Err(PericlesError::WrongDimension {
            what: "this stencil kernel",
            needed: ["1", "2", "3"][D - 1],
            dimension: cloud.dimension(),
        });
    }
    Lattice::new(cloud, horizons, correction, cracks, no_fail)
}
