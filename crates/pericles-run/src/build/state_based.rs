//! Forces of bodies of state-based materials.

use pericles::PericlesError;
use pericles::material::{
    BondFailure, BondLimits, LinearSolid, LinearSolidConstants, SolidSurface, StressState,
    SurfaceCorrection,
};
use pericles::operator::{Feature, LinearSolidBody};
use pericles::space::PointCloud;
use pericles_deck::{
    BuildError, Caution, FailureCriterion, Fault, InterfaceFailure, KeyPath, MaterialModel,
    ModelWarning, Remark, Solid, StateBased,
};
use pericles_solids::inelastic::{InelasticSolidBody, Inelasticity};

use super::assembler::Assembler;
use super::body::BodyParts;
use super::constants::MaterialConstants;
use super::discretisation::Discretisation;
use super::materials::PairRule;
use super::rejection::{at, at_material, at_path};

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
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<BodyParts, BuildError> {
        self.reject_features(solid)?;
        let Discretisation { cloud, sets, .. } = discretisation;
        let material = &solid.material;
        let constants = with_criterion(state_based, cloud, solid.state).map_err(at_material)?;
        self.check_limits(
            &constants,
            &state_based.solid.failure,
            &"material".into(),
            warnings,
        );
        let mut all = vec![constants.clone()];
        let mut solids = vec![&state_based.solid];
        let mut laws = vec![state_based.inelastic.clone()];
        for other in &self.model.materials {
            let path = KeyPath::from("materials").key(&other.name);
            let MaterialModel::StateBased(own) = &other.model else {
                return Err(self.other_kind(&path, &other.name));
            };
            solids.push(&own.solid);
            laws.push(own.inelastic.clone());
            let constants = with_criterion(own, cloud, solid.state);
            let constants = constants.map_err(|error| at_path(&path, error.into()))?;
            self.check_limits(&constants, &own.solid.failure, &path, warnings);
            all.push(constants);
        }
        let (of_point, density) = self.points_of_materials(material, (cloud, sets), warnings)?;
        let classes = match of_point {
            None => None,
            Some(of_point) => {
                let classes = LinearSolidConstants::several(of_point, &all);
                let mut classes = classes.map_err(|error| at("materials", error))?;
                for (pair, limits) in self.limits_between(solid, &solids, cloud)? {
                    classes.set_limits(pair, limits);
                }
                Some(classes)
            }
        };
        let classes = match self.strengths(solid, cloud)? {
            None => classes,
            Some(factors) => {
                let classes = classes.unwrap_or_else(|| constants.uniform());
                Some(classes.with_strengths(factors))
            }
        };
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
            .heated_form(material.form)?
            .of_bonds()
            .unwrap_or_default();
        let bonds = match laws.iter().all(Inelasticity::is_elastic) {
            true => body.operator(form),
            false => {
                // Without assignments all points have the first material.
                laws.truncate(classes.as_ref().map_or(1, |classes| classes.all().len()));
                let (elastic, laws) = (body, &laws[..]);
                InelasticSolidBody { elastic, laws }.operator(form)
            }
        };
        let bonds = bonds.map_err(at_material)?;
        let cracks = self.tracked_cracks(&bonds.cuts, discretisation, warnings);
        let mut all = all.into_iter().map(MaterialConstants::StateBased);
        let constants = all.next();
        if let Some(constants) = &constants {
            warnings.extend(self.check_speed(solid, constants));
            warnings.extend(self.check_solid(solid, constants));
        }
        if let (Some(MaterialConstants::StateBased(constants)), None) = (&constants, &classes) {
            let forces = (&*bonds.operator, &constants.elastic);
            warnings.extend(self.check_thin(solid, cloud, forces));
        }
        warnings.extend(self.check_isotropy(constants.as_ref()));
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
    fn limits_between(
        &self,
        solid: &Solid,
        solids: &[&LinearSolid],
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
            let [a, b] = pair.map(|number| solids[usize::from(number)]);
            let limits = a.limits_towards(b, failure, cloud, solid.state);
            found.push((pair, limits.map_err(|error| at_path(&path, error.into()))?));
        }
        Ok(found)
    }

    /// Rejects features that state-based materials do not support, and force kernels that do not support them.
    fn reject_features(&self, solid: &Solid) -> Result<(), BuildError> {
        let shape = &solid.shape;
        let found = [
            (
                Feature::Inclusions,
                self.model
                    .assignments
                    .iter()
                    .any(|one| one.stiffness.is_some()),
                "assign",
            ),
            (Feature::SeveralSpacings, shape.is_refined(), "body.refine"),
            (
                Feature::GaussNodes,
                shape.has_gauss_nodes(),
                "body.quadrature",
            ),
        ];
        for (feature, present, key) in found {
            if let (true, Some(reason)) = (present, LinearSolidBody::rejection(feature.into())) {
                let (value, allowed) = (feature.words().into(), reason.into());
                return Err(at_path(key, Fault::OutOfRange { value, allowed }));
            }
        }
        let form = solid.material.form;
        form.check(Feature::StateBased.into()).map_err(at_material)
    }

    /// Warns of large critical stretches: bonds of real materials break well below a stretch of 20 %.
    fn check_limits(
        &self,
        constants: &LinearSolidConstants,
        failure: &BondFailure,
        path: &KeyPath,
        warnings: &mut Vec<ModelWarning>,
    ) {
        let key = match failure {
            BondFailure::Unbreakable | BondFailure::ByCriterion => return,
            BondFailure::CriticalStretch(_) => "critical_stretch",
            BondFailure::Stretch { .. } | BondFailure::BondEnergy { .. } => "fracture_energy",
        };
        self.check_stretch(constants.limits.stretch, path.key(key), warnings);
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
