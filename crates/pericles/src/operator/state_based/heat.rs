//! Thermal strain of linear peridynamic solids.
//!
//! The extensions of the bonds of a point are reduced by τ r with the thermal stretch τ of the point. With
//! M' = Σ ω r² over the intact bonds, its dilatation is then θ − D τ M'/m, and its force state has the
//! additional pull −τ (A D M'/m + B)/m at every bond. This is a number per point, so that the loops over
//! bonds are unchanged.

use super::breaking::States;
use crate::operator::PointSubset;
use crate::thermal::ThermalExpansion;

/// Data of a heated solid.
pub(super) struct Heat {
    pub expansion: ThermalExpansion,
    /// M' of own points, m⁵ for a dimensionless influence function.
    pub volume: Vec<f64>,
}

impl Heat {
    /// Returns the contribution of the thermal stretch of a point at a site to p, the pull of its force state that is
    /// the same for all bonds.
    pub fn pull(&self, states: &States, [i, site]: [usize; 2], stretch: f64) -> f64 {
        let share = states.dilatation[i] * self.volume[i];
        -stretch * (states.pressure[site] * share + states.stiffness[site])
    }

    /// Adds the thermal pulls of the points `on` at a time to one value per point. `site_of` returns the site of a
    /// point in `states`.
    pub fn add_pulls(
        &self,
        t: f64,
        states: &States,
        site_of: impl Fn(usize) -> usize,
        on: &PointSubset<'_>,
        pulls: &mut [f64],
    ) {
        let stretches = self.expansion.stretches(t);
        on.for_each(pulls.len(), |i| {
            pulls[i] += self.pull(states, [i, site_of(i)], stretches[i]);
        });
    }

    /// Returns the energy density of a point with the dilatation θ and the sum Σ g ω e² of total extensions, J/m³.
    pub fn energy_density(
        &self,
        states: &States,
        place: [usize; 2],
        stretch: f64,
        [theta, squares]: [f64; 2],
    ) -> f64 {
        let factor = states.dilatation[place[0]];
        if factor <= 0.0 {
            return states.energy_density(place, theta, squares);
        }
        let volume = self.volume[place[0]];
        let linear = theta / factor;
        let squares = squares - stretch * (2.0 * linear - stretch * volume);
        states.energy_density(place, theta - factor * volume * stretch, squares)
    }
}
