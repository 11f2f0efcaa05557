//! Lattice sums of a material, and checks of horizon and class tables against the lattice.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use super::BondMaterial;
use crate::error::{PericlesError, Result};
use crate::family::VolumeCorrection;
use crate::kernel::{ClassOffset, ClassTable, InfluenceFunction, class_of};
use crate::space::PointCloud;

/// The cells of a regular lattice: boxes with one point each.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cells<'a> {
    /// Side of a cell along each axis, m: one to three numbers.
    sides: &'a [f64],
}

impl<'a> Cells<'a> {
    /// Creates cells with these sides, m, one per dimension.
    pub(super) fn new(sides: &'a [f64]) -> Self {
        Self { sides }
    }

    pub(super) fn sides(self) -> &'a [f64] {
        self.sides
    }

    /// Returns whether all sides are equal.
    pub(super) fn is_cubic(self) -> bool {
        self.sides.iter().all(|side| *side == self.sides[0])
    }

    /// Returns the cell size for volume corrections, m: the side of the square or cube of the same volume.
    pub(super) fn size(self) -> f64 {
        if self.is_cubic() {
            return self.sides[0];
        }
        let product: f64 = self.sides.iter().product();
        product.powf(1.0 / self.sides.len() as f64)
    }

    /// Returns the product of the sides: m, m² or m³.
    pub(super) fn volume(self) -> f64 {
        self.sides.iter().product()
    }
}

/// Sums over the bonds of an interior point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LatticeSums {
    /// Σ κ α r ΠΔx over 2, 2π, 4π: stiffness against a uniform dilation.
    pub(super) moment: f64,
    /// The same sum weighted by n_a² n_b² over its mean in all directions, averaged over pairs of axes:
    /// stiffness against shear along the axes.
    pub(super) shear_moment: f64,
}

/// Calls `visit(offset, ξ, |ξ|)` for each bond of an interior point of a lattice.
pub(super) fn for_each_offset(
    cells: Cells<'_>,
    horizon: f64,
    correction: VolumeCorrection,
    mut visit: impl FnMut([i32; 3], [f64; 3], f64),
) {
    let sides = cells.sides;
    let reach = correction.reach(horizon, cells.size());
    let side = |c: usize| sides.get(c).copied().unwrap_or(0.0);
    let range = |c: usize| match sides.get(c) {
        Some(side) => {
            let n = (reach / side).floor() as i32;
            -n..=n
        }
        None => 0..=0,
    };
    // In units of the first side, so that lengths on square and cubic lattices are exact roots of integers.
    let shape: [f64; 3] = std::array::from_fn(|c| side(c) / sides[0]);
    for z in range(2) {
        for y in range(1) {
            for x in range(0) {
                let offset = [x, y, z];
                let square: f64 = (0..3)
                    .map(|c| f64::from(offset[c]) * shape[c])
                    .map(|steps| steps * steps)
                    .sum();
                let r = square.sqrt() * sides[0];
                if r > 0.0 && r <= reach {
                    let xi = std::array::from_fn(|c| f64::from(offset[c]) * side(c));
                    visit(offset, xi, r);
                }
            }
        }
    }
}

/// Returns an error for horizons with too many neighbours to sum over.
pub(super) fn check_reach(
    cells: Cells<'_>,
    horizon: f64,
    correction: VolumeCorrection,
) -> Result<()> {
    /// About a second of computing time, and far more bonds than any body has.
    const MOST: f64 = 1e8;
    let reach = correction.reach(horizon, cells.size());
    let along = |side: &f64| 2.0 * (reach / side).floor() + 1.0;
    let neighbours = cells.sides.iter().map(along).product();
    if neighbours <= MOST {
        return Ok(());
    }
    Err(PericlesError::HorizonTooLarge {
        horizon,
        spacing: cells.size(),
        neighbours,
        most: MOST,
    })
}

