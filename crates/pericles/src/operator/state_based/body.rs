//! Bodies of linear peridynamic solids.

use std::sync::Arc;

use super::force::LinearSolidForce;
use super::kinematics::{FiniteStrain, Kinematics, SmallStrain};
use crate::error::{PericlesError, Result};
use crate::family::{BondList, Crack, Cut, EndRule, VolumeCorrection};
use crate::material::{LinearSolidConstants, SolidClasses, SolidSurface, Strains};
use crate::operator::{DamageMeasure, Feature, Features, Force, Limit, TwoPassForce};
use crate::space::PointCloud;

/// A body of linear peridynamic solids: all that its operator is made of.
#[derive(Debug, Clone)]
pub struct LinearSolidBody<'a> {
    /// The points.
    pub cloud: &'a Arc<PointCloud>,
    /// The constants of the body's material, whose horizon and influence function are those of the body.
    pub constants: &'a LinearSolidConstants,
    /// The materials of the points and of the bonds between them, if there are several.
    pub classes: Option<&'a SolidClasses>,
    /// Partial volumes at the horizon.
    pub volume_correction: VolumeCorrection,
    /// How extensions follow from displacements.
    pub strains: Strains,
    /// Correction of surfaces.
    pub surface: SolidSurface,
    /// Pre-cracks, cut before weighted volumes are computed.
    pub cracks: &'a [(Crack, EndRule)],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
    /// How damage weighs bonds.
    pub damage: DamageMeasure,
}

/// What state-based bodies do not represent.
const LIMITS: &[Limit] = &[
    Limit::new(
        Feature::Inclusions,
        "inclusions scale the stiffness of bonds, which state-based materials do not have; assign a material with elastic constants of its own",
    ),
    Limit::new(
        Feature::SeveralSpacings,
        "state-based materials need cells of one size; leave `body.refine` out or use a bond-based model",
    ),
    Limit::new(
        Feature::GaussNodes,
        "Gauss nodes belong to linear bond-based bars; leave `quadrature` out",
    ),
];

impl<'a> LinearSolidBody<'a> {
    /// Why a body with these features cannot be state-based; none if it can.
    pub fn refusal(features: Features) -> Option<&'static str> {
        Limit::refusal(LIMITS, features)
    }

    /// A body of one material without pre-cracks, all of whose bonds may break, for displacements of any size.
    pub fn new(
        cloud: &'a Arc<PointCloud>,
        constants: &'a LinearSolidConstants,
        volume_correction: VolumeCorrection,
    ) -> Self {
        Self {
            cloud,
            constants,
            classes: None,
            volume_correction,
            strains: Strains::Finite,
            surface: SolidSurface::None,
            cracks: &[],
            no_fail: &[],
            damage: DamageMeasure::default(),
        }
    }

    /// The operator, and what each pre-crack removed.
    ///
    /// # Errors
    /// A horizon that reaches no neighbour, an unusable crack, materials of another number of points.
    pub fn operator(&self) -> Result<(Box<dyn Force>, Vec<Cut>)> {
        match (self.strains, self.cloud.dimension()) {
            (Strains::Finite, 1) => self.listed::<FiniteStrain, 1>(),
            (Strains::Finite, 2) => self.listed::<FiniteStrain, 2>(),
            (Strains::Finite, _) => self.listed::<FiniteStrain, 3>(),
            (Strains::Small, 1) => self.listed::<SmallStrain, 1>(),
            (Strains::Small, 2) => self.listed::<SmallStrain, 2>(),
            (Strains::Small, _) => self.listed::<SmallStrain, 3>(),
        }
    }

    fn listed<L: Kinematics, const D: usize>(&self) -> Result<(Box<dyn Force>, Vec<Cut>)> {
        let (force, cuts) = self.solid::<L, D>()?;
        let operator = TwoPassForce::new(self.cloud.clone(), force);
        Ok((Box::new(operator), cuts))
    }

    /// The force in two passes of which [`LinearSolidBody::operator`] makes an operator, and what each pre-crack removed.
    ///
    /// # Errors
    /// Those of [`LinearSolidBody::operator`].
    ///
    /// # Panics
    /// If the body has another dimension than D.
    pub fn solid<L: Kinematics, const D: usize>(
        &self,
    ) -> Result<(LinearSolidForce<L, D>, Vec<Cut>)> {
        let mut bonds = BondList::new(self.cloud, self.constants.horizon, self.volume_correction)?;
        let cut = |(crack, rule): &(Crack, EndRule)| bonds.cut(crack, *rule);
        let cuts = self.cracks.iter().map(cut).collect::<Result<Vec<_>>>()?;
        let classes = match self.classes {
            Some(classes) => classes.clone(),
            None => SolidClasses::uniform(self.constants),
        };
        if !classes.covers(self.cloud.len()) {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of points of the body",
                value: self.cloud.len() as f64,
                allowed: "as many points as have a material",
            });
        }
        let force = LinearSolidForce::new(
            self.cloud.clone(),
            bonds,
            &self.constants.influence,
            classes,
            self.no_fail,
            self.damage,
        );
        let force = force.with_surface(self.surface, &self.constants.influence);
        Ok((force, cuts))
    }
}
