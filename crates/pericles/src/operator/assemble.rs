//! The choice of an operator's form for a body.

use std::sync::Arc;

use super::limits::{Feature, Features, Limit};
use super::{BondForce, BondForm, Breaking, DamageMeasure, FastLaw, Force, GridForce};
use crate::error::Result;
use crate::family::{BondList, Crack, Cut, EndRule};
use crate::lanes::LANES;
use crate::material::{BondConstants, BondMaterial};
use crate::space::{PointCloud, check_length};

/// A body of one bond-based material: all that its operator is made of.
#[derive(Debug, Clone)]
pub struct BondBody<'a> {
    /// The points.
    pub cloud: &'a Arc<PointCloud>,
    /// The material.
    pub material: &'a BondMaterial,
    /// Its constants on this body.
    pub constants: &'a BondConstants,
    /// Pre-cracks.
    pub cracks: &'a [(Crack, EndRule)],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
    /// Stiffness of each point over the material's; empty if all are the same. A bond has the mean of its ends.
    pub stiffness: &'a [f64],
    /// How damage weighs bonds.
    pub damage: DamageMeasure,
}

/// An operator, and what each pre-crack removed from it.
pub struct AssembledBonds {
    /// The operator.
    pub operator: Box<dyn Force>,
    /// One for each pre-crack.
    pub cuts: Vec<Cut>,
    /// The form taken, never [`BondForm::Fastest`].
    pub form: BondForm,
}

/// Places of the padded box per point above which the list is better: the box is mostly empty, or very short along x.
const SPARSE: usize = 8;

impl<'a> BondBody<'a> {
    /// A body without pre-cracks, of one stiffness, all of whose bonds may break, with the default measure of damage.
    pub fn new(
        cloud: &'a Arc<PointCloud>,
        material: &'a BondMaterial,
        constants: &'a BondConstants,
    ) -> Self {
        Self {
            cloud,
            material,
            constants,
            cracks: &[],
            no_fail: &[],
            stiffness: &[],
            damage: DamageMeasure::default(),
        }
    }
}

impl BondBody<'_> {
    /// What the body has that not every form represents.
    pub fn features(&self) -> Features {
        let breaks = self.constants.critical_stretch.is_finite();
        Features::of_points(self.material.law, self.cloud)
            .with(Feature::Breaking, breaks)
            .with(Feature::PreCracks, !self.cracks.is_empty())
            .with(Feature::Inclusions, !self.stiffness.is_empty())
    }

    /// The grid operator of the material itself everywhere.
    pub(super) fn grid_of_material<L: FastLaw, const D: usize>(&self) -> Result<GridForce<L, D>> {
        GridForce::new(
            self.cloud.clone(),
            self.material,
            self.constants,
            self.cracks,
            self.no_fail,
            self.damage,
        )
    }

    pub(super) fn check_stiffness(&self) -> Result<()> {
        match self.stiffness {
            [] => Ok(()),
            given => check_length(
                "the stiffnesses of the points",
                given.len(),
                self.cloud.len(),
            ),
        }
    }

    /// The families without the bonds that pre-cracks cut, and what each crack removed.
    pub(super) fn families(&self) -> Result<(BondList, Vec<Cut>)> {
        self.check_stiffness()?;
        let material = self.material;
        let mut bonds = BondList::new(self.cloud, material.horizon, material.volume_correction)?;
        let cuts = self
            .cracks
            .iter()
            .map(|(crack, rule)| bonds.cut(crack, *rule))
            .collect::<Result<_>>()?;
        Ok((bonds, cuts))
    }

    /// The list operator, and what each pre-crack removed from it.
    ///
    /// # Errors
    /// A horizon that reaches no neighbour, an unusable crack.
    pub fn list<L: FastLaw, const D: usize>(&self) -> Result<(BondForce<L, D>, Vec<Cut>)> {
        let material = self.material;
        let (bonds, cuts) = self.families()?;
        let constants = self.constants;
        let stiffness = self.cloud.domain().with_ghosts(self.stiffness);
        let mean = |i: usize, j: usize| match &stiffness[..] {
            [] => 1.0,
            stiffness => 0.5 * (stiffness[i] + stiffness[j]),
        };
        let list = BondForce::with_pair_stiffness(
            self.cloud.clone(),
            bonds,
            &|i, j, xi| {
                let alpha = material.influence.alpha_of(xi, material.horizon);
                mean(i, j) * (constants.micromodulus * alpha)
            },
            Breaking {
                critical_stretch: constants.critical_stretch,
                no_fail: self.no_fail,
            },
            self.damage,
        )?;
        Ok((list, cuts))
    }
}

/// The faster of grid and list for a body with these features.
pub(super) fn fastest_form(cloud: &PointCloud, features: Features) -> BondForm {
    let refused = Limit::refusal(BondForm::Grid.limits(), features).is_some();
    match !refused && fills_lattice(cloud) {
        true => BondForm::Grid,
        false => BondForm::List,
    }
}

/// Whether the points lie on a lattice and fill its box well enough for a stencil.
pub(super) fn fills_lattice(cloud: &PointCloud) -> bool {
    cloud.lattice().is_some_and(|lattice| {
        let [x, y, z] = lattice.shape;
        let places = x.next_multiple_of(LANES) * y * z;
        places <= SPARSE * cloud.len().max(LANES)
    })
}
