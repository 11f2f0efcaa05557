//! Forces of a body of state-based materials.

use pericles::material::{
    BondFailure, BondLimits, LinearSolid, LinearSolidConstants, SolidClasses, SolidSurface,
    SurfaceCorrection,
};
use pericles::operator::{Feature, LinearSolidBody};
use pericles_deck::{
    BuildError, Caution, Fault, KeyPath, ModelWarning, PartConstants, Remark, Solid, StateBased,
};
use pericles_waves::{AssembledForce, ForceForm};

use super::assembler::Assembler;
use super::body::BodyParts;
use super::constants::MaterialConstants;
use super::discretisation::Discretisation;
use super::refusal::{at, at_material, at_path};

impl Assembler<'_> {
    /// Force and materials of a state-based body.
    pub(super) fn state_based_parts(
        &self,
        solid: &Solid,
        state_based: &StateBased,
        discretisation: &Discretisation,
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<BodyParts, BuildError> {
        self.refuse_features(solid)?;
        let Discretisation { cloud, sets, .. } = discretisation;
        let material = &solid.material;
        let constants = state_based.solid.constants(cloud, solid.state);
        let constants = constants.map_err(at_material)?;
        self.judge_limits(
            &constants,
            &state_based.solid.failure,
            &"material".into(),
            warnings,
        );
        let mut all = vec![constants.clone()];
        for (k, part) in material.parts.iter().enumerate() {
            let path = KeyPath::from("material.part").index(k);
            let PartConstants::StateBased { elastic, failure } = &part.constants else {
                return Err(self.other_kind(&path, &part.name));
            };
            let own = LinearSolid {
                density: part.density,
                elastic: *elastic,
                failure: *failure,
                ..state_based.solid.clone()
            };
            let own = own.constants(cloud, solid.state);
            let own = own.map_err(|error| at_path(&path, error.into()))?;
            self.judge_limits(&own, failure, &path, warnings);
            all.push(own);
        }
        let (of_point, density) = self.points_of_parts(material, cloud, sets)?;
        let classes = match of_point {
            None => None,
            Some(of_point) => {
                let classes = SolidClasses::new(of_point, &all);
                let mut classes = classes.map_err(|error| at("material.part", error))?;
                for &(pair, stretch) in &material.interface.critical_stretches {
                    let limits = BondLimits {
                        stretch,
                        ..BondLimits::NONE
                    };
                    classes.set_limits(pair, limits);
                }
                Some(classes)
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
                // The volume method is refused with the model.
                SurfaceCorrection::None | SurfaceCorrection::Volume => SolidSurface::None,
            },
            cracks: surfaces,
            no_fail: &no_fail,
            damage: material.damage.unwrap_or_default(),
        };
        let (operator, cuts) = body.operator().map_err(at_material)?;
        let cracks = self.tracked_cracks(surfaces, &cuts, cloud, warnings);
        let mut all = all.into_iter().map(MaterialConstants::StateBased);
        let constants = all.next();
        if let Some(constants) = &constants {
            warnings.extend(self.judge_speed(solid, constants));
            warnings.extend(self.judge_solid(solid, constants));
        }
        warnings.extend(self.judge_isotropy(constants.as_ref()));
        Ok(BodyParts {
            constants,
            parts: all.collect(),
            bonds: AssembledForce {
                operator,
                cuts,
                form: ForceForm::List,
            },
            cracks,
            density,
        })
    }

    /// Refuses what state-based bodies do not represent, and forms that do not represent them.
    fn refuse_features(&self, solid: &Solid) -> Result<(), BuildError> {
        let shape = &solid.shape;
        let found = [
            (
                Feature::Inclusions,
                !solid.material.inclusions.is_empty(),
                "material.inclusion",
            ),
            (Feature::SeveralSpacings, shape.is_refined(), "body.refine"),
            (
                Feature::GaussNodes,
                shape.has_gauss_nodes(),
                "body.quadrature",
            ),
        ];
        for (feature, present, key) in found {
            if let (true, Some(reason)) = (present, LinearSolidBody::refusal(feature.into())) {
                let (value, allowed) = (feature.words().into(), reason.into());
                return Err(at_path(key, Fault::OutOfRange { value, allowed }));
            }
        }
        let form = solid.material.form;
        form.check(Feature::StateBased.into()).map_err(at_material)
    }

    /// Bonds of real materials break long before they are a fifth longer.
    fn judge_limits(
        &self,
        constants: &LinearSolidConstants,
        failure: &BondFailure,
        path: &KeyPath,
        warnings: &mut Vec<ModelWarning>,
    ) {
        let key = match failure {
            BondFailure::Unbreakable => return,
            BondFailure::CriticalStretch(_) => "critical_stretch",
            BondFailure::Stretch { .. } | BondFailure::BondEnergy { .. } => "fracture_energy",
        };
        self.judge_stretch(constants.limits.stretch, path.key(key), warnings);
    }

    /// Warns of a lattice whose shear stiffness depends on the direction.
    fn judge_isotropy(&self, constants: Option<&MaterialConstants>) -> Option<ModelWarning> {
        /// The conical function at three spacings stays within 4 %.
        const NOTICED: f64 = 0.06;
        let shear = constants?.state_based()?.lattice_shear?;
        let caution = Caution::ShearAnisotropy {
            axes: shear.axes,
            diagonals: shear.diagonals,
        };
        (shear.anisotropy() > NOTICED).then(|| Remark::new("material.influence", caution))
    }
}
