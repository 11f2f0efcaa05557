//! What a material needs to know of the lattice it is used on.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use super::BondMaterial;
use crate::error::{PericlesError, Result};
use crate::kernel::{ClassOffset, ClassTable, InfluenceFunction, class_of};
use crate::space::PointCloud;

impl BondMaterial {
    /// The sum over an interior point's bonds that becomes m_dimension as the spacing goes to zero: Σ κ α r Δx^D over 2, 2π, 4π.
    pub(super) fn lattice_moment(&self, dimension: usize, spacing: f64) -> f64 {
        let mut sum = 0.0;
        self.for_each_offset(dimension, spacing, |_, xi, r| {
            let kappa = self.volume_correction.factor(r, self.horizon, spacing);
            sum += kappa * self.influence.alpha_of(xi, self.horizon) * r;
        });
        sum * spacing.powi(dimension as i32) / [2.0, 2.0 * PI, 4.0 * PI][dimension - 1]
    }

    /// Calls `visit(offset, ξ, |ξ|)` for the bonds of an interior point of a lattice.
    pub(super) fn for_each_offset(
        &self,
        dimension: usize,
        spacing: f64,
        mut visit: impl FnMut([i32; 3], [f64; 3], f64),
    ) {
        let reach = self.volume_correction.reach(self.horizon, spacing);
        let n = (reach / spacing).floor() as i32;
        let range = |active: bool| if active { -n..=n } else { 0..=0 };
        for z in range(dimension > 2) {
            for y in range(dimension > 1) {
                for x in range(true) {
                    // Whole numbers, but squares of large ones only fit a double.
                    let square = [x, y, z].map(|c| f64::from(c) * f64::from(c));
                    let r = square.iter().sum::<f64>().sqrt() * spacing;
                    if r > 0.0 && r <= reach {
                        let xi = [x, y, z].map(|c| f64::from(c) * spacing);
                        visit([x, y, z], xi, r);
                    }
                }
            }
        }
    }

    /// Refuses horizons with so many neighbours that sums over them do not end.
    pub(super) fn check_reach(&self, dimension: usize, spacing: f64) -> Result<()> {
        /// A second's work, and far more bonds than any body can have.
        const MOST: f64 = 1e8;
        let reach = self.volume_correction.reach(self.horizon, spacing);
        let neighbours = (2.0 * (reach / spacing).floor() + 1.0).powi(dimension as i32);
        if neighbours <= MOST {
            return Ok(());
        }
        Err(PericlesError::HorizonTooLarge {
            horizon: self.horizon,
            spacing,
            neighbours,
            most: MOST,
        })
    }

    pub(super) fn class_table(&self) -> Option<&ClassTable> {
        match &self.influence.function {
            InfluenceFunction::Classes(table) => Some(table),
            _ => None,
        }
    }

    /// A table per class must belong to the body's lattice and name exactly the classes within reach.
    pub(super) fn check_classes(&self, cloud: &PointCloud) -> Result<()> {
        let Some(table) = self.class_table() else {
            return Ok(());
        };
        let refuse = |reason: String| Err(PericlesError::BadInfluence { reason });
        let spacing = cloud.spacing();
        if cloud.lattice().is_none() {
            return refuse("a table per class needs points on a regular grid".into());
        }
        if (table.spacing() / spacing - 1.0).abs() > 1e-9 {
            return refuse(format!(
                "the table per class was made for a spacing of {} m, the grid has {spacing} m",
                table.spacing()
            ));
        }
        self.check_reach(cloud.dimension(), spacing)?;
        let mut within = BTreeSet::new();
        self.for_each_offset(cloud.dimension(), spacing, |offset, _, _| {
            within.insert(class_of(offset));
        });
        let name = |class: ClassOffset| format!("({}, {}, {})", class[0], class[1], class[2]);
        if let Some(missing) = within.iter().find(|class| table.lookup(**class).is_none()) {
            return refuse(format!(
                "the table has no value for the class {} that lies within reach; it needs all {} classes (with the extended volume \
                 correction the reach is half a spacing more than the horizon)",
                name(*missing),
                within.len()
            ));
        }
        match table
            .entries()
            .iter()
            .find(|(class, _)| !within.contains(class))
        {
            Some((class, _)) => refuse(format!(
                "the table has a value for the class {}, which lies beyond the reach of bonds",
                name(*class)
            )),
            None => Ok(()),
        }
    }
}
