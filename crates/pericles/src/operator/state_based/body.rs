//! Bodies of linear peridynamic solids.

use std::sync::Arc;

use super::force::LinearSolidForce;
use super::grid::LinearSolidGrid;
use super::kinematics::{FiniteStrain, Kinematics, SmallStrain};
use crate::error::{PericlesError, Result};
use crate::family::{BondList, Crack, Cut, EndRule, VolumeCorrection};
use crate::material::{LinearSolidConstants, SolidClasses, SolidSurface, Strains};
use crate::operator::assemble::fills_lattice;
use crate::operator::{
    AssembledBonds, BondForm, DamageMeasure, Feature, Features, Limit, TwoPass, TwoPassForce,
};
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

/// What the form on a lattice does not represent.
const ON_GRID: &[Limit] = &[
    Limit::new(
        Feature::SurfaceCorrection,
        "corrected surfaces of state-based materials are kept as a list; use \"list\" or leave `bonds` out",
    ),
    Limit::BOND_ENERGY,
    Limit::THERMAL_EXPANSION,
    Limit::new(
        Feature::NoLattice,
        "its points lie on no regular grid; use \"list\"",
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

    /// What the body has that not every form represents.
    pub fn features(&self) -> Features {
        let limits = match self.classes {
            Some(classes) => classes.weakest(),
            None => self.constants.limits,
        };
        Features::from(Feature::StateBased)
            .with(
                Feature::SurfaceCorrection,
                self.surface != SolidSurface::None,
            )
            .with(Feature::BondEnergy, limits.energy.is_finite())
            .with(Feature::NoLattice, self.cloud.lattice().is_none())
    }

    /// What a form of state-based bodies does not represent. The fastest form is a list where a stencil is not possible.
    pub fn limits(form: BondForm) -> &'static [Limit] {
        match form {
            BondForm::Fastest | BondForm::List => &[],
            BondForm::Grid => ON_GRID,
            BondForm::FloatGrid => &[Limit::STATE_BASED],
        }
    }

    /// The faster of stencil and list.
    pub fn fastest_form(&self) -> BondForm {
        let refused = Limit::refusal(ON_GRID, self.features()).is_some();
        match !refused && fills_lattice(self.cloud) {
            true => BondForm::Grid,
            false => BondForm::List,
        }
    }

    /// The operator.
    ///
    /// # Errors
    /// A form that does not represent the body, a horizon that reaches no neighbour, an unusable crack, materials of another number of points.
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        match (self.strains, self.cloud.dimension()) {
            (Strains::Finite, 1) => self.of_form::<FiniteStrain, 1>(form),
            (Strains::Finite, 2) => self.of_form::<FiniteStrain, 2>(form),
            (Strains::Finite, _) => self.of_form::<FiniteStrain, 3>(form),
            (Strains::Small, 1) => self.of_form::<SmallStrain, 1>(form),
            (Strains::Small, 2) => self.of_form::<SmallStrain, 2>(form),
            (Strains::Small, _) => self.of_form::<SmallStrain, 3>(form),
        }
    }

    fn of_form<L: Kinematics, const D: usize>(&self, form: BondForm) -> Result<AssembledBonds> {
        let form = match form {
            BondForm::Fastest => self.fastest_form(),
            chosen => chosen,
        };
        Limit::check(Self::limits(form), form.name(), self.features())?;
        match form {
            BondForm::Grid => Ok(self.assembled(self.grid::<L, D>()?, form)),
            _ => Ok(self.assembled(self.list::<L, D>()?, form)),
        }
    }

    fn assembled<F: TwoPass + 'static>(
        &self,
        (force, cuts): (F, Vec<Cut>),
        form: BondForm,
    ) -> AssembledBonds {
        AssembledBonds {
            operator: Box::new(TwoPassForce::new(self.cloud.clone(), force)),
            cuts,
            form,
        }
    }

    /// The materials of the points.
    fn classes(&self) -> Result<SolidClasses> {
        let classes = match self.classes {
            Some(classes) => classes.clone(),
            None => SolidClasses::uniform(self.constants),
        };
        match classes.covers(self.cloud.len()) {
            true => Ok(classes),
            false => Err(PericlesError::OutOfRange {
                quantity: "the number of points of the body",
                value: self.cloud.len() as f64,
                allowed: "as many points as have a material",
            }),
        }
    }

    /// The force in two passes on a stencil, and what each pre-crack removed.
    ///
    /// # Errors
    /// Those of [`LinearSolidBody::operator`].
    pub fn grid<L: Kinematics, const D: usize>(&self) -> Result<(LinearSolidGrid<L, D>, Vec<Cut>)> {
        Limit::check(ON_GRID, BondForm::Grid.name(), self.features())?;
        LinearSolidGrid::new(
            self.cloud,
            (&self.constants.influence, self.constants.horizon),
            self.volume_correction,
            &self.classes()?,
            self.cracks,
            self.no_fail,
            self.damage,
        )
    }

    /// The force in two passes on a list of bonds, and what each pre-crack removed.
    ///
    /// # Errors
    /// Those of [`LinearSolidBody::operator`].
    ///
    /// # Panics
    /// If the body has another dimension than D.
    pub fn list<L: Kinematics, const D: usize>(
        &self,
    ) -> Result<(LinearSolidForce<L, D>, Vec<Cut>)> {
        let classes = self.classes()?;
        let mut bonds = BondList::new(self.cloud, self.constants.horizon, self.volume_correction)?;
        let cut = |(crack, rule): &(Crack, EndRule)| bonds.cut(crack, *rule);
        let cuts = self.cracks.iter().map(cut).collect::<Result<Vec<_>>>()?;
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
