//! Bodies of inelastic solids.

use super::super::body::LinearSolidBody;
use super::super::kinematics::{FiniteStrain, Kinematics, SmallStrain};
use super::force::InelasticSolidForce;
use crate::error::{PericlesError, Result};
use crate::family::Cut;
use crate::material::{Inelasticity, Strains, StressState};
use crate::operator::{AssembledBonds, BondForm, Feature, Features, Limit, TwoPassForce};

/// A body of linear peridynamic solids, some of which are viscous or plastic.
#[derive(Debug, Clone)]
pub struct InelasticSolidBody<'a> {
    /// The body with its elastic constants.
    pub elastic: LinearSolidBody<'a>,
    /// The inelasticity of every material, in the order of the classes of the elastic body.
    pub laws: &'a [Inelasticity],
}

/// What bodies with history do not represent.
const LIMITS: &[Limit] = &[
    Limit::new(
        Feature::SurfaceCorrection,
        "viscous and plastic materials have no corrected surfaces: the factors are those of elastic bonds; leave out `surface_correction`",
    ),
    Limit::new(
        Feature::BondEnergy,
        "the bonds of viscous and plastic materials break by their stretch; use failure = \"stretch\"",
    ),
];

/// What the forms on a lattice do not represent.
const ON_LATTICE: &str = "viscous and plastic materials keep numbers for every bond of a list; use \"list\" or leave `bonds` out";

impl InelasticSolidBody<'_> {
    /// Why a body with these features cannot be viscous or plastic; none if it can.
    pub fn refusal(features: Features) -> Option<&'static str> {
        Limit::refusal(LIMITS, features)
    }

    /// The operator, on a list.
    ///
    /// # Errors
    /// Those of [`LinearSolidBody::operator`] and of [`Inelasticity::check`]; a form other than a list, corrected surfaces, limits of bond energy, another number of laws than of materials; a body that is divided among processes.
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
        let (force, cuts) = self.list::<L, D>()?;
        Ok(AssembledBonds {
            operator: Box::new(TwoPassForce::new(self.elastic.cloud.clone(), force)),
            cuts,
            form: BondForm::List,
        })
    }

    /// The force in two passes, and what each pre-crack removed.
    ///
    /// # Errors
    /// Those of [`InelasticSolidBody::operator`].
    ///
    /// # Panics
    /// If the body has another dimension than D.
    pub fn list<L: Kinematics, const D: usize>(
        &self,
    ) -> Result<(InelasticSolidForce<L, D>, Vec<Cut>)> {
        let form = BondForm::List.name();
        Limit::check(LIMITS, form, self.elastic.features())?;
        let state = match self.elastic.cloud.dimension() {
            1 => StressState::Uniaxial,
            2 => StressState::PlaneStrain,
            _ => StressState::Spatial,
        };
        self.laws.iter().try_for_each(|law| law.check(state))?;
        let materials = self
            .elastic
            .classes
            .map_or(1, |classes| classes.materials());
        if self.laws.len() != materials {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of laws of inelasticity",
                value: self.laws.len() as f64,
                allowed: "one for each material",
            });
        }
        let (solid, cuts) = self.elastic.list::<L, D>()?;
        let influence = &self.elastic.constants.influence;
        let force = InelasticSolidForce::new(solid, self.laws.to_vec(), influence)?;
        Ok((force, cuts))
    }
}
