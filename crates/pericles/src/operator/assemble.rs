//! Bodies of one bond-based material, and the choice between list and stencil kernels.

use std::sync::Arc;

use super::limits::{Feature, Features, Limit};
use super::{BondForce, BondForm, Breaking, DamageMeasure, Force, GridForce, VectorLaw};
use crate::error::Result;
use crate::family::{BondCut, BondList, Crack, EndRule};
use crate::lanes::LANES;
use crate::material::{BondConstants, BondMaterial};
use crate::space::{PointCloud, check_length};

/// A body of one bond-based material: the input of its force operator.
#[derive(Debug, Clone)]
pub struct BondBody<'a> {
    /// The points.
    pub cloud: &'a Arc<PointCloud>,
    /// The material.
    pub material: &'a BondMaterial,
    /// Bond constants of the material on this body.
    pub constants: &'a BondConstants,
    /// Pre-cracks.
    pub cracks: &'a [(Crack, EndRule)],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
    /// Stiffness of each point relative to the material; empty if uniform. A bond has the mean stiffness of
    /// its ends.
    pub stiffness: &'a [f64],
    /// Definition of damage.
    pub damage: DamageMeasure,
}

/// A force operator and the bonds that each pre-crack removed.
pub struct AssembledBonds {
    /// The operator.
    pub operator: Box<dyn Force>,
    /// Removed bonds of each pre-crack.
    pub cuts: Vec<BondCut>,
    /// Selected kernel, never [`BondForm::Fastest`].
    pub form: BondForm,
}

/// Number of places of the padded box per point above which the list is faster: the box is mostly empty, or
/// very short along x.
const SPARSE: usize = 8;

impl<'a> BondBody<'a> {
    /// Creates a body of uniform stiffness without pre-cracks, in which all bonds may break, with the default
    /// damage measure.
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
    /// Returns the features of the body that not every kernel supports.
    pub fn features(&self) -> Features {
        let breaks = self.constants.critical_stretch.is_finite();
        Features::of_points(self.material.law, self.cloud)
            .with(Feature::Breaking, breaks)
            .with(Feature::PreCracks, !self.cracks.is_empty())
            .with(Feature::Inclusions, !self.stiffness.is_empty())
    }

    /// Returns the stencil operator of a body that consists of the material only.
    pub(super) fn grid_of_material<L: VectorLaw, const D: usize>(&self) -> Result<GridForce<L, D>> {
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

    /// Returns the families without bonds cut by pre-cracks, and the bonds removed by each crack.
    pub(super) fn families(&self) -> Result<(BondList, Vec<BondCut>)> {
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

    /// Returns the list operator and the bonds removed by each pre-crack.
    ///
    /// # Errors
    /// A horizon without neighbours, an invalid crack.
    pub fn list<L: VectorLaw, const D: usize>(&self) -> Result<(BondForce<L, D>, Vec<BondCut>)> {
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

/// Returns the faster of grid and list for a body with these features.
pub(super) fn fastest_form(cloud: &PointCloud, features: Features) -> BondForm {
    let rejected = Limit::rejection(BondForm::Grid.limits(), features).is_some();
    match !rejected && fills_lattice(cloud) {
        true => BondForm::Grid,
        false => BondForm::List,
    }
}

/// Returns whether the points of the whole body lie on a lattice and fill enough of its bounding box for a stencil. All
/// processes must call it together.
pub(super) fn fills_lattice(cloud: &PointCloud) -> bool {
    cloud.lattice().is_some_and(|lattice| {
        let [x, y, z] = lattice.shape;
        let places = x.next_multiple_of(LANES) * y * z;
        places <= SPARSE * cloud.domain().whole_points().max(LANES)
    })
}
