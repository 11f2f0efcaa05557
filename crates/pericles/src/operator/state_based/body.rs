//! Bodies of linear peridynamic solids and the choice between list and stencil kernels.

use std::sync::Arc;

use super::force::LinearSolidForce;
use super::grid::LinearSolidGrid;
use super::kinematics::{FiniteStrain, Kinematics, SmallStrain};
use crate::error::{PericlesError, Result};
use crate::family::{BondCut, BondList, Crack, EndRule, VolumeCorrection};
use crate::material::{LinearSolidConstants, Materials, SolidSurface, StateConstants, Strains};
use crate::operator::assemble::fills_lattice;
use crate::operator::{
    AssembledBonds, BondForm, DamageMeasure, Feature, Features, Limit, TwoPass, TwoPassForce,
};
use crate::space::PointCloud;

/// A body of linear peridynamic solids: the input of its force operator.
#[derive(Debug, Clone)]
pub struct LinearSolidBody<'a> {
    /// The points.
    pub cloud: &'a Arc<PointCloud>,
    /// Constants of the material; its horizon and influence function belong to the body.
    pub constants: &'a LinearSolidConstants,
    /// Materials of points and of bonds between them, if there are several.
    pub classes: Option<&'a Materials<StateConstants>>,
    /// Partial volumes at the horizon.
    pub volume_correction: VolumeCorrection,
    /// Kinematics: bond extensions as functions of displacements.
    pub strains: Strains,
    /// Surface correction.
    pub surface: SolidSurface,
    /// Pre-cracks, applied before weighted volumes are computed.
    pub cracks: &'a [(Crack, EndRule)],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
    /// Definition of damage.
    pub damage: DamageMeasure,
}

/// Features that state-based bodies do not support.
const LIMITS: &[Limit] = &[
    Limit::new(
        Feature::Inclusions,
        "inclusions scale the stiffness of bonds, which state-based materials do not have; assign a second material to a set of points instead",
    ),
    Limit::new(
        Feature::SeveralSpacings,
        "state-based materials need cells of one size; omit `body.refine` or use a bond-based model",
    ),
    Limit::new(
        Feature::GaussNodes,
        "Gauss nodes are available for linear bond-based bars only; omit `quadrature`",
    ),
];

/// Features that the stencil kernel does not support.
const ON_GRID: &[Limit] = &[
    Limit::new(
        Feature::SurfaceCorrection,
        "the surface correction of state-based materials needs a neighbour list; use bonds = \"list\" or omit `bonds`",
    ),
    Limit::BOND_ENERGY,
    Limit::STRESS_FAILURE,
    Limit::new(
        Feature::NoLattice,
        "the points do not lie on a regular grid; use bonds = \"list\"",
    ),
];

impl<'a> LinearSolidBody<'a> {
    /// Returns why a body with these features cannot be state-based; `None` if it can.
    pub fn rejection(features: Features) -> Option<&'static str> {
        Limit::rejection(LIMITS, features)
    }

    /// Creates a body of one material without pre-cracks, in which all bonds may break, for finite
    /// displacements.
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

    /// Returns the features of the body that not every kernel supports.
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
            .with(
                Feature::StressFailure,
                match self.classes {
                    Some(classes) => !classes.criteria().is_empty(),
                    None => self.constants.criterion.is_some(),
                },
            )
            .with(Feature::NoLattice, self.cloud.lattice().is_none())
    }

    /// Returns the features of state-based bodies that a kernel does not support. The fastest kernel is a
    /// list if a stencil is not possible.
    pub fn limits(form: BondForm) -> &'static [Limit] {
        match form {
            BondForm::Fastest | BondForm::List => &[],
            BondForm::Grid => ON_GRID,
            BondForm::FloatGrid => &[Limit::STATE_BASED],
        }
    }

    /// Returns the faster of stencil and list.
    pub fn fastest_form(&self) -> BondForm {
        let rejected = Limit::rejection(ON_GRID, self.features()).is_some();
        match !rejected && fills_lattice(self.cloud) {
            true => BondForm::Grid,
            false => BondForm::List,
        }
    }

    /// Returns the force operator.
    ///
    /// # Errors
    /// A kernel that does not support the body, a horizon without neighbours, an invalid crack, materials of
    /// a different number of points.
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        if self.surface == SolidSurface::Ghosts {
            return self.with_ghosts(form);
        }
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
        (force, cuts): (F, Vec<BondCut>),
        form: BondForm,
    ) -> AssembledBonds {
        AssembledBonds {
            operator: Box::new(TwoPassForce::new(self.cloud.clone(), force)),
            cuts,
            form,
        }
    }

    /// Returns the materials of the points.
    pub(in crate::operator) fn classes(&self) -> Result<Materials<StateConstants>> {
        let classes = match self.classes {
            Some(classes) => classes.clone(),
            None => self.constants.uniform(),
        };
        match classes.covers(self.cloud.len()) {
            true => Ok(classes),
            false => Err(PericlesError::OutOfRange {
                quantity: "the number of points of the body",
                value: self.cloud.len() as f64,
                allowed: "the number of points with a material",
            }),
        }
    }

    /// Returns the two-pass force on a stencil and the bonds removed by each pre-crack.
    ///
    /// # Errors
    /// Errors of [`LinearSolidBody::operator`].
    pub fn grid<L: Kinematics, const D: usize>(
        &self,
    ) -> Result<(LinearSolidGrid<L, D>, Vec<BondCut>)> {
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

    /// Returns the families without bonds cut by pre-cracks, and the bonds removed by each crack.
    pub(in crate::operator) fn families(&self) -> Result<(BondList, Vec<BondCut>)> {
        let mut bonds = BondList::new(self.cloud, self.constants.horizon, self.volume_correction)?;
        let cut = |(crack, rule): &(Crack, EndRule)| bonds.cut(crack, *rule);
        let cuts = self.cracks.iter().map(cut).collect::<Result<_>>()?;
        Ok((bonds, cuts))
    }

    /// Returns the two-pass force on a neighbour list and the bonds removed by each pre-crack.
    ///
    /// # Errors
    /// Errors of [`LinearSolidBody::operator`].
    ///
    /// # Panics
    /// If the dimension of the body is not D.
    pub fn list<L: Kinematics, const D: usize>(
        &self,
    ) -> Result<(LinearSolidForce<L, D>, Vec<BondCut>)> {
        if self.surface == SolidSurface::Ghosts {
            return Err(PericlesError::NoGhostLayer {
                reason: "a force of the body alone has no ghost points; build it with `LinearSolidBody::operator`".into(),
            });
        }
        let classes = self.classes()?;
        let (bonds, cuts) = self.families()?;
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
