//! Energies of cracks along planes of the lattice.
//!
//! The critical stretch follows from the bonds that cross planes of the lattice, with the weights and volumes of the
//! body. The integral over the horizon would have an error of −18 to +4 % for a horizon of three spacings.

use std::fmt::{self, Display};

use super::BondMaterial;
use super::lattice::{Cells, for_each_offset};
use crate::family::VolumeCorrection;

/// A plane of the lattice and the energy of a crack along it.
///
/// The energy per area of the bonds across a plane with the unit normal n, each broken at the critical stretch, is
///
/// G = ½ c s₀² V Σ κ α |ξ| (ξ·n), summed over the bonds ξ of a point with ξ·n > 0,
///
/// with the cell volume V: ξ·n / V bonds ξ cross a unit area. The sum is exact for planes between rows of points.
#[derive(Debug, Clone, PartialEq)]
pub struct CrackPlane {
    /// Miller indices, 0 or 1, one for each axis: the normal is (h/Δx, k/Δy, l/Δz) over its length.
    indices: Vec<u8>,
    /// J/m².
    energy: f64,
}

impl CrackPlane {
    /// Returns the energy per area, J/m².
    pub fn energy(&self) -> f64 {
        self.energy
    }

    /// Returns the mean energy of the families of planes, J/m²: (10), (11) in 2D, (100), (110), (111) in 3D
    /// with equal weights. On cells of unequal sides, different planes of a family share its weight.
    pub fn mean(planes: &[Self]) -> f64 {
        Self::mean_of(planes, |k| planes[k].energy)
    }

    /// Returns the mean of a value of each plane, given by its number, with the weights of [`CrackPlane::mean`].
    pub(super) fn mean_of(planes: &[Self], value: impl Fn(usize) -> f64) -> f64 {
        let order = |plane: &Self| plane.indices.iter().filter(|index| **index > 0).count();
        let families: Vec<f64> = (1..=3)
            .filter_map(|number| {
                let of_family = (0..planes.len()).filter(|&k| order(&planes[k]) == number);
                let family: Vec<f64> = of_family.map(&value).collect();
                let sum: f64 = family.iter().sum();
                (!family.is_empty()).then(|| sum / family.len() as f64)
            })
            .collect();
        families.iter().sum::<f64>() / families.len() as f64
    }

    /// Returns the number of planes of the family between the end points of a bond, negative for bonds
    /// against the normal.
    pub(super) fn crossed(&self, offset: [i32; 3]) -> i32 {
        let indices = self.indices.iter().zip(offset);
        indices
            .map(|(index, steps)| i32::from(*index) * steps)
            .sum()
    }

    /// Returns the number of planes of the family per length along their normal, 1/m.
    pub(super) fn per_length(&self, cells: Cells<'_>) -> f64 {
        let normal = self.indices.iter().zip(cells.sides());
        let square: f64 = normal
            .map(|(index, side)| (f64::from(*index) / side).powi(2))
            .sum();
        square.sqrt()
    }

    /// Returns a vector along the normal, 1/m, on a lattice whose cells have these sides (m).
    pub(super) fn normal(&self, sides: &[f64]) -> [f64; 3] {
        std::array::from_fn(|c| match self.indices.get(c) {
            Some(index) => f64::from(*index) / sides[c],
            None => 0.0,
        })
    }

    /// Sets the energy, J/m².
    pub(super) fn with_energy(self, energy: f64) -> Self {
        Self { energy, ..self }
    }

    /// Multiplies the energy by a factor.
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            energy: factor * self.energy,
            ..self
        }
    }

    /// Returns the planes of a lattice with indices 0 and 1, with zero energy; on square and cubic lattices
    /// one plane for each family.
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

/// Sums over the bonds of a point in a lattice layer beside a crack. Each bond is weighted by its influence
/// function and partial volume, in units of the cell volume.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LayerMoments {
    /// Σ κ w ξ ⊗ ξ over all bonds, m².
    pub whole: [[f64; 3]; 3],
    /// Σ κ w ξ ⊗ ξ over the bonds that cross the crack, m².
    pub crossing: [[f64; 3]; 3],
    /// Σ κ w over all bonds.
    pub weight: f64,
}

impl CrackPlane {
    /// Returns the planes of a lattice whose cells have these sides (m), with crack energies per area from
    /// the energy density (J/m³) that a crack takes from the points of each adjacent layer. For materials whose
    /// energy is not a sum over bonds.
    ///
    /// The pair contains the horizon and the volume correction; `weight` is the influence function of a bond ξ.
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
            // From the layer farthest from the crack, on both sides.
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

/// Prints Miller indices, for example (110).
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
    /// Returns the planes of a lattice with the energy of a crack at s₀ = 1, J/m². `stiffness` is the
    /// constant c times the section.
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
            // ξ·n is the number of crossed planes times their distance.
            plane.energy *= 0.5 * stiffness * cells.volume() / plane.per_length(cells);
        }
        planes
    }
}
