//! Bonds of a body with cells of several sizes.

use pericles::material::BondMaterial;
use pericles::operator::{CompositeBody, Feature, GradedBody, Materials};
use pericles_deck::{BuildError, Solid};
use pericles_waves::AssembledForce;

use super::assembler::Assembler;
use super::discretisation::Grids;
use super::materials::Between;
use super::refusal::{at, at_material};

impl Assembler<'_> {
    pub(super) fn graded_bonds(
        &self,
        solid: &Solid,
        composite: &CompositeBody<'_>,
        grids: &Grids,
        (materials, interfaces): (&[BondMaterial], &[Between]),
    ) -> Result<AssembledForce, BuildError> {
        let features = composite.features().with(Feature::SeveralSpacings, true);
        solid.material.form.check(features).map_err(at_material)?;
        GradedBody::check(features).map_err(|error| at("material.surface_correction", error))?;
        let body = &composite.body;
        let graded = GradedBody {
            cloud: body.cloud,
            ratios: &grids.ratios,
            grid_of_point: &grids.of_point,
            material: body.material,
            materials: composite.classes.map(|classes| Materials {
                all: materials,
                of_point: classes.of_point(),
                interfaces,
            }),
            state: solid.state,
            cracks: body.cracks,
            no_fail: body.no_fail,
            stiffness: body.stiffness,
            damage: body.damage,
        };
        Ok(graded.operator().map_err(at_material)?.into())
    }
}
