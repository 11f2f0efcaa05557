//! What a crack along a plane of the lattice costs.

use std::fmt::{self, Display};

use super::BondMaterial;
use super::lattice::{Cells, for_each_offset};
use crate::family::VolumeCorrection;

/// A plane of the lattice with the energy that a crack along it takes.
///
/// The bonds that join the two sides of a plane with the unit normal n, each broken at the critical stretch, take per area
///
/// G = ½ c s₀² V Σ κ α |ξ| (ξ·n), over the bonds ξ of a point with ξ·n > 0,
///
/// with the volume V of a cell: a bond ξ crosses a unit area ξ·n / V times. The sum is exact for planes between rows of points.
#[derive(Debug, Clone, PartialEq)]
pub struct CrackPlane {
    /// Miller indices, each 0 or 1, one for each axis: the normal is (h/Δx, k/Δy, l/Δz) over its length.
    indices: Vec<u8>,
    /// J/m².
    energy: f64,
}

impl CrackPlane {
    /// The energy of a unit area, J/m².
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// The mean of the families of planes, J/m²: (10), (11) in 2D, (100), (110), (111) in 3D, each with the same weight. Planes of one family that
    /// differ, on cells of unequal sides, share the weight of their family.
    pub fn mean(planes: &[Self]) -> f64 {
        let order = |plane: &Self| plane.indices.iter().filter(|index| **index > 0).count();
        let families: Vec<f64> = (1..=3)
            .filter_map(|number| {
                let family: Vec<f64> = planes
                    .iter()
                    .filter(|plane| order(plane) == number)
                    .map(|plane| plane.energy)
                    .collect();
                let sum: f64 = family.iter().sum();
                (!family.is_empty()).then(|| sum / family.len() as f64)
            })
            .collect();
        families.iter().sum::<f64>() / families.len() as f64
    }

    /// How many planes of the family lie between the ends of a bond, negative where it runs against the normal.
    pub(super) fn crossed(&self, offset: [i32; 3]) -> i32 {
        let indices = self.indices.iter().zip(offset);
        indices
            .map(|(index, steps)| i32::from(*index) * steps)
            .sum()
    }

    /// Planes of the family per length, along their normal, 1/m.
    pub(super) fn per_length(&self, cells: Cells<'_>) -> f64 {
        let normal = self.indices.iter().zip(cells.sides());
        let square: f64 = normal
            .map(|(index, side)| (f64::from(*index) / side).powi(2))
            .sum();
        square.sqrt()
    }

    /// The same plane with another energy, J/m².
    pub(super) fn with_energy(self, energy: f64) -> Self {
        Self { energy, ..self }
    }

    /// The same plane with its energy times a factor.
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            energy: factor * self.energy,
            ..self
        }
    }

    /// The planes of a lattice with indices of 0 and 1, those of square and cubic lattices once for each family; energies are still to be found.
    pub(super) fn all(cells: Cells<'_>) -> Vec<Self> {
        let dimension = cells.sides().len();
        let mut planes: Vec<Self> = (1..1u8 << dimension)
            .map(|bits| Self {
                indices: (0..dimension).map(|c| bits >> c & 1).collect(),
                energy: 0.0,
            })
            .filter(|plane| !cells.is_cubic() || plane.indices.is_sorted_by(|a, b| a >= b))
            .collect();
        planes.sort_by_key(|plane| plane.indices.iter().sum::<u8>());
        planes
    }
}

/// Sums over the bonds of a point of a lattice in one of the layers beside a crack, each bond weighted by its influence function and partial volume, in units of the volume of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LayerMoments {
    /// Σ κ w ξ ⊗ ξ over all bonds, m².
    pub whole: [[f64; 3]; 3],
    /// The same over the bonds that cross the crack.
    pub crossing: [[f64; 3]; 3],
    /// Σ κ w over all bonds.
    pub weight: f64,
}

impl CrackPlane {
    /// The planes of a lattice whose cells have these sides (m), with the energy of a unit area of crack along each, from the energy density (J/m³) that a crack takes from the points of each layer beside it:
    /// materials whose points have an energy that is not a sum over bonds.
    ///
    /// `extent` is the horizon with the correction of volumes, `weight` the influence function of a bond ξ.
    pub fn by_layers(
        sides: &[f64],
        (horizon, correction): (f64, VolumeCorrection),
        weight: &dyn Fn([f64; 3]) -> f64,
        energy_density: &dyn Fn(&LayerMoments) -> f64,
    ) -> Vec<Self> {
        let cells = Cells::new(sides);
        let planes = Self::all(cells);
        let mut crossing: Vec<Vec<[[f64; 3]; 3]>> = vec![Vec::new(); planes.len()];
        let mut whole = LayerMoments::default();
        for_each_offset(cells, horizon, correction, |offset, xi, r| {
            let volume = correction.factor(r, horizon, cells.size());
            let weight = volume * weight(xi);
            whole.weight += weight;
            add_square(&mut whole.whole, weight, xi);
            for (plane, sums) in planes.iter().zip(&mut crossing) {
                let crossed = plane.crossed(offset).max(0) as usize;
                if crossed >= sums.len() {
                    sums.resize(crossed + 1, Default::default());
                }
                add_square(&mut sums[crossed], weight, xi);
            }
        });
        let energy = |plane: &Self, sums: &[[[f64; 3]; 3]]| {
            let mut layer = whole;
            // From the layer that is farthest from the crack, on both of its sides.
            let layers = sums[1..].iter().rev().map(|sum| {
                for (row, more) in layer
                    .crossing
                    .iter_mut()
                    .flatten()
                    .zip(sum.iter().flatten())
                {
                    *row += more;
                }
                2.0 * energy_density(&layer)
            });
            layers.sum::<f64>() / plane.per_length(cells)
        };
        let with_sums = planes.into_iter().zip(&crossing);
        with_sums
            .map(|(plane, sums)| {
                let energy = energy(&plane, sums);
                plane.with_energy(energy)
            })
            .collect()
    }
}

/// Adds `weight` ξ ⊗ ξ.
fn add_square(sum: &mut [[f64; 3]; 3], weight: f64, xi: [f64; 3]) {
    for (a, row) in sum.iter_mut().enumerate() {
        for (b, entry) in row.iter_mut().enumerate() {
            *entry += weight * xi[a] * xi[b];
        }
    }
}

/// Such as (110).
impl Display for CrackPlane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "(")?;
        self.indices
            .iter()
            .try_for_each(|index| write!(f, "{index}"))?;
        write!(f, ")")
    }
}

impl BondMaterial {
    /// The planes of a lattice with the energy of a crack at s₀ = 1, J/m². `stiffness` is the constant c times the section.
    pub(super) fn crack_planes(&self, cells: Cells<'_>, stiffness: f64) -> Vec<CrackPlane> {
        let mut planes = CrackPlane::all(cells);
        let size = cells.size();
        self.for_each_offset(cells, |offset, xi, r| {
            let kappa = self.volume_correction.factor(r, self.horizon, size);
            let weight = kappa * self.influence.alpha_of(xi, self.horizon) * r;
            for plane in &mut planes {
                plane.energy += weight * f64::from(plane.crossed(offset).max(0));
            }
        });
        for plane in &mut planes {
            // ξ·n is the number of planes crossed times their distance.
            plane.energy *= 0.5 * stiffness * cells.volume() / plane.per_length(cells);
        }
        planes
    }
}
