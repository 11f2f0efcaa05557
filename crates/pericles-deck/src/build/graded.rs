//! Bonds of a body with cells of several sizes.

use pericles::PericlesError;
use pericles::material::PairLaw;
use pericles::operator::{CompositeBody, GradedBody};
use pericles_waves::AssembledForce;
use pericles_waves::ForceForm;

use crate::deck::Deck;
use crate::error::DeckError;

/// The grids of a body.
#[derive(Clone, Copy)]
pub(super) struct Grids<'a> {
    /// Division of each grid's cells.
    pub(super) ratios: &'a [u32],
    /// The grid of each point.
    pub(super) of_point: &'a [u8],
}

impl Deck {
    pub(super) fn graded_bonds(
        &self,
        composite: &CompositeBody<'_>,
        grids: Grids<'_>,
    ) -> Result<AssembledForce, DeckError> {
        if !matches!(self.material.form, ForceForm::Fastest | ForceForm::List) {
            let error = PericlesError::Graded {
                what: "bonds of this form",
                reason: "there is no one lattice; leave `bonds` out or give \"list\"",
            };
            return Err(self.at("material.bonds", error));
        }
        if !composite.is_plain() {
            let error = PericlesError::Graded {
                what: "several materials or corrected surfaces",
                reason: "its bonds have the laws of two grids already; parts of other stiffness are possible ([[material.inclusion]])",
            };
            return Err(self.at("material", error));
        }
        if !matches!(
            composite.body.material.law,
            PairLaw::Linear | PairLaw::BondStretch
        ) {
            let error = PericlesError::Graded {
                what: "this model",
                reason: "bonds between cells of two sizes are \"linear\" or \"bond-stretch\"",
            };
            return Err(self.at("material.model", error));
        }
        let body = &composite.body;
        let graded = GradedBody {
            cloud: body.cloud,
            ratios: grids.ratios,
            grid_of_point: grids.of_point,
            material: body.material,
            state: self.body.state,
            cracks: body.cracks,
            no_fail: body.no_fail,
            stiffness: body.stiffness,
            damage: body.damage,
        };
        let bonds = graded.operator().map_err(|error| match error {
            PericlesError::Graded { .. } => self.at("material.fracture_energy", error),
            error => self.at_material(error),
        })?;
        Ok(bonds.into())
    }
}
