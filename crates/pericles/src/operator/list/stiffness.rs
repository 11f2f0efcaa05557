//! Stiffness of the bonds of a neighbour list, without a number per bond where possible.

use std::collections::HashMap;

use crate::family::{BondList, VolumeCorrection};
use crate::kernel::{ActsOn, Influence, InfluenceFunction};
use crate::lanes::LANES;
use crate::lanes::{F64x8, Lanes, Real};
use crate::parallel::for_each_point;
use crate::space::PointCloud;

/// c α κ V of the neighbour for each entry of a list.
#[derive(Debug, Clone)]
pub(in crate::operator) enum Stiffness {
    /// Computed from the length of the bond and the volume of the neighbour.
    Formula(Formula),
    /// One of at most 256 values, as for the bonds of a lattice.
    Coded { codes: Vec<u8>, values: Vec<f64> },
    /// One number of 8 bytes per entry.
    Each(Vec<f64>),
}

/// The formula c (a₀ + a₁ min(r, δ)) κ(r) V.
#[derive(Debug, Clone)]
pub(in crate::operator) struct Formula {
    constant: f64,
    slope: f64,
    horizon: f64,
    correction: Option<Cells>,
}

/// Cell sizes, for partial volumes at the horizon.
#[derive(Debug, Clone, Copy)]
enum Cells {
    /// All cells have the same size; its inverse, m⁻¹.
    Equal { inverse: f64 },
    /// One size per point, stored with its displacement.
    Own,
}

impl Formula {
    /// Returns the formula of a material with constant c on a list of one horizon, if its influence function
    /// is of first degree.
    pub fn new(
        cloud: &PointCloud,
        correction: VolumeCorrection,
        horizon: f64,
        micromodulus: f64,
        influence: &Influence,
    ) -> Option<Self> {
        let (constant, slope) = match (&influence.function, influence.acts_on) {
            (InfluenceFunction::Constant, ActsOn::Stretch)
            | (InfluenceFunction::Inverse, ActsOn::Displacement) => (1.0, 0.0),
            (InfluenceFunction::Constant, ActsOn::Displacement) => (0.0, 1.0),
            (InfluenceFunction::Conical, ActsOn::Stretch) => (1.0, -1.0 / horizon),
            _ => return None,
        };
        Some(Self::of_first_degree(
            cloud,
            correction,
            horizon,
            [micromodulus * constant, micromodulus * slope],
        ))
    }

    /// Creates the formula with given coefficients a₀ and a₁.
    pub fn of_first_degree(
        cloud: &PointCloud,
        correction: VolumeCorrection,
        horizon: f64,
        [constant, slope]: [f64; 2],
    ) -> Self {
        let domain = cloud.domain();
        let largest = (0..cloud.len()).fold(0.0, |most: f64, i| most.max(cloud.cell_size(i)));
        let first = domain.max(largest);
        let equal = domain.all((0..cloud.len()).all(|i| cloud.cell_size(i) == first));
        Self {
            constant,
            slope,
            horizon,
            correction: match correction {
                VolumeCorrection::None => None,
                _ if equal => Some(Cells::Equal {
                    inverse: 1.0 / first,
                }),
                _ => Some(Cells::Own),
            },
        }
    }

    /// Returns the stiffness of eight bonds of length r; `cells` are the cell sizes of the point and of its
    /// neighbours.
    #[inline(always)]
    fn of<T: Lanes>(&self, r: T, volume: T, cells: [T; 2]) -> T {
        let horizon = T::splat(self.horizon);
        let shape = T::splat(self.slope).mul_add(r.min(horizon), T::splat(self.constant));
        let one = T::splat(1.0);
        let half = T::splat(0.5);
        let kappa = match self.correction {
            None => return shape * volume,
            // No bond is long enough for a negative factor.
            Some(Cells::Equal { inverse }) => (horizon - r).mul_add(T::splat(inverse), half),
            Some(Cells::Own) => {
                let kappa = (horizon - r) / (half * (cells[0] + cells[1])) + half;
                kappa.max(T::splat(0.0))
            }
        };
        shape * volume * kappa.min(one)
    }
}

impl Stiffness {
    /// Stores up to 256 distinct values as codes, otherwise all values.
    pub fn of_values(values: Vec<f64>) -> Self {
        let mut codes = HashMap::new();
        let mut coded = Vec::with_capacity(values.len());
        let mut last = (values.first().map_or(0, |value| value.to_bits()), None);
        for value in &values {
            let bits = value.to_bits();
            if last.0 != bits || last.1.is_none() {
                let next = codes.len();
                last = (bits, Some(*codes.entry(bits).or_insert(next)));
            }
            match last.1 {
                Some(code) if code <= usize::from(u8::MAX) => coded.push(code as u8),
                _ => return Self::Each(values),
            }
        }
        let mut table = vec![0.0; codes.len()];
        for (bits, code) in codes {
            table[code] = f64::from_bits(bits);
        }
        Self::Coded {
            codes: coded,
            values: table,
        }
    }

    /// Evaluates a function of the point and the site of each entry, in parallel.
    pub fn of_pairs(bonds: &BondList, of: &(dyn Fn(usize, usize) -> f64 + Sync)) -> Self {
        let rows = for_each_point(bonds.len(), &|i| {
            let first = bonds.start()[i] * LANES;
            let mut row = vec![0.0; bonds.start()[i + 1] * LANES - first];
            for (entry, j) in bonds.family(i) {
                row[entry - first] = of(i, j);
            }
            row
        });
        Self::of_values(rows.concat())
    }

    /// Returns the stiffness of the eight bonds of a group; see [`Formula`].
    #[inline(always)]
    pub fn of_group<T: Lanes>(&self, group: usize, r: T, volume: T, cells: [T; 2]) -> T {
        match self {
            Self::Formula(formula) => formula.of(r, volume, cells),
            Self::Coded { codes, values } => {
                let codes = &codes[group * LANES..(group + 1) * LANES];
                let mut numbers = [0.0; LANES];
                for k in 0..LANES {
                    numbers[k] = values[usize::from(codes[k])];
                }
                T::load(&numbers, 0)
            }
            Self::Each(values) => T::load(values, group * LANES),
        }
    }

    /// Returns the stiffness of an entry.
    pub fn of_entry(&self, entry: usize, r: f64, volume: f64, cells: [f64; 2]) -> f64 {
        match self {
            Self::Formula(formula) => {
                let lanes = F64x8::splat;
                formula.of(lanes(r), lanes(volume), cells.map(lanes)).0[0]
            }
            Self::Coded { codes, values } => values[usize::from(codes[entry])],
            Self::Each(values) => values[entry],
        }
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Formula(_) => 0,
            Self::Coded { codes, values } => codes.len() + size_of_val(&values[..]),
            Self::Each(values) => size_of_val(&values[..]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn at_most_256_values_are_stored_as_codes() {
        let few: Vec<f64> = (0..5000).map(|k| f64::from(k % 256)).collect();
        let many: Vec<f64> = (0..5000).map(|k| f64::from(k % 257)).collect();
        let Stiffness::Coded { codes, values } = Stiffness::of_values(few.clone()) else {
            panic!("256 values fit a byte");
        };
        let back: Vec<f64> = codes.iter().map(|&c| values[usize::from(c)]).collect();
        assert_eq!(back, few);
        assert!(matches!(Stiffness::of_values(many), Stiffness::Each(_)));
    }
}
