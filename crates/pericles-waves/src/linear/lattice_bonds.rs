//! Bonds of a lattice body by offset.

use super::reject;
use pericles::family::VolumeCorrection;
use pericles::operator::{LatticeSpring, LatticeSprings};
use pericles::space::{Lattice, PointCloud};
use pericles::{PericlesError, Result};

/// Bond of a given offset: k = c α κ V, the length |ξ| and the vector ξ.
pub(super) struct OffsetBond {
    pub stiffness: f64,
    pub length: f64,
    pub xi: [f64; 3],
}

/// Rule that creates the bond of an offset, with the same arithmetic as the bond list, so that the same bonds
/// exist.
pub(super) struct LatticeBonds<S: Fn([f64; 3]) -> f64> {
    stiffness_of_bond: S,
    correction: VolumeCorrection,
    horizon: f64,
    reach: f64,
    spacing: f64,
    /// The spacing along each axis, m.
    sides: [f64; 3],
    volume: f64,
}

impl<S: Fn([f64; 3]) -> f64> LatticeBonds<S> {
    /// Creates the bonds of a cloud and its lattice.
    ///
    /// # Errors
    /// Points that are not on a lattice, or of different volume; a horizon below the spacing.
    pub fn new(
        cloud: &PointCloud,
        horizon: f64,
        correction: VolumeCorrection,
        stiffness_of_bond: S,
    ) -> Result<(Self, &Lattice)> {
        let Some(lattice) = cloud.lattice() else {
            return reject("it needs points on a regular grid; use the bond list for this body");
        };
        let volume = cloud.volumes()[0];
        if cloud.volumes().iter().any(|&v| v != volume) {
            return reject("it needs points of equal volume; use the bond list for this body");
        }
        let spacing = cloud.spacing();
        let reach = correction.reach(horizon, spacing);
        let sides = &lattice.spacing[..cloud.dimension()];
        let shortest = sides.iter().copied().fold(f64::INFINITY, f64::min);
        if reach.is_nan() || reach < shortest {
            return Err(PericlesError::HorizonTooSmall { horizon, spacing });
        }
        let bonds = Self {
            stiffness_of_bond,
            correction,
            horizon,
            reach,
            spacing,
            sides: lattice.spacing,
            volume,
        };
        Ok((bonds, lattice))
    }

    /// Largest offset along each axis.
    pub fn largest_offset(&self) -> [usize; 3] {
        self.sides.map(|dx| (self.reach / dx).floor() as usize)
    }

    /// Returns the bond of an offset; `None` beyond the horizon.
    pub fn at(&self, offset: [i64; 3]) -> Option<OffsetBond> {
        let xi: [f64; 3] = std::array::from_fn(|c| offset[c] as f64 * self.sides[c]);
        let length = (xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]).sqrt();
        (length > 0.0 && length <= self.reach).then(|| OffsetBond {
            stiffness: (self.stiffness_of_bond)(xi)
                * self.correction.factor(length, self.horizon, self.spacing)
                * self.volume,
            length,
            xi,
        })
    }

    /// Returns the bonds as springs, with offsets up to `most` along each axis.
    pub fn springs(&self, dimension: usize, most: [usize; 3]) -> Option<LatticeSprings> {
        // Plane waves are used for cubic lattices only.
        if self.sides[..dimension]
            .iter()
            .any(|dx| *dx != self.sides[0])
        {
            return None;
        }
        let range = |axis: usize| -(most[axis] as i64)..=most[axis] as i64;
        let all = range(2)
            .flat_map(|z| range(1).flat_map(move |y| range(0).map(move |x| [x, y, z])))
            .filter_map(|offset| {
                self.at(offset).map(|bond| LatticeSpring {
                    offset: offset.map(|o| o as i32),
                    stiffness: bond.stiffness / bond.length,
                })
            });
        LatticeSprings::new(dimension, all)
    }

    /// Returns Σ |k|/|ξ| over a full family with offsets up to `most` along each axis, and whether any k is
    /// negative.
    ///
    /// # Errors
    /// A stiffness that is not finite.
    pub fn full_family(&self, most: [usize; 3]) -> Result<(f64, bool)> {
        let range = |axis: usize| -(most[axis] as i64)..=most[axis] as i64;
        let (mut sum, mut signed) = (0.0, false);
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    if let Some(bond) = self.at([x, y, z]) {
                        if !bond.stiffness.is_finite() {
                            return reject(
                                "the stiffness of every bond must be finite; check the influence function",
                            );
                        }
                        signed |= bond.stiffness < 0.0;
                        sum += bond.stiffness.abs() / bond.length;
                    }
                }
            }
        }
        Ok((sum, signed))
    }
}
