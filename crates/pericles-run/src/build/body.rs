//! Force and material of a body.

use pericles::material::{BondConstants, BondMaterial};
use pericles::observe::TrackedCrack;
use pericles::operator::{BondBody, CompositeBody, Feature};
use pericles::space::{PointCloud, PointSet};
use pericles::{Need, PericlesError, PointScalar};
use pericles_deck::{
    BuildError, Caution, Fault, Inclusion, KeyPath, ModelWarning, Remark, Scheme, Solid,
    SurfaceBody,
};
use pericles_manifold::surface::Surface;
use pericles_waves::{AssembledForce, ForceForm};

use super::assembler::Assembler;
use super::discretisation::{Discretisation, Grids, Sets};
use super::parts::Composition;
use super::refusal::{at_material, at_path};
use super::resources::Resources;
use crate::composition::requirements;

/// Force and material of a body.
pub(super) struct BodyParts {
    pub(super) constants: Option<BondConstants>,
    pub(super) parts: Vec<BondConstants>,
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
        let Discretisation {
            cloud, grids, sets, ..
        } = discretisation;
        let material = &solid.material.bonds;
        let constants = self
            .constants_of(solid, material, cloud)
            .map_err(at_material)?;
        warnings.extend(self.judge_speed(solid, &constants));
        warnings.extend(self.judge_classes(solid, &constants));
        warnings.extend(self.judge_solid(solid, &constants));
        let no_fail = self.union_of(sets, &solid.material.no_fail)?;
        let stiffness = self.stiffness_of(&solid.material.inclusions, cloud, sets)?;
        let Composition {
            classes,
            materials,
            density,
            parts,
        } = self.parts(solid, cloud, sets, &constants, warnings)?;
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
        let (bonds, cracks) = self.bonds(solid, composite, (grids, &materials), warnings)?;
        let refused = bonds.form.refusal(Feature::Tensors.into());
        if let (true, Some(reason)) = (self.model.output.wants_tensors(), refused) {
            return Err(at_path(self.tensor_key(), Fault::NoTensors { reason }));
        }
        Ok(BodyParts {
            bonds,
            cracks,
            density,
            constants: Some(constants),
            parts,
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
            parts: Vec::new(),
        })
    }

    /// The key that asks for stress or strain.
    fn tensor_key(&self) -> KeyPath {
        match self
            .model
            .output
            .pictures
            .iter()
            .position(|picture| picture.field.is_tensor())
        {
            Some(k)
                if !self
                    .model
                    .output
                    .names
                    .iter()
                    .any(|field| field.is_tensor()) =>
            {
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

    /// Stiffness of each point over the material's; empty without inclusions.
    pub(super) fn stiffness_of(
        &self,
        inclusions: &[Inclusion],
        cloud: &PointCloud,
        sets: &Sets,
    ) -> Result<Vec<f64>, BuildError> {
        let mut stiffness = vec![
            1.0;
            if inclusions.is_empty() {
                0
            } else {
                cloud.len()
            }
        ];
        for (k, inclusion) in inclusions.iter().enumerate() {
            let path = KeyPath::from("material.inclusion").index(k);
            for &i in self.members(sets, &inclusion.set, &path)? {
                stiffness[i as usize] = inclusion.stiffness;
            }
        }
        Ok(stiffness)
    }

    /// The operator, and what the pre-cracks took from it.
    fn bonds(
        &self,
        solid: &Solid,
        composite: CompositeBody<'_>,
        (grids, materials): (&Grids, &[BondMaterial]),
        warnings: &mut Vec<ModelWarning>,
    ) -> Result<(AssembledForce, Vec<TrackedCrack>), BuildError> {
        let crack = |k| KeyPath::from("crack").index(k);
        for (k, pre_crack) in self.model.cracks.iter().enumerate() {
            // The library tells what is wrong with a crack, not with which.
            pre_crack
                .surface
                .cutter(pre_crack.ends, 0.0)
                .map_err(|error| at_path(crack(k), error.into()))?;
        }
        let cloud = composite.body.cloud;
        let surfaces: Vec<_> = self
            .model
            .cracks
            .iter()
            .map(|crack| (crack.surface.clone(), crack.ends))
            .collect();
        let composite = CompositeBody {
            body: BondBody {
                cracks: &surfaces,
                ..composite.body
            },
            ..composite
        };
        let assembled = if grids.ratios.len() > 1 {
            self.graded_bonds(solid, &composite, grids, materials)?
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
        let mut tracked = Vec::new();
        for (k, ((surface, _), cut)) in surfaces.iter().zip(&assembled.cuts).enumerate() {
            if cut.bonds == 0 {
                let caution = Self::useless_crack(surface, cloud);
                warnings.push(Remark::new(crack(k), caution));
            }
            tracked.push(TrackedCrack {
                crack: surface.clone(),
                points: cut.points.clone(),
            });
        }
        Ok((assembled, tracked))
    }
}

/// Whether a scheme has a need.
fn has_need(scheme: &Scheme, need: Need) -> bool {
    requirements(scheme).iter().any(|one| one.need == need)
}
