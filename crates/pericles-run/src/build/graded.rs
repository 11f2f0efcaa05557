//! Bonds of a body with cells of several sizes.

use pericles::PericlesError;
use pericles::material::PairLaw;
use pericles::operator::{CompositeBody, GradedBody};
use pericles_deck::{BuildError, Solid};
use pericles_waves::AssembledForce;
use pericles_waves::ForceForm;

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
        if !matches!(solid.material.form, ForceForm::Fastest | ForceForm::List) {
            let error = PericlesError::Graded {
                what: "bonds of this form",
                reason: "there is no one lattice; leave `bonds` out or give \"list\"",
            };
            return Err(at("material.bonds", error));
        }
        if !composite.is_plain() {
            let error = PericlesError::Graded {
                what: "several materials or corrected surfaces",
                reason: "its bonds have the laws of two grids already; parts of other stiffness are possible ([[material.inclusion]])",
            };
            return Err(at("material", error));
        }
        if !matches!(
            composite.body.material.law,
            PairLaw::Linear | PairLaw::BondStretch
        ) {
            let error = PericlesError::Graded {
                what: "this model",
                reason: "bonds between cells of two sizes are \"linear\" or \"bond-stretch\"",
            };
            return Err(at("material.model", error));
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
