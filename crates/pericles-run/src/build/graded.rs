//! Bonds of a body with cells of several sizes.

use pericles::PericlesError;
use pericles::operator::{CompositeBody, Feature, GradedBody};
use pericles_deck::{BuildError, Solid};
use pericles_waves::AssembledForce;

use super::assembler::Assembler;
use super::discretisation::Grids;
use super::refusal::{at, at_material};

impl Assembler<'_> {
    pub(super) fn graded_bonds(
        &self,
        solid: &Solid,
        composite: &CompositeBody<'_>,
        grids: &Grids,
    ) -> Result<AssembledForce, BuildError> {
        let features = composite.features().with(Feature::SeveralSpacings, true);
        solid.material.form.check(features).map_err(at_material)?;
        if !composite.is_plain() {
            let error = PericlesError::Graded {
                what: "several materials or corrected surfaces",
                reason: "its bonds have the laws of two grids already; parts of other stiffness are possible ([[material.inclusion]])",
            };
            return Err(at("material", error));
        }
        let body = &composite.body;
        let graded = GradedBody {
            cloud: body.cloud,
            ratios: &grids.ratios,
            grid_of_point: &grids.of_point,
            material: body.material,
            state: solid.state,
            cracks: body.cracks,
            no_fail: body.no_fail,
            stiffness: body.stiffness,
            damage: body.damage,
        };
        let bonds = graded.operator().map_err(|error| match error {
            PericlesError::Graded { .. } => at("material.fracture_energy", error),
            error => at_material(error),
        })?;
        Ok(bonds.into())
    }
}
