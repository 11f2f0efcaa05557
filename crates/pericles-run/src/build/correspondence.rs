//! Forces of bodies of correspondence materials.

use pericles::material::{BondFailure, BondLimits};
use pericles::operator::Feature;
use pericles::space::PointCloud;
use pericles_deck::{
    BuildError, Correspondence, Fault, InterfaceFailure, KeyPath, MaterialModel, ModelWarning,
    Solid,
};
use pericles_solids::correspondence::{
    CorrespondenceBody, CorrespondenceConstants, CorrespondenceMaterial,
};

use super::assembler::Assembler;
use super::body::BodyParts;
use super::constants::MaterialConstants;
use super::discretisation::Discretisation;
use super::materials::PairRule;
use super::rejection::{at, at_material, at_path};

impl Assembler<'_> {
    /// Builds force operator and materials of a body of correspondence materials.
    pub(super) fn correspondence_parts(
        &self,
        solid: &Solid,
        own: &Correspondence,
        discretisation: &Discretisation,
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<BodyParts, BuildError> {
        self.reject_correspondence_features(solid)?;
        let Discretisation { cloud, sets, .. } = discretisation;
        let material = &solid.material;
        let material_of = |path: KeyPath, own: &Correspondence| {
            let material = own.material();
            let material = material.map_err(|error| at_path(&path, error.into()))?;
            Ok::<_, BuildError>((path, material))
        };
        let mut materials = vec![material_of(KeyPath::from("material"), own)?];
        for other in &self.model.materials {
            let path = KeyPath::from("materials").key(&other.name);
            let MaterialModel::Correspondence(own) = &other.model else {
                return Err(self.other_kind(&path, &other.name));
            };
            materials.push(material_of(path, own)?);
        }
        let constants = |(path, material): &(KeyPath, CorrespondenceMaterial)| {
            let constants = material.constants(cloud, solid.state);
            constants.map_err(|error| at_path(path, error.into()))
        };
        let all: Vec<CorrespondenceConstants> = materials
            .iter()
            .map(constants)
            .collect::<Result<_, BuildError>>()?;
        for ((path, material), constants) in materials.iter().zip(&all) {
            let key = match material.solid.failure {
                BondFailure::Unbreakable | BondFailure::ByCriterion => continue,
                BondFailure::CriticalStretch(_) => "critical_stretch",
                BondFailure::Stretch { .. } | BondFailure::BondEnergy { .. } => "fracture_energy",
            };
            self.check_stretch(constants.solid.limits.stretch, path.key(key), warnings);
        }
        let (of_point, density) = self.points_of_materials(material, (cloud, sets), warnings)?;
        let classes = match of_point {
            None => None,
            Some(of_point) => {
                let classes = CorrespondenceConstants::several(of_point, &all);
                let mut classes = classes.map_err(|error| at("materials", error))?;
                for (pair, limits) in self.stretches_between(solid, &materials, cloud)? {
                    classes.set_limits(pair, limits);
                }
                Some(classes)
            }
        };
        let classes = match self.strengths(solid, cloud)? {
            None => classes,
            Some(factors) => {
                let classes = classes.unwrap_or_else(|| all[0].clone().uniform());
                Some(classes.with_strengths(factors))
            }
        };
        let no_fail = self.union_of(sets, &material.no_fail)?;
        let body = CorrespondenceBody {
            cloud,
            constants: &all[0],
            classes: classes.as_ref(),
            volume_correction: own.solid.volume_correction,
            cracks: self.cracks,
            no_fail: &no_fail,
            damage: material.damage.unwrap_or_default(),
        };
        // Spectral force kernels are rejected above.
        let form = self
            .heated_form(material.form)?
            .of_bonds()
            .unwrap_or_default();
        let bonds = body.operator(form).map_err(at_material)?;
        let cracks = self.tracked_cracks(&bonds.cuts, discretisation, warnings);
        let mut all = all.into_iter().map(MaterialConstants::Correspondence);
        let constants = all.next();
        if let Some(constants) = &constants {
            warnings.extend(self.check_speed(solid, constants));
            warnings.extend(self.check_solid(solid, constants));
        }
        Ok(BodyParts {
            constants,
            others: all.collect(),
            bonds: bonds.into(),
            cracks,
            density,
            softening: Vec::new(),
        })
    }

    /// Returns the limits of bonds between two materials, if the deck gives them.
    fn stretches_between(
        &self,
        solid: &Solid,
        materials: &[(KeyPath, CorrespondenceMaterial)],
        cloud: &PointCloud,
    ) -> Result<Vec<([u8; 2], BondLimits)>, BuildError> {
        let mut found = Vec::new();
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
            let [a, b] = pair.map(|number| &materials[usize::from(number)].1);
            let limits = a.limits_towards(b, failure, cloud, solid.state);
            found.push((pair, limits.map_err(|error| at_path(&path, error.into()))?));
        }
        Ok(found)
    }

    /// Rejects features that correspondence materials do not support, and force kernels that do not support them.
    fn reject_correspondence_features(&self, solid: &Solid) -> Result<(), BuildError> {
        let shape = &solid.shape;
        let mut assignments = self.model.assignments.iter();
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
            if let (true, Some(reason)) = (present, CorrespondenceBody::rejection(feature.into())) {
                let (value, allowed) = (feature.words().into(), reason.into());
                return Err(at_path(key, Fault::OutOfRange { value, allowed }));
            }
        }
        let form = solid.material.form;
        form.check(Feature::Correspondence.into())
            .map_err(at_material)
    }
}
