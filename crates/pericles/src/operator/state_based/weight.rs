//! Weights of the bonds of a neighbour list, without a number per bond where possible.

use crate::family::{BondList, VolumeCorrection};
use crate::kernel::{Influence, InfluenceFunction};
use crate::lanes::Lanes;
use crate::operator::list::stiffness::{Formula, Stiffness};
use crate::space::PointCloud;

/// ω = w b V (influence function, partial volume and volume of the neighbour) of each entry of a list, or
/// only w.
#[derive(Debug, Clone)]
pub(super) struct Weight {
    values: Stiffness,
    /// Inverse horizon, m⁻¹, if w is `values` divided by the length of the bond.
    over_length: Option<f64>,
}

impl Weight {
    /// Creates weights w b V.
    pub fn of_volumes(cloud: &PointCloud, bonds: &BondList, influence: &Influence) -> Self {
        Self::new(cloud, bonds, influence, bonds.correction(), &|a, b| {
            bonds.volume_factor(a, b) * bonds.volume(b)
        })
    }

    /// Creates weights w, with unit volumes of neighbours.
    pub fn of_influence(cloud: &PointCloud, bonds: &BondList, influence: &Influence) -> Self {
        Self::new(cloud, bonds, influence, VolumeCorrection::None, &|_, _| 1.0)
    }

    fn new(
        cloud: &PointCloud,
        bonds: &BondList,
        influence: &Influence,
        correction: VolumeCorrection,
        volume: &(dyn Fn(usize, usize) -> f64 + Sync),
    ) -> Self {
        let horizon = bonds.horizon();
        let first_degree = bonds
            .uniform_horizon()
            .and_then(|horizon| first_degree(&influence.function, horizon));
        let Some((coefficients, over_length)) = first_degree else {
            let weight = |i: usize, b: usize| {
                let a = bonds.site(i);
                influence.alpha_of(bonds.vector(a, b), horizon) * volume(a, b)
            };
            return Self {
                values: Stiffness::of_pairs(bonds, &weight),
                over_length: None,
            };
        };
        let formula = Formula::of_first_degree(cloud, correction, horizon, coefficients);
        Self {
            values: Stiffness::Formula(formula),
            over_length: over_length.then_some(1.0 / horizon),
        }
    }

    /// Returns the weights of the eight bonds of a group with the lengths r = 1/`inverse`; `cells` are the
    /// cell sizes of the point and of its neighbours.
    #[inline(always)]
    pub fn of_group<T: Lanes>(
        &self,
        group: usize,
        r: T,
        inverse: T,
        volume: T,
        cells: [T; 2],
    ) -> T {
        let values = self.values.of_group(group, r, volume, cells);
        match self.over_length {
            // Cells beyond the horizon that overlap with it have the value at the horizon.
            Some(least) => values * inverse.max(T::splat(least)),
            None => values,
        }
    }

    /// Returns the weight of an entry of length r.
    pub fn of_entry(&self, entry: usize, r: f64, volume: f64, cells: [f64; 2]) -> f64 {
        let value = self.values.of_entry(entry, r, volume, cells);
        match self.over_length {
            Some(least) => value * (1.0 / r).max(least),
            None => value,
        }
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        self.values.bytes()
    }
}

/// Returns the coefficients a₀ and a₁ of w = a₀ + a₁ r, or of w = (a₀ + a₁ r)/r if the flag is set; `None`
/// for other forms.
fn first_degree(function: &InfluenceFunction, horizon: f64) -> Option<([f64; 2], bool)> {
    match function {
        InfluenceFunction::Constant => Some(([1.0, 0.0], false)),
        InfluenceFunction::Conical => Some(([1.0, -1.0 / horizon], false)),
        InfluenceFunction::Inverse => Some(([1.0, 0.0], true)),
        InfluenceFunction::Tabulated { table } => match table[..] {
            [(start, first), (end, last)] if start == 0.0 && end >= horizon => {
                Some(([first, (last - first) / end], false))
            }
            _ => None,
        },
        _ => None,
    }
}
