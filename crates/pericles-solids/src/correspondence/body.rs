//! Bodies of correspondence materials.

use std::sync::Arc;

use pericles::Result;
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::material::Materials;
use pericles::operator::{AssembledBonds, BondForm, DamageMeasure, Feature, Features, Limit};
use pericles::space::PointCloud;

use super::force_state::ForceState;
use super::material::CorrespondenceConstants;
use crate::solid::SolidBody;

/// A body of correspondence materials: the input of its force operator.
#[derive(Debug, Clone)]
pub struct CorrespondenceBody<'a> {
    /// The points.
    pub cloud: &'a Arc<PointCloud>,
    /// Constants of the material, which has the horizon and influence function of the body.
    pub constants: &'a CorrespondenceConstants,
    /// Materials of points and bonds, if there are several.
    pub classes: Option<&'a Materials<CorrespondenceConstants>>,
    /// Partial volumes at the horizon.
    pub volume_correction: VolumeCorrection,
    /// Pre-cracks, which are cut before shape tensors are computed.
    pub cracks: &'a [(Crack, EndRule)],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
    /// Weights of bonds in the damage.
    pub damage: DamageMeasure,
}

/// Features that correspondence bodies do not support.
const LIMITS: &[Limit] = &[
    Limit::new(
        Feature::Inclusions,
        "inclusions scale the stiffness of bonds, which correspondence materials do not have; assign a material with its own elastic constants",
    ),
    Limit::new(
        Feature::SurfaceCorrection,
        "the shape tensor of a correspondence material already accounts for missing bonds, so that the stress of a uniform deformation is exact at surfaces",
    ),
    Limit::new(
        Feature::SeveralSpacings,
        "correspondence materials require cells of one size; remove `body.refine` or use a bond-based model",
    ),
    Limit::new(
        Feature::GaussNodes,
        "Gauss nodes require a linear bond-based bar; remove `quadrature`",
    ),
];

/// Features that stencils do not support.
const ON_GRID: &[Limit] = &[Limit::CORRESPONDENCE];

impl<'a> CorrespondenceBody<'a> {
    /// Returns the reason why correspondence materials do not support these features; `None` if they do.
    pub fn rejection(features: Features) -> Option<&'static str> {
        Limit::rejection(LIMITS, features)
    }

    /// Returns the features that a form of such bodies does not support; the fastest form is the list.
    pub fn limits(form: BondForm) -> &'static [Limit] {
        match form {
            BondForm::Fastest | BondForm::List => &[],
            BondForm::Grid | BondForm::FloatGrid => ON_GRID,
        }
    }

    /// Creates a body of one material without pre-cracks and without unbreakable bonds.
    pub fn new(
        cloud: &'a Arc<PointCloud>,
        constants: &'a CorrespondenceConstants,
        volume_correction: VolumeCorrection,
    ) -> Self {
        Self {
            cloud,
            constants,
            classes: None,
            volume_correction,
            cracks: &[],
            no_fail: &[],
            damage: DamageMeasure::default(),
        }
    }

    /// Creates the force operator.
    ///
    /// # Errors
    /// A form other than the list, a horizon without neighbours, an invalid crack, materials for another
    /// number of points, points whose bonds do not span the space.
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        let features = Features::from(Feature::Correspondence);
        Limit::check(Self::limits(form), form.name(), features)?;
        match self.constants.stabilisation.is_tensor() {
            true => self.assembled::<true>(),
            false => self.assembled::<false>(),
        }
    }

    fn assembled<const TENSOR: bool>(&self) -> Result<AssembledBonds> {
        let materials = match self.classes {
            Some(classes) => classes.clone(),
            None => self.constants.clone().uniform(),
        };
        let body = SolidBody {
            cloud: self.cloud,
            materials: materials.map(|_, own| ForceState::<TENSOR>(own)),
            horizon: self.constants.solid.horizon,
            influence: &self.constants.solid.influence,
            volume_correction: self.volume_correction,
            cracks: self.cracks,
            no_fail: self.no_fail,
            damage: self.damage,
        };
        match self.cloud.dimension() {
            1 => body.operator::<1>(),
            2 => body.operator::<2>(),
            _ => body.operator::<3>(),
        }
    }
}