impl BondMaterial {
    /// Returns the sums over the bonds of an interior point, which converge to m_dimension as the spacing goes to zero.
    pub(super) fn lattice_sums(&self, cells: Cells<'_>) -> LatticeSums {
        /// Mean of n_a² n_b² over all directions n, for two different axes.
        const ISOTROPIC: [f64; 3] = [1.0, 1.0 / 8.0, 1.0 / 15.0];
        let dimension = cells.sides.len();
        let (mut bulk, mut shear, size) = (0.0, 0.0, cells.size());
        self.for_each_offset(cells, |_, xi, r| {
            let kappa = self.volume_correction.factor(r, self.horizon, size);
            let weight = kappa * self.influence.alpha_of(xi, self.horizon) * r;
            bulk += weight;
            let [x, y, z] = xi.map(|x| (x / r) * (x / r));
            shear += weight * (x * y + y * z + z * x);
        });
        let pairs = [1.0, 1.0, 3.0][dimension - 1];
        let average = |sum: f64| sum * cells.volume() / [2.0, 2.0 * PI, 4.0 * PI][dimension - 1];
        LatticeSums {
            moment: average(bulk),
            // A bar has no shear.
            shear_moment: match dimension {
                1 => average(bulk),
                _ => average(shear) / (pairs * ISOTROPIC[dimension - 1]),
            },
        }
    }

    /// Calls `visit(offset, ξ, |ξ|)` for each bond of an interior point of a lattice.
    pub(super) fn for_each_offset(
        &self,
        cells: Cells<'_>,
        visit: impl FnMut([i32; 3], [f64; 3], f64),
    ) {
        for_each_offset(cells, self.horizon, self.volume_correction, visit);
    }

    /// Returns an error for horizons with too many neighbours to sum over.
    pub(super) fn check_reach(&self, cells: Cells<'_>) -> Result<()> {
        check_reach(cells, self.horizon, self.volume_correction)
    }

    pub(super) fn class_table(&self) -> Option<&ClassTable> {
        match &self.influence.function {
            InfluenceFunction::Classes(table) => Some(table),
            _ => None,
        }
    }

    /// Returns an error unless a class table fits the lattice of the body and contains exactly the classes
    /// within reach.
    pub(super) fn check_classes(&self, cloud: &PointCloud) -> Result<()> {
        let Some(table) = self.class_table() else {
            return Ok(());
        };
        let reject = |reason: String| Err(PericlesError::BadInfluence { reason });
        let spacing = cloud.spacing();
        if !(cloud.lattice()).is_some_and(|lattice| lattice.is_cubic(cloud.dimension())) {
            return reject(
                "a table per lattice class requires points on a regular grid of cubic cells".into(),
            );
        }
        if (table.spacing() / spacing - 1.0).abs() > 1e-9 {
            return reject(format!(
                "the table per lattice class belongs to a spacing of {} m, but the spacing of the grid is {spacing} m",
                table.spacing()
            ));
        }
        let sides = vec![spacing; cloud.dimension()];
        let cells = Cells::new(&sides);
        self.check_reach(cells)?;
        let mut within = BTreeSet::new();
        self.for_each_offset(cells, |offset, _, _| {
            within.insert(class_of(offset));
        });
        let name = |class: ClassOffset| format!("({}, {}, {})", class[0], class[1], class[2]);
        if let Some(missing) = within.iter().find(|class| table.lookup(**class).is_none()) {
            return reject(format!(
                "the table has no value for the class {}, which lies within reach; it requires all {} classes (with the extended \
                 volume correction the reach exceeds the horizon by half a spacing)",
                name(*missing),
                within.len()
            ));
        }
        match table
            .entries()
            .iter()
            .find(|(class, _)| !within.contains(class))
        {
            Some((class, _)) => reject(format!(
                "the table has a value for the class {}, which lies beyond the reach of bonds; remove it",
                name(*class)
            )),
            None => Ok(()),
        }
    }
}
