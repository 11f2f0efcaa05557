//! Pair conductivity κ(ξ) from the conductivity.
//!
//! Conductances have the influence function and volume correction of the forces, and broken bonds of the forces do
//! not conduct.

use pericles::family::VolumeCorrection;
use pericles::kernel::Influence;
use pericles::space::PointCloud;
use pericles::{Result, positive};

use crate::error::HeatError;

/// The pair conductivity κ(ξ) = (Σ_a m_a ξ_a²/r²) α(ξ)/r of a material with unit conductivity, with the influence
/// function α of the forces. The factors m_a are equal except on lattices with different spacings.
#[derive(Debug, Clone, PartialEq)]
pub struct PairConductivity {
    influence: Influence,
    horizon: f64,
    factors: [f64; 3],
}

impl PairConductivity {
    /// Calibrates with the moments of the influence function: the continuum conducts exactly the given heat.
    ///
    /// # Errors
    /// Invalid influence functions and horizons; [`HeatError::NegativeInfluence`].
    pub fn of_continuum(
        influence: &Influence,
        horizon: f64,
        dimension: usize,
        section: f64,
    ) -> Result<Self> {
        check(influence, horizon, dimension)?;
        // ½ ∫ α/r ξ_x² dV = k with dV of a shell: 2 A dr, 2π r t dr, 4π r² dr.
        let shell = match dimension {
            1 => 2.0 * section,
            2 => 2.0 * std::f64::consts::PI * section,
            _ => 4.0 * std::f64::consts::PI,
        };
        let moment = shell * influence.moment(dimension as f64, horizon) / dimension as f64;
        Ok(Self {
            influence: influence.clone(),
            horizon,
            factors: [2.0 / moment; 3],
        })
    }

    /// Calibrates with sums over the full family of a lattice point: a linear field conducts exactly the given heat.
    ///
    /// # Errors
    /// The errors of [`PairConductivity::of_continuum`]; a cloud without a lattice is calibrated as a continuum;
    /// [`HeatError::Anisotropic`].
    pub fn of_lattice(
        influence: &Influence,
        horizon: f64,
        correction: VolumeCorrection,
        cloud: &PointCloud,
    ) -> Result<Self> {
        let dimension = cloud.dimension();
        let Some(lattice) = cloud.lattice() else {
            return Self::of_continuum(influence, horizon, dimension, cloud.section());
        };
        check(influence, horizon, dimension)?;
        let (cell, volume) = (cloud.spacing(), cell_volume(cloud));
        // Σ α/r ξ_a² ξ_b²/r² V
        let mut sums = [[0.0; 3]; 3];
        for_each_offset(
            lattice.spacing,
            dimension,
            correction.reach(horizon, cell),
            &mut |_, xi, r| {
                let weight = influence.alpha_of(xi, horizon) / r
                    * correction.factor(r, horizon, cell)
                    * volume;
                for a in 0..dimension {
                    for b in 0..dimension {
                        sums[a][b] += weight * xi[a] * xi[a] * xi[b] * xi[b] / (r * r);
                    }
                }
            },
        );
        let mut factors = [0.0; 3];
        if lattice.is_cubic(dimension) {
            let row: f64 = sums[0][..dimension].iter().sum();
            factors[..dimension].fill(2.0 / row);
        } else {
            solve(dimension, &mut sums, &mut factors);
        }
        let positive = |factor: &f64| factor.is_finite() && *factor > 0.0;
        if !factors[..dimension].iter().all(positive) {
            let sides = &lattice.spacing[..dimension];
            let longest = sides.iter().copied().fold(0.0, f64::max);
            let shortest = sides.iter().copied().fold(f64::INFINITY, f64::min);
            let (conductivity, ratio) = (1.0, longest / shortest);
            return Err(HeatError::Anisotropic {
                conductivity,
                ratio,
            }
            .into());
        }
        Ok(Self {
            influence: influence.clone(),
            horizon,
            factors,
        })
    }

    /// Returns κ of a bond for unit conductivity, 1/m⁵.
    pub fn value(&self, xi: [f64; 3]) -> f64 {
        let square: f64 = xi.iter().map(|x| x * x).sum();
        let [first, ..] = self.factors;
        let along = match self.factors.iter().all(|m| *m == first || *m == 0.0) {
            true => first,
            false => (0..3).map(|a| self.factors[a] * xi[a] * xi[a]).sum::<f64>() / square,
        };
        along * self.influence.alpha_of(xi, self.horizon) / square.sqrt()
    }

    /// Horizon δ, m.
    pub fn horizon(&self) -> f64 {
        self.horizon
    }
}

fn check(influence: &Influence, horizon: f64, dimension: usize) -> Result<()> {
    positive("the horizon", horizon)?;
    influence.check(dimension, horizon)?;
    match influence.is_signed(horizon) {
        true => Err(HeatError::NegativeInfluence.into()),
        false => Ok(()),
    }
}

/// Returns the volume of a cell of a lattice, m³: the volume of its points, which are equal.
pub(crate) fn cell_volume(cloud: &PointCloud) -> f64 {
    let sides = (0..cloud.dimension()).map(|c| cloud.cell_side(c));
    // A process may own no points of a divided body.
    let first = cloud.volumes().first().copied();
    first.unwrap_or_else(|| cloud.section() * sides.product::<f64>())
}

/// Calls `visit(steps, ξ, |ξ|)` for all offsets of a lattice up to a length, x fastest.
pub(crate) fn for_each_offset(
    spacing: [f64; 3],
    dimension: usize,
    reach: f64,
    visit: &mut dyn FnMut([i32; 3], [f64; 3], f64),
) {
    let most: [i32; 3] = std::array::from_fn(|c| match c < dimension {
        true => (reach / spacing[c] * (1.0 + 1e-12)).floor() as i32,
        false => 0,
    });
    for z in -most[2]..=most[2] {
        for y in -most[1]..=most[1] {
            for x in -most[0]..=most[0] {
                let steps = [x, y, z];
                let xi: [f64; 3] = std::array::from_fn(|c| f64::from(steps[c]) * spacing[c]);
                let r = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
                if steps != [0; 3] && r <= reach {
                    visit(steps, xi, r);
                }
            }
        }
    }
}

/// Solves Σ_b sums_ab m_b = 2 by Gaussian elimination of a positive definite matrix.
fn solve(d: usize, sums: &mut [[f64; 3]; 3], factors: &mut [f64; 3]) {
    let mut right = [2.0; 3];
    for k in 0..d {
        for i in k + 1..d {
            let ratio = sums[i][k] / sums[k][k];
            for j in k..d {
                sums[i][j] -= ratio * sums[k][j];
            }
            right[i] -= ratio * right[k];
        }
    }
    for i in (0..d).rev() {
        let known: f64 = (i + 1..d).map(|j| sums[i][j] * factors[j]).sum();
        factors[i] = (right[i] - known) / sums[i][i];
    }
}
