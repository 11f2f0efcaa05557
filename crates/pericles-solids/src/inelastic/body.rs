//! Bodies of viscous and plastic solids.

use pericles::family::BondCut;
use pericles::material::{Strains, StressState};
use pericles::operator::{
    AssembledBonds, BondForm, Feature, Features, FiniteStrain, Kinematics, Limit, LinearSolidBody,
    SmallStrain,
};
use pericles::{PericlesError, Result};

use super::force_state::InelasticSolid;
use super::law::Inelasticity;
use crate::solid::{SolidBody, SolidForce};

/// A body of linear peridynamic solids, some of which are viscous or plastic.
#[derive(Debug, Clone)]
pub struct InelasticSolidBody<'a> {
    /// The body with its elastic constants.
    pub elastic: LinearSolidBody<'a>,
    /// Inelastic law of each material, in the order of the classes of the elastic body.
    pub laws: &'a [Inelasticity],
}

/// Features that inelastic bodies do not support.
const LIMITS: &[Limit] = &[Limit::new(
    Feature::SurfaceCorrection,
    "the surface correction of viscous and plastic materials is not supported: its factors hold for elastic bonds; omit `surface_correction`",
)];

/// Reason why stencil kernels are not available.
const ON_LATTICE: &str = "viscous and plastic materials store the history of each bond of a neighbour list; use bonds = \"list\" or omit `bonds`";

impl InelasticSolidBody<'_> {
    /// Returns why a body with these features cannot be viscous or plastic; `None` if it can.
    pub fn rejection(features: Features) -> Option<&'static str> {
        Limit::rejection(LIMITS, features)
    }

    /// Returns the operator, which uses a list.
    ///
    /// # Errors
    /// Errors of [`LinearSolidBody::operator`] and of [`Inelasticity::check`]; a kernel other than a list,
    /// surface correction, a number of laws that is not the number of materials.
    pub fn operator(&self, form: BondForm) -> Result<AssembledBonds> {
        match (self.elastic.strains, self.elastic.cloud.dimension()) {
            (Strains::Finite, 1) => self.of_form::<FiniteStrain, 1>(form),
            (Strains::Finite, 2) => self.of_form::<FiniteStrain, 2>(form),
            (Strains::Finite, _) => self.of_form::<FiniteStrain, 3>(form),
            (Strains::Small, 1) => self.of_form::<SmallStrain, 1>(form),
            (Strains::Small, 2) => self.of_form::<SmallStrain, 2>(form),
            (Strains::Small, _) => self.of_form::<SmallStrain, 3>(form),
        }
    }

    fn of_form<L: Kinematics, const D: usize>(&self, form: BondForm) -> Result<AssembledBonds> {
        if let BondForm::Grid | BondForm::FloatGrid = form {
            return Err(PericlesError::FormNotUsable {
                form: form.name(),
                reason: ON_LATTICE,
            });
        }
        self.body::<L>()?.operator::<D>()
    }

    /// Returns the force operator and the bonds removed by each pre-crack.
    ///
    /// # Errors
    /// Errors of [`InelasticSolidBody::operator`].
    ///
    /// # Panics
    /// If the dimension of the body is not D.
    pub fn force<L: Kinematics, const D: usize>(
        &self,
    ) -> Result<(SolidForce<InelasticSolid<L>, D>, Vec<BondCut>)> {
        self.body::<L>()?.force::<D>()
    }

    fn body<L: Kinematics>(&self) -> Result<SolidBody<'_, InelasticSolid<L>>> {
        let form = BondForm::List.name();
        Limit::check(LIMITS, form, self.elastic.features())?;
        let state = match self.elastic.cloud.dimension() {
            1 => StressState::Uniaxial,
            2 => StressState::PlaneStrain,
            _ => StressState::Spatial,
        };
        self.laws.iter().try_for_each(|law| law.check(state))?;
        let materials = match self.elastic.classes {
            Some(classes) => classes.clone(),
            None => self.elastic.constants.uniform(),
        };
        if self.laws.len() != materials.all().len() {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of inelastic laws",
                value: self.laws.len() as f64,
                allowed: "one for each material",
            });
        }
        let with_law =
            |number: usize, constants| InelasticSolid::new(constants, self.laws[number].clone());
        let LinearSolidBody {
            cloud,
            constants,
            volume_correction,
            cracks,
            no_fail,
            damage,
            ..
        } = self.elastic;
        Ok(SolidBody {
            cloud,
            materials: materials.map(with_law),
            horizon: constants.horizon,
            influence: &constants.influence,
            volume_correction,
            cracks,
            no_fail,
            damage,
        })
    }
}
