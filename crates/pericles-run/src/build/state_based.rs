//! Forces of bodies of state-based materials.

use pericles::PericlesError;
use pericles::material::{LinearSolidConstants, SolidSurface, StressState, SurfaceCorrection};
use pericles::operator::{Feature, LinearSolidBody};
use pericles::space::PointCloud;
use pericles_deck::{
    BuildError, Caution, FailureCriterion, KeyPath, MaterialModel, MaterialProperty, ModelWarning,
    Remark, Solid, StateBased,
};
use pericles_solids::inelastic::{InelasticSolidBody, Inelasticity};

use super::assembler::Assembler;
use super::body::BodyParts;
use super::constants::MaterialConstants;
use super::discretisation::Discretisation;
use super::rejection::{at_material, at_path};
use super::solids::Combination;

/// Returns the constants of a material with its failure criterion.
fn with_criterion(
    own: &StateBased,
    cloud: &PointCloud,
    state: StressState,
) -> Result<LinearSolidConstants, PericlesError> {
    let criterion = own.criterion.as_ref();
    Ok(LinearSolidConstants {
        criterion: criterion.map(FailureCriterion::criterion).transpose()?,
        ..own.solid.constants(cloud, state)?
    })
}

impl Assembler<'_> {
    /// Builds force operator and materials of a state-based body.
    pub(super) fn state_based_parts(
        &self,
        solid: &Solid,
        state_based: &StateBased,
        discretisation: &Discretisation,
    ) -> Result<BodyParts, BuildError> {
        self.reject_solid_features(solid, Feature::StateBased, LinearSolidBody::rejection)?;
        let Discretisation { cloud, sets, .. } = discretisation;
        let material = &solid.material;
        let mut own = vec![(KeyPath::from("material"), state_based)];
        for other in &self.model.materials {
            let path = KeyPath::from("materials").key(&other.name);
            match &other.model {
                MaterialModel::StateBased(model) => own.push((path, model)),
                _ => return Err(self.other_kind(&path, &other.name)),
            }
        }
        let mut all = Vec::new();
        for (number, (path, model)) in own.iter().enumerate() {
            let constants = with_criterion(model, cloud, solid.state);
            let constants = constants.map_err(|error| match number {
                0 => at_material(error),
                _ => at_path(path, error.into()),
            })?;
            let stretch = constants.limits.stretch;
            self.check_limit(stretch, &model.solid.failure, path);
            all.push(constants);
        }
        let constants = all[0].clone();
        let combination = Combination {
            several: &|of_point| LinearSolidConstants::several(of_point, &all),
            uniform: &|| constants.uniform(),
            limits: &|pair, failure| {
                let [a, b] = pair.map(|number| &own[usize::from(number)].1.solid);
                a.limits_towards(b, failure, cloud, solid.state)
            },
        };
        let (classes, density) = self.combined(solid, discretisation, &combination)?;
        // Without assignments all points have the first material.
        let assigned = classes.as_ref().map_or(1, |classes| classes.all().len());
        let laws = own[..assigned].iter();
        let laws: Vec<Inelasticity> = laws.map(|(_, own)| own.inelastic.clone()).collect();
        let no_fail = self.union_of(sets, &material.no_fail)?;
        let surfaces = self.cracks;
        let body = LinearSolidBody {
            cloud,
            constants: &constants,
            classes: classes.as_ref(),
            volume_correction: state_based.solid.volume_correction,
            strains: state_based.strains,
            surface: match material.surface_correction {
                SurfaceCorrection::Energy => SolidSurface::Energy,
                SurfaceCorrection::Ghosts => SolidSurface::Ghosts,
                // The volume method is rejected when the model is read.
                SurfaceCorrection::None | SurfaceCorrection::Volume => SolidSurface::None,
            },
            cracks: surfaces,
            no_fail: &no_fail,
            damage: material.damage.unwrap_or_default(),
        };
        // Spectral force kernels are rejected above.
        let form = self
            .form_of_model(material.form)?
            .of_bonds()
            .unwrap_or_default();
        let criteria = all.iter().filter_map(|own| own.criterion.as_ref());
        let varies = self.properties.vary(MaterialProperty::YoungsModulus)
            || criteria.into_iter().any(|criterion| criterion.varies());
        let bonds = match laws.iter().all(Inelasticity::is_elastic) && !varies {
            true => body.operator(form),
            false => {
                let (elastic, laws) = (body, &laws[..]);
                InelasticSolidBody { elastic, laws }.operator(form)
            }
        };
        let bonds = bonds.map_err(at_material)?;
        let cracks = self.tracked_cracks(&bonds.cuts, discretisation);
        let mut all = all.into_iter().map(MaterialConstants::StateBased);
        let constants = all.next();
        if let Some(constants) = &constants {
            self.warnings.extend(self.check_speed(solid, constants));
            self.warnings.extend(self.check_solid(solid, constants));
        }
        if let (Some(MaterialConstants::StateBased(constants)), None) = (&constants, &classes) {
            let forces = (&*bonds.operator, &constants.elastic);
            self.warnings.extend(self.check_thin(solid, cloud, forces));
        }
        self.warnings
            .extend(self.check_isotropy(constants.as_ref()));
        Ok(BodyParts {
            constants,
            others: all.collect(),
            bonds: bonds.into(),
            cracks,
            density,
            softening: Vec::new(),
        })
    }

    /// Warns of an anisotropic shear stiffness of the lattice.
    fn check_isotropy(&self, constants: Option<&MaterialConstants>) -> Option<ModelWarning> {
        /// The conical function with three spacings is within 4 %.
        const NOTICED: f64 = 0.06;
        let shear = constants?.state_based()?.lattice_shear?;
        let caution = Caution::ShearAnisotropy {
            axes: shear.axes,
            diagonals: shear.diagonals,
        };
        (shear.anisotropy() > NOTICED).then(|| Remark::new("material.influence", caution))
    }
}
