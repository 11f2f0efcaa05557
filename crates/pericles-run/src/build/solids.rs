//! What bodies of state-based and of correspondence materials have in common.

use pericles::material::{BondFailure, BondLimits, Materials};
use pericles::operator::{Feature, Features};
use pericles::{PericlesError, PointScalar};
use pericles_deck::{
    BuildError, FailureCriterion, Fault, InterfaceFailure, KeyPath, MaterialModel, Solid,
};

use super::assembler::Assembler;
use super::discretisation::Discretisation;
use super::materials::PairRule;
use super::rejection::{at, at_material, at_path};

/// How the materials of a body are combined.
pub(super) struct Combination<'a, C> {
    /// The materials of points with these numbers.
    pub several: &'a dyn Fn(Vec<u8>) -> Result<Materials<C>, PericlesError>,
    /// The first material at all points.
    pub uniform: &'a dyn Fn() -> Materials<C>,
    /// Limits of bonds between two materials with a failure criterion.
    pub limits: &'a dyn Fn([u8; 2], BondFailure) -> Result<BondLimits, PericlesError>,
}

impl Assembler<'_> {
    /// Returns the materials of the points of a body, `None` for a single material, and the densities.
    pub(super) fn combined<C>(
        &self,
        solid: &Solid,
        discretisation: &Discretisation,
        combination: &Combination<'_, C>,
    ) -> Result<(Option<Materials<C>>, PointScalar), BuildError> {
        let Discretisation { cloud, sets, .. } = discretisation;
        let (of_point, density) = self.points_of_materials(&solid.material, (cloud, sets))?;
        let mut materials = match of_point {
            None => None,
            Some(of_point) => {
                let several = (combination.several)(of_point);
                Some(several.map_err(|error| at("materials", error))?)
            }
        };
        if let Some(materials) = &mut materials {
            for PairRule {
                pair,
                interface,
                path,
            } in self.pair_rules(&solid.material)
            {
                let failure = match interface.failure {
                    None => continue,
                    Some(InterfaceFailure::StateBased(failure)) => failure,
                    Some(InterfaceFailure::Bonds(_)) => {
                        return Err(self.other_kind(&path, "bond-based"));
                    }
                };
                let limits = (combination.limits)(pair, failure);
                let limits = limits.map_err(|error| at_path(&path, error.into()))?;
                materials.set_limits(pair, limits);
            }
        }
        self.check_criteria(solid)?;
        if let Some(factors) = self.strengths(solid, cloud)? {
            let all = materials.unwrap_or_else(combination.uniform);
            materials = Some(all.with_strengths(factors));
        }
        Ok((materials, density))
    }

    /// Rejects failure criteria that depend on the temperature of bodies without temperatures.
    fn check_criteria(&self, solid: &Solid) -> Result<(), BuildError> {
        let own = (KeyPath::from("material"), &solid.material.model);
        let others = self.model.materials.iter();
        let others =
            others.map(|other| (KeyPath::from("materials").key(&other.name), &other.model));
        for (path, model) in std::iter::once(own).chain(others) {
            let criterion = match model {
                MaterialModel::StateBased(own) => own.criterion.as_ref(),
                MaterialModel::Correspondence(own) => own.criterion.as_ref(),
                MaterialModel::Bonds(_) => None,
            };
            let heated = matches!(criterion, Some(FailureCriterion::Expression(expression)) if expression.depends_on_temperature());
            if heated && !self.expands() {
                let fault = Fault::OutOfRange {
                    value: "a criterion of the temperature".into(),
                    allowed: "allowed: with [thermal] and its `expansion`, which may be 0".into(),
                };
                return Err(at_path(path.key("criterion"), fault));
            }
        }
        Ok(())
    }

    /// Rejects features of a body for which `rejection` gives a reason, and force kernels that do not support its material.
    pub(super) fn reject_solid_features(
        &self,
        solid: &Solid,
        material: Feature,
        rejection: fn(Features) -> Option<&'static str>,
    ) -> Result<(), BuildError> {
        let (shape, mut assignments) = (&solid.shape, self.model.assignments.iter());
        let found = [
            (
                Feature::Inclusions,
                assignments.any(|one| one.stiffness.is_some()),
                "assign",
            ),
            (
                Feature::SurfaceCorrection,
                solid.material.surface_correction != Default::default(),
                "material.surface_correction",
            ),
            (Feature::SeveralSpacings, shape.is_refined(), "body.refine"),
            (
                Feature::GaussNodes,
                shape.has_gauss_nodes(),
                "body.quadrature",
            ),
        ];
        for (feature, present, key) in found {
            if let (true, Some(reason)) = (present, rejection(feature.into())) {
                let (value, allowed) = (feature.words().into(), reason.into());
                return Err(at_path(key, Fault::OutOfRange { value, allowed }));
            }
        }
        solid
            .material
            .form
            .check(material.into())
            .map_err(at_material)
    }

    /// Warns of a large critical stretch of a material.
    pub(super) fn check_limit(&self, stretch: f64, failure: &BondFailure, path: &KeyPath) {
        let key = match failure {
            BondFailure::Unbreakable | BondFailure::ByCriterion => return,
            BondFailure::CriticalStretch(_) => "critical_stretch",
            BondFailure::Stretch { .. } | BondFailure::BondEnergy { .. } => "fracture_energy",
        };
        self.check_stretch(stretch, path.key(key));
    }
}
