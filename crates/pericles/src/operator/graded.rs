//! Bonds of a body with cells of several sizes.

use std::sync::Arc;

use super::by_law::{ByLaw, by_law};
use super::{AssembledBonds, BondForce, BondForm, Breaking, DamageMeasure, FastLaw, Force};
use crate::error::{PericlesError, Result};
use crate::family::{BondList, Crack, Cut, EndRule, VolumeCorrection};
use crate::kernel::Influence;
use crate::material::{BondMaterial, Fracture, StressState};
use crate::space::{PointCloud, check_length};

/// What one grid of a body adds to the bonds of its points.
#[derive(Debug, Clone, PartialEq)]
pub struct EndLaw {
    /// Horizon δ of the grid, m.
    pub horizon: f64,
    /// Its constant c.
    pub micromodulus: f64,
}

/// A body of one material on grids of different spacing, each with a horizon of the same number of spacings.
///
/// Points i and j are bonded if |ξ| < max(δ_i, δ_j). The force of the bond is the mean of the laws of its ends, each nothing beyond its own horizon:
///
/// f_ij = ½ (c_i α(ξ/δ_i) κ_i + c_j α(ξ/δ_j) κ_j) s n,
///
/// so that both ends exert equal and opposite forces and momentum is conserved to round-off. A uniform strain is in balance inside each grid; within a horizon of an interface
/// there is a spurious force, for a point sees different grids on its two sides. It falls with the spacing over the length of what is of interest,
/// as the missing bonds at a free surface do.
#[derive(Debug, Clone)]
pub struct GradedBody<'a> {
    /// The points.
    pub cloud: &'a Arc<PointCloud>,
    /// Division of the cells of each grid, see [`GradedCloud`](crate::space::GradedCloud).
    pub ratios: &'a [u32],
    /// The grid of each point.
    pub grid_of_point: &'a [u8],
    /// The material with the horizon of the large cells.
    pub material: &'a BondMaterial,
    /// The state of stress.
    pub state: StressState,
    /// Pre-cracks.
    pub cracks: &'a [(Crack, EndRule)],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
    /// Stiffness of each point over the material's; empty if all are the same. A bond has the mean of its ends.
    pub stiffness: &'a [f64],
    /// How damage weighs bonds.
    pub damage: DamageMeasure,
}

impl GradedBody<'_> {
    /// The law of each grid.
    ///
    /// # Errors
    /// Those of [`BondMaterial::constants`]; a fracture energy.
    pub fn laws(&self) -> Result<Vec<EndLaw>> {
        let cloud = self.cloud;
        // A table per class names the bonds of one lattice, which this body is not.
        self.material.constants(cloud, self.state)?;
        if matches!(self.material.fracture, Fracture::Energy { .. }) {
            return Err(PericlesError::Graded {
                what: "a fracture energy",
                reason: "it belongs to another critical stretch for each horizon; give critical_stretch",
            });
        }
        let law = |&ratio: &u32| {
            let ratio = f64::from(ratio);
            let own = BondMaterial {
                horizon: self.material.horizon / ratio,
                ..self.material.clone()
            };
            let sides = vec![cloud.spacing() / ratio; cloud.dimension()];
            let constants = own.constants_on(&sides, cloud.section(), self.state)?;
            Ok(EndLaw {
                horizon: own.horizon,
                micromodulus: constants.micromodulus,
            })
        };
        self.ratios.iter().map(law).collect()
    }

    /// The operator, always a list.
    ///
    /// # Errors
    /// Those of [`GradedBody::laws`]; a horizon that reaches no neighbour, an unusable crack.
    pub fn operator(&self) -> Result<AssembledBonds> {
        by_law(self.material.law, self.cloud.dimension(), Listed(self))
    }

    fn list<L: FastLaw, const D: usize>(&self) -> Result<AssembledBonds> {
        let laws = self.laws()?;
        let cloud = self.cloud;
        check_length(
            "the grids of the points",
            self.grid_of_point.len(),
            cloud.len(),
        )?;
        let last = self.grid_of_point.iter().copied().max().unwrap_or(0);
        if usize::from(last) >= laws.len() {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of a point's grid",
                value: f64::from(last),
                allowed: "numbers of the grids given, from 0",
            });
        }
        let law_of = |grid: u8| &laws[usize::from(grid)];
        let grids = self.grid_of_point.iter();
        let horizons = grids.map(|&grid| law_of(grid).horizon).collect();
        let correction: VolumeCorrection = self.material.volume_correction;
        let mut bonds = BondList::with_horizons(cloud, horizons, correction)?;
        let cuts: Vec<Cut> = self
            .cracks
            .iter()
            .map(|(crack, rule)| bonds.cut(crack, *rule))
            .collect::<Result<_>>()?;
        let critical_stretch = match self.material.fracture {
            Fracture::CriticalStretch(stretch) => stretch,
            _ => f64::INFINITY,
        };
        let influence: &Influence = &self.material.influence;
        let sites = bonds.shared_sites();
        let grids: Vec<f64> = self.grid_of_point.iter().map(|&k| f64::from(k)).collect();
        let (grids, stiffness) = (sites.spread(&grids), sites.spread(self.stiffness));
        let law = |site: usize| law_of(grids[site] as u8);
        let end = |bonds: &BondList, i: usize, j: usize| {
            let EndLaw {
                horizon,
                micromodulus,
            } = law(i);
            match bonds.end_factor(i, j) {
                0.0 => 0.0,
                kappa => kappa * micromodulus * influence.alpha_of(bonds.vector(i, j), *horizon),
            }
        };
        let mean = |a: usize, b: usize| match &stiffness[..] {
            [] => 1.0,
            stiffness => 0.5 * (stiffness[a] + stiffness[b]),
        };
        let force = BondForce::<L, D>::with_weighted_stiffness(
            Arc::clone(cloud),
            bonds,
            &|bonds, i, j| mean(i, j) * 0.5 * (end(bonds, i, j) + end(bonds, j, i)),
            Breaking {
                critical_stretch,
                no_fail: self.no_fail,
            },
            self.damage,
        )?;
        let operator: Box<dyn Force> = Box::new(force);
        Ok(AssembledBonds {
            operator,
            cuts,
            form: BondForm::List,
        })
    }
}

/// Makes the list of a body.
struct Listed<'a>(&'a GradedBody<'a>);

impl ByLaw for Listed<'_> {
    type Output = AssembledBonds;

    fn any_form<L: FastLaw, const D: usize>(self) -> Result<AssembledBonds> {
        self.0.list::<L, D>()
    }

    fn listed<L: FastLaw, const D: usize>(self) -> Result<AssembledBonds> {
        self.0.list::<L, D>()
    }
}
