//! Force and material of a body.

use pericles::material::BondMaterial;
use pericles::observe::{Field, TrackedCrack};
use pericles::operator::{BondBody, CompositeBody, Feature};
use pericles::space::PointSet;
use pericles::{Need, PericlesError, PointScalar};
use pericles_deck::{
    BuildError, Caution, Fault, KeyPath, MaterialModel, ModelWarning, Remark, Scheme, Solid,
    SurfaceBody,
};
use pericles_manifold::surface::Surface;
use pericles_waves::{AssembledForce, ForceForm};

use super::assembler::Assembler;
use super::constants::MaterialConstants;
use super::discretisation::{Discretisation, Grids, Sets};
use super::materials::{Between, Composition};
use super::refusal::{at_material, at_path};
use super::resources::Resources;
use crate::composition::requirements;

/// Force and material of a body.
pub(super) struct BodyParts {
    pub(super) constants: Option<MaterialConstants>,
    pub(super) others: Vec<MaterialConstants>,
    pub(super) bonds: AssembledForce,
    pub(super) cracks: Vec<TrackedCrack>,
    pub(super) density: PointScalar,
}

impl Assembler<'_> {
    /// Of a body on a grid or of listed points.
    pub(super) fn grid_parts(
        &self,
        solid: &Solid,
        discretisation: &Discretisation,
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<BodyParts, BuildError> {
        match &solid.material.model {
            MaterialModel::Bonds(material) => {
                self.bond_based_parts(solid, material, discretisation, warnings)
            }
            MaterialModel::StateBased(material) => {
                self.state_based_parts(solid, material, discretisation, warnings)
            }
            MaterialModel::Correspondence(material) => {
                self.correspondence_parts(solid, material, discretisation, warnings)
            }
        }
    }

    fn bond_based_parts(
        &self,
        solid: &Solid,
        material: &BondMaterial,
        discretisation: &Discretisation,
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<BodyParts, BuildError> {
        let Discretisation {
            cloud, grids, sets, ..
        } = discretisation;
        let constants = self
            .constants_of(solid, material, cloud)
            .map_err(at_material)?;
        let known = MaterialConstants::Bonds(constants.clone());
        warnings.extend(self.judge_speed(solid, &known));
        warnings.extend(self.judge_classes(material, &constants));
        warnings.extend(self.judge_solid(solid, &known));
        let no_fail = self.union_of(sets, &solid.material.no_fail)?;
        let stiffness = self.stiffness_of(cloud, sets)?;
        let Composition {
            classes,
            materials,
            interfaces,
            density,
            others,
        } = self.materials(solid, (material, &constants), (cloud, sets), warnings)?;
        let body = BondBody {
            cloud,
            material,
            constants: &constants,
            cracks: &[],
            no_fail: &no_fail,
            stiffness: &stiffness,
            damage: solid.material.damage.unwrap_or_default(),
        };
        let composite = CompositeBody {
            body,
            classes: classes.as_ref(),
            correction: solid.material.surface_correction,
        };
        let (bonds, cracks) =
            self.bonds(solid, composite, (grids, &materials, &interfaces), warnings)?;
        let refused = bonds.form.refusal(Feature::Tensors.into());
        if let (true, Some(reason)) = (self.model.output.wants_tensors(), refused) {
            let fields = "the fields Stress and Strain are";
            return Err(at_path(
                self.field_key(Field::is_tensor),
                Fault::NoFields { fields, reason },
            ));
        }
        Ok(BodyParts {
            bonds,
            cracks,
            density,
            constants: Some(known),
            others: others.into_iter().map(MaterialConstants::Bonds).collect(),
        })
    }

    /// Of a surface.
    pub(super) fn surface_parts(
        &self,
        body: &SurfaceBody,
        surface: &Surface,
        discretisation: &Discretisation,
        resources: &Resources<'_>,
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<BodyParts, BuildError> {
        let Discretisation { cloud, sets, .. } = discretisation;
        self.refuse_body_forces()?;
        let operator = self.surface_operator(body, surface, cloud, sets, resources.cache)?;
        let neighbours = operator.directed_bonds() as f64 / cloud.len() as f64;
        for caution in surface.cautions(body.material.horizon, neighbours) {
            warnings.push(Remark::new("material.horizon", Caution::Surface(caution)));
        }
        Ok(BodyParts {
            bonds: AssembledForce {
                operator,
                cuts: Vec::new(),
                form: ForceForm::List,
            },
            cracks: Vec::new(),
            density: PointScalar::Uniform(body.material.density),
            constants: None,
            others: Vec::new(),
        })
    }

    /// Refuses the dilatation of a body that has none.
    pub(super) fn refuse_dilatation(&self, bonds: &AssembledForce) -> Result<(), BuildError> {
        let is_dilatation = |field| field == Field::Dilatation;
        let known = bonds.operator.capabilities().dilatation.is_some();
        if known || !self.model.output.wants(Field::Dilatation) {
            return Ok(());
        }
        let fault = Fault::NoFields {
            fields: "the field Dilatation is",
            reason: "only state-based and correspondence materials (model = \"state-based\" or \"correspondence\") have a dilatation",
        };
        Err(at_path(self.field_key(is_dilatation), fault))
    }

    /// The key that asks for some fields.
    fn field_key(&self, is_meant: fn(Field) -> bool) -> KeyPath {
        match self
            .model
            .output
            .pictures
            .iter()
            .position(|picture| is_meant(picture.field))
        {
            Some(k) if !self.model.output.names.iter().any(|field| is_meant(*field)) => {
                KeyPath::from("output.picture").index(k)
            }
            _ => "output.fields.names".into(),
        }
    }

    /// The points of the sets whose bonds never break.
    pub(super) fn union_of(&self, sets: &Sets, names: &[String]) -> Result<PointSet, BuildError> {
        let mut points = PointSet::new();
        for name in names {
            points.extend(self.members(sets, name, "material.no_fail")?);
        }
        points.sort_unstable();
        points.dedup();
        Ok(points)
    }

    /// The operator, and what the pre-cracks took from it.
    fn bonds(
        &self,
        solid: &Solid,
        composite: CompositeBody<'_>,
        (grids, materials, interfaces): (&Grids, &[BondMaterial], &[Between]),
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<(AssembledForce, Vec<TrackedCrack>), BuildError> {
        let cloud = composite.body.cloud;
        let surfaces = self.cracks;
        let composite = CompositeBody {
            body: BondBody {
                cracks: surfaces,
                ..composite.body
            },
            ..composite
        };
        let assembled = if grids.ratios.len() > 1 {
            self.graded_bonds(solid, &composite, grids, (materials, interfaces))?
        } else {
            let form = match solid.material.form {
                ForceForm::Fastest
                    if self.model.output.wants_tensors()
                        || has_need(&self.model.time.scheme, Need::FiniteReach) =>
                {
                    composite.fastest_form().into()
                }
                ForceForm::FloatGrid
                    if has_need(&self.model.time.scheme, Need::DoublePrecision) =>
                {
                    return Err(at_material(PericlesError::FormNotUsable {
                        form: ForceForm::FloatGrid.name(),
                        reason: "this scheme needs forces in double precision; use \"grid\", or a Verlet or Runge–Kutta scheme with one step",
                    }));
                }
                form => form,
            };
            pericles_waves::assemble(&composite, form).map_err(at_material)?
        };
        let tracked = self.tracked_cracks(surfaces, &assembled.cuts, cloud, warnings);
        Ok((assembled, tracked))
    }
}

/// Whether a scheme has a need.
fn has_need(scheme: &Scheme, need: Need) -> bool {
    requirements(scheme).iter().any(|one| one.need == need)
}
