//! Checks of materials made by programs: the ranges of the declared keys, and what materials of a body share.

use pericles::kernel::Influence;
use pericles::material::{StressState, SurfaceCorrection};

use super::shared::difference;
use super::types::{Material, MaterialModel, NamedMaterial};
use crate::criterion::FailureCriterion;
use crate::declaration::{Check, DeckKeys};
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::range::POSITIVE;
use crate::remark::Remark;
use crate::state_based::{StateBased, strength_of};

impl Material {
    /// Checks the material of a body of this stress state and dimension.
    pub(crate) fn check(&self, state: StressState, dimension: usize, check: &mut Check) {
        let path = KeyPath::from("material");
        self.model.check(&path, state, dimension, check);
        if let MaterialModel::StateBased(_) = &self.model {
            let allowed = "allowed: none, energy or ghosts; the weighted volume already accounts for missing bonds";
            let right = self.surface_correction != SurfaceCorrection::Volume;
            check.within(right, path.key("surface_correction"), "volume", allowed);
        }
    }
}

impl NamedMaterial {
    /// Checks a further material of a body with the material `own`.
    pub(crate) fn check(
        &self,
        own: &MaterialModel,
        state: StressState,
        dimension: usize,
        check: &mut Check,
    ) {
        let path = KeyPath::from("materials").key(&self.name);
        self.model.check(&path, state, dimension, check);
        if let Some(key) = difference(own, &self.model) {
            let table = path.to_string();
            let fault = Fault::NotShared { key, table };
            check.problems.push(Remark::new(path.key(key), fault));
        }
    }
}

impl MaterialModel {
    fn check(&self, path: &KeyPath, state: StressState, dimension: usize, check: &mut Check) {
        check.number(path.key("density"), self.density(), POSITIVE);
        check.number(path.key("horizon"), self.horizon(), POSITIVE);
        let influence = |influence: &Influence, check: &mut Check| {
            let result = influence.check(dimension, self.horizon());
            check.engine(path.key("influence"), result);
        };
        let solid = |solid: &StateBased, check: &mut Check| {
            solid.solid.elastic.check_keys(path, Some(state), check);
            check.engine(path.clone(), solid.solid.elastic.resolve(state));
            strength_of(&solid.solid.failure).check_keys(path, None, check);
            let criterion = solid.criterion.as_ref().map(FailureCriterion::criterion);
            check.engine(path.key("strength"), criterion.transpose());
            if let Some(given) = solid.given_influence() {
                influence(&given, check);
            }
        };
        match self {
            Self::StateBased(given) => solid(given, check),
            Self::Correspondence(given) => {
                solid(&given.as_state_based(), check);
                if let Some(anisotropy) = &given.anisotropy {
                    let path = path.key("anisotropy");
                    anisotropy.check_keys(&path, (), check);
                    check.engine(path, anisotropy.stiffness());
                }
                if let Some(plasticity) = &given.plasticity {
                    check.engine(path.key("yield_stress"), plasticity.check());
                }
            }
            Self::Bonds(bonds) => {
                bonds.modulus.check_keys(path, Some(state), check);
                bonds.fracture.check_keys(path, None, check);
                influence(&bonds.influence, check);
            }
        }
    }
}
