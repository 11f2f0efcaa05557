//! Forces of bodies of correspondence materials.

use pericles::operator::Feature;
use pericles_deck::{BuildError, Correspondence, KeyPath, MaterialModel, Solid};
use pericles_solids::correspondence::{
    CorrespondenceBody, CorrespondenceConstants, CorrespondenceMaterial,
};

use super::assembler::Assembler;
use super::body::BodyParts;
use super::constants::MaterialConstants;
use super::discretisation::Discretisation;
use super::rejection::{at_material, at_path};
use super::solids::Combination;

impl Assembler<'_> {
    /// Builds force operator and materials of a body of correspondence materials.
    pub(super) fn correspondence_parts(
        &self,
        solid: &Solid,
        own: &Correspondence,
        discretisation: &Discretisation,
    ) -> Result<BodyParts, BuildError> {
        let rejection = CorrespondenceBody::rejection;
        self.reject_solid_features(solid, Feature::Correspondence, rejection)?;
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
            let stretch = constants.solid.limits.stretch;
            self.check_limit(stretch, &material.solid.failure, path);
        }
        let combination = Combination {
            several: &|of_point| CorrespondenceConstants::several(of_point, &all),
            uniform: &|| all[0].clone().uniform(),
            limits: &|pair, failure| {
                let [a, b] = pair.map(|number| &materials[usize::from(number)].1);
                a.limits_towards(b, failure, cloud, solid.state)
            },
        };
        let (classes, density) = self.combined(solid, discretisation, &combination)?;
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
            .form_of_model(material.form)?
            .of_bonds()
            .unwrap_or_default();
        let bonds = body.operator(form).map_err(at_material)?;
        let cracks = self.tracked_cracks(&bonds.cuts, discretisation);
        let mut all = all
            .into_iter()
            .map(|own| MaterialConstants::Correspondence(Box::new(own)));
        let constants = all.next();
        if let Some(constants) = &constants {
            self.warnings.extend(self.check_speed(solid, constants));
            self.warnings.extend(self.check_solid(solid, constants));
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
}
