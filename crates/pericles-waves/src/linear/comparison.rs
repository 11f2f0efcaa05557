//! Cost of one evaluation of a linear body by convolution and by the bond list.

use super::reject;
use super::tensor_kernel::axes;
use pericles::family::VolumeCorrection;
use pericles::space::PointCloud;
use pericles::{Result, positive};

/// Times measured as described in `cost.rs`, single-threaded: a directed bond of the list (2D and 3D, 28 to 514
/// neighbours: 4 to 6 ns), and a number of the padded fields of a convolution, within the L3 cache (2D and 3D: 6.6
/// to 12 ns) and beyond it (14 to 18 ns).
const LIST_BOND: f64 = 5e-9;
const FIELD_NUMBER: f64 = 8e-9;
const FAR_FIELD_NUMBER: f64 = 16e-9;
/// Numbers of all fields beyond which the work arrays exceed the cache.
const NEAR_NUMBERS: f64 = 2e6;

/// Estimated cost of one evaluation of the linear force of a lattice body. It depends on sizes only, so that equal
/// runs make the same choice; the seconds belong to one core of the machine on which the constants were
/// measured, and only their ratio matters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CostComparison {
    /// Time of the bond list, s.
    pub bond_list: f64,
    /// Time of the convolution, s.
    pub convolution: f64,
    /// Directed bonds: exact for boxes, an estimate for other shapes.
    pub directed_bonds: f64,
    /// Memory of the bond list, bytes.
    pub bond_list_bytes: f64,
    /// Memory of the convolution, bytes.
    pub convolution_bytes: f64,
}

impl CostComparison {
    /// Estimates the costs for a body without periodic axes.
    ///
    /// # Errors
    /// Points that are not on a lattice, for which only the bond list is available; a horizon that is not positive.
    pub fn new(cloud: &PointCloud, horizon: f64, correction: VolumeCorrection) -> Result<Self> {
        let Some(lattice) = cloud.lattice() else {
            return reject("it needs points on a regular grid; use the bond list for this body");
        };
        let horizon = positive("the horizon", horizon)?;
        // Lengths in units of the spacing along x.
        let dx = lattice.spacing[0];
        let sides = lattice.spacing.map(|side| side / dx);
        let reach = correction.reach(horizon, cloud.spacing()) / dx;
        let raw = sides.map(|side| (reach / side).floor() as usize);
        let points = cloud.len() as f64;
        // Pairs of nodes of the bounding box at each offset, multiplied by the filled fraction of the box.
        let range = |axis: usize| {
            let most = (raw[axis] as i64).min(lattice.shape[axis] as i64 - 1);
            -most..=most
        };
        let left = |axis: usize, offset: i64| (lattice.shape[axis] as i64 - offset.abs()) as f64;
        let mut pairs = 0.0;
        for z in range(2) {
            for y in range(1) {
                let [y_side, z_side] = [y as f64 * sides[1], z as f64 * sides[2]];
                let rest = reach * reach - (y_side * y_side + z_side * z_side);
                if rest < 0.0 {
                    continue;
                }
                let most = (rest.sqrt().floor() as i64).min(lattice.shape[0] as i64 - 1);
                // Σ over |x| ≤ most of (nodes − |x|).
                let along = (2 * most + 1) as f64 * left(0, 0) - (most * (most + 1)) as f64;
                pairs += along * left(1, y) * left(2, z);
            }
        }
        let nodes: f64 = lattice.shape.iter().map(|&n| n as f64).product();
        let directed_bonds = (pairs - nodes) * (points / nodes);

        let dimension = cloud.dimension();
        let axes = axes::<3>(lattice, raw, [false; 3]);
        let fields = dimension as f64;
        let padded: f64 = axes.iter().map(|axis| axis.padded as f64).product();
        let numbers = fields * padded;
        let number = if numbers <= NEAR_NUMBERS {
            FIELD_NUMBER
        } else {
            FAR_FIELD_NUMBER
        };
        let pairs = fields * (fields + 1.0) / 2.0;
        let octant: f64 = axes.iter().map(|axis| axis.modes() as f64).product();
        let last = axes[dimension - 1];
        let stored = numbers * last.nodes as f64 / last.padded as f64;
        let word = size_of::<f64>() as f64;
        Ok(Self {
            bond_list: LIST_BOND * directed_bonds,
            convolution: number * numbers,
            directed_bonds,
            // Index and stiffness of the neighbour, and two bits, per bond; rows are padded to eight.
            bond_list_bytes: 12.25 * (directed_bonds + 4.0 * points)
                + word * (fields + 1.0) * points,
            convolution_bytes: word * (pairs * (octant + points) + 2.0 * stored),
        })
    }

    /// Returns true if the convolution is cheaper.
    pub fn convolution_is_cheaper(&self) -> bool {
        self.convolution < self.bond_list
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    use pericles::family::BondList;
    use pericles::space::{Grid, Region, Shape};

    fn body(cells: &[f64]) -> PointCloud {
        Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: cells.to_vec(),
            },
            spacing: 1.0,
            section: 1.0,
            holes: vec![],
        }
        .points()
        .unwrap()
    }

    #[test]
    fn bond_counts_of_boxes_are_exact() {
        for cells in [&[30.0][..], &[9.0, 14.0], &[5.0, 4.0, 6.0]] {
            let cloud = body(cells);
            for horizon in [1.0, 3.0, 3.6, 8.0] {
                for correction in [VolumeCorrection::None, VolumeCorrection::Extended] {
                    let costs = CostComparison::new(&cloud, horizon, correction).unwrap();
                    let shared = Arc::new(cloud.clone());
                    let list = BondList::new(&shared, horizon, correction).unwrap();
                    assert_eq!(costs.directed_bonds, list.directed_bonds() as f64);
                }
            }
        }
    }

    #[test]
    fn convolution_is_cheaper_for_large_horizons_and_full_boxes() {
        let cheaper = |cloud: &PointCloud, horizon| {
            CostComparison::new(cloud, horizon, VolumeCorrection::None)
                .unwrap()
                .convolution_is_cheaper()
        };
        let block = body(&[40.0; 3]);
        assert!(!cheaper(&block, 1.0) && cheaper(&block, 4.0));
        // Four corners: the convolution includes the empty space, the list does not.
        let corners = Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: vec![100.0, 100.0],
            },
            spacing: 1.0,
            section: 1.0,
            holes: vec![Region::Ball {
                centre: [50.0, 50.0, 0.0],
                radius: 65.0,
            }],
        }
        .points()
        .unwrap();
        assert!(!cheaper(&corners, 3.0) && cheaper(&body(&[100.0, 100.0]), 3.0));
        let loose = PointCloud::new(1, vec![0.0, 1.0], vec![1.0; 2], 1.0).unwrap();
        assert!(CostComparison::new(&loose, 3.0, VolumeCorrection::None).is_err());
    }
}
