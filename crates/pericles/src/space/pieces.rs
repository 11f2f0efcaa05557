//! Pieces of a body: parts that no bond joins.
//!
//! Pieces are a property of the points. Neighbour lists and stencils do not join them, so that force kernels need no
//! rule for them.

use super::{PointCloud, check_length};
use crate::error::Result;

impl PointCloud {
    /// Divides the body into pieces by a number per own point. Families do not join points of different pieces, so
    /// that pieces interact by contact only.
    ///
    /// ```
    /// use pericles::family::{BondList, VolumeCorrection};
    /// use pericles::space::PointCloud;
    /// use std::sync::Arc;
    ///
    /// let cloud = PointCloud::new(1, vec![0.0, 1.0, 2.0, 3.0], vec![1.0; 4], 1.0)?;
    /// let cloud = Arc::new(cloud.with_pieces(vec![0, 0, 1, 1])?);
    /// let bonds = BondList::new(&cloud, 1.5, VolumeCorrection::None)?;
    /// assert_eq!(bonds.directed_bonds(), 4);
    /// # Ok::<(), pericles::PericlesError>(())
    /// ```
    ///
    /// # Errors
    /// Not one number per point.
    pub fn with_pieces(mut self, pieces: Vec<u32>) -> Result<Self> {
        check_length("the pieces of the points", pieces.len(), self.len())?;
        // Equal numbers are one piece, which needs no array.
        let several = pieces.iter().any(|&piece| piece != 0);
        self.pieces = if several { pieces } else { Vec::new() };
        Ok(self)
    }

    /// Returns the piece of a point, counted from 0.
    pub fn piece(&self, i: usize) -> u32 {
        self.pieces.get(i).copied().unwrap_or(0)
    }

    /// Returns the piece of each point; empty for a body of one piece.
    pub fn pieces(&self) -> &[u32] {
        &self.pieces
    }

    /// Returns whether the body was divided into pieces.
    pub fn has_pieces(&self) -> bool {
        !self.pieces.is_empty()
    }
}
