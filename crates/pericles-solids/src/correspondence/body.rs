//! Bodies of correspondence materials.

use std::sync::Arc;

use pericles::family::{BondList, Crack, Cut, EndRule, VolumeCorrection};
use pericles::operator::{
    AssembledBonds, BondForm, DamageMeasure, Feature, Features, Limit, TwoPassForce,
};
use pericles::space::PointCloud;
use pericles::{PericlesError, Result};

use super::classes::CorrespondenceClasses;
use super::force::CorrespondenceForce;
use super::material::CorrespondenceConstants;

/// A body of correspondence materials: all that its operator is made of.
#[derive(Debug, Clone)]
pub struct CorrespondenceBody<'a> {
    /// The points.
    pub cloud: &'a Arc<PointCloud>,
    /// The constants of the body's material, whose horizon and influence function are those of the body.
    pub constants: &'a CorrespondenceConstants,
    /// The materials of the points and of the bonds between them, if there are several.
    pub classes: Option<&'a CorrespondenceClasses>,
    /// Partial volumes at the horizon.
    pub volume_correction: VolumeCorrection,
    /// Pre-cracks, cut before shape tensors are computed.
    pub cracks: &'a [(Crack, EndRule)],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
    /// How damage weighs bonds.
    pub damage: DamageMeasure,
}

/// What correspondence bodies do not represent.
const LIMITS: &[Limit] = &[
    Limit::new(
        Feature::Inclusions,
        "inclusions scale the stiffness of bonds, which correspondence materials do not have; assign a material with elastic constants of its own",
    ),
    Limit::new(
        Feature::SurfaceCorrection,
        "the shape tensor of a correspondence material accounts for missing bonds already: a uniform deformation has the right stress at surfaces too",
    ),
    Limit::new(
        Feature::SeveralSpacings,
        "correspondence materials need cells of one size; leave `body.refine` out or use a bond-based model",
    ),
    Limit::new(
        Feature::GaussNodes,
        "Gauss nodes belong to linear bond-based bars; leave `quadrature` out",
    ),
    Limit::new(
        Feature::BondEnergy,
        "bonds of correspondence materials break by their stretch; leave `failure` out or give \"stretch\"",
    ),
];

/// What stencils do not represent.
const ON_GRID: &[Limit] = &[Limit::CORRESPONDENCE];

impl<'a> CorrespondenceBody<'a> {
    /// Why a body with these features cannot be of correspondence materials; none if it can.
    pub fn refusal(features: Features) -> Option<&'static str> {
        Limit::refusal(LIMITS, features)
    }

    /// What a form of such bodies does not represent; the fastest form is the list.
    pub fn limits(form: BondForm) -> &'static [Limit] {
        match form {
            BondForm::Fastest | BondForm::List => &[],
            BondForm::Grid | BondForm::FloatGrid => ON_GRID,
        }
    }

    /// A body of one material without pre-cracks, all of whose bonds may break.
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

    /// The operator.
    ///
    /// # Errors
    /// A form other than the list, a horizon that reaches no neighbour, an unusable crack, materials of another number of points, points whose bonds do not span the space.
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        let features = Features::from(Feature::Correspondence);
        Limit::check(Self::limits(form), form.name(), features)?;
        match self.cloud.dimension() {
            1 => self.assembled::<1>(),
            2 => self.assembled::<2>(),
            _ => self.assembled::<3>(),
        }
    }

    fn assembled<const D: usize>(&self) -> Result<AssembledBonds> {
        let (force, cuts) = self.list::<D>()?;
        Ok(AssembledBonds {
            operator: Box::new(TwoPassForce::new(self.cloud.clone(), force)),
            cuts,
            form: BondForm::List,
        })
    }

    /// The force in two passes, and what each pre-crack removed.
    ///
    /// # Errors
    /// Those of [`CorrespondenceBody::operator`].
    ///
    /// # Panics
    /// If the body has another dimension than D.
    pub fn list<const D: usize>(&self) -> Result<(CorrespondenceForce<D>, Vec<Cut>)> {
        let classes = match self.classes {
            Some(classes) => classes.clone(),
            None => CorrespondenceClasses::uniform(self.constants),
        };
        if !classes.covers(self.cloud.len()) {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of points of the body",
                value: self.cloud.len() as f64,
                allowed: "as many points as have a material",
            });
        }
        let horizon = self.constants.solid.horizon;
        let mut bonds = BondList::new(self.cloud, horizon, self.volume_correction)?;
        let cut = |(crack, rule): &(Crack, EndRule)| bonds.cut(crack, *rule);
        let cuts = self.cracks.iter().map(cut).collect::<Result<Vec<_>>>()?;
        let cloud = self.cloud.clone();
        let force = CorrespondenceForce::new(cloud, bonds, classes, self.no_fail, self.damage)?;
        Ok((force, cuts))
    }
}
