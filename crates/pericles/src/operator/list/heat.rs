//! Thermal stretch of bonds of a neighbour list.
//!
//! A heated bond has the stress-free length (1 + τ)|ξ| with the mean τ of its ends. Its force is c α κ V
//! (1 + τ) times the pair force of the vectors (1 + τ) ξ and η − τ ξ, the gradient of (1 + τ) times their
//! energy. For the bond-stretch law this is c α κ V (s − τ) n. The bond breaks when its stretch relative to
//! the stress-free length exceeds the critical stretch.

use crate::lanes::Row;
use crate::operator::pool::{Lent, Pool};
use crate::space::Sites;
use crate::thermal::ThermalExpansion;

/// The thermal stretches of sites.
pub(super) struct Heat {
    pub expansion: ThermalExpansion,
    rows: Pool<Vec<Row>>,
}

impl Heat {
    /// Creates the thermal stretches of `sites` sites.
    pub fn new(expansion: ThermalExpansion, sites: usize) -> Self {
        Self {
            expansion,
            rows: Pool::new(1, move || vec![Row::default(); sites]),
        }
    }

    /// Returns rows that begin with τ of a site.
    pub fn rows(&self, stretches: &[f64], sites: &Sites) -> Lent<'_, Vec<Row>> {
        let mut rows = self.rows.take();
        for (site, row) in rows.iter_mut().enumerate() {
            row[0] = stretches[sites.point(site)];
        }
        rows
    }
}
