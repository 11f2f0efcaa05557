//! Reads viscosity and plasticity of state-based materials.

use pericles_deck_derive::DeckTable;
use pericles_solids::inelastic::{Inelasticity, ViscousTerm, Yield};
use serde::{Deserialize, Serialize};

use super::scope::MaterialScope;
use crate::declaration::declared;
use crate::form::described;
use crate::reader::Table;
use crate::state_based::read_yield;

/// Reads the inelastic shear behaviour of a material.
pub(super) fn read(table: &Table<'_>, scope: MaterialScope<'_>) -> Option<Inelasticity> {
    let law = match table.has("viscosity") {
        true => {
            for key in ["yield_stress", "hardening"] {
                table.forbid(
                    key,
                    "a material is either viscous or plastic: remove `viscosity` or this key",
                );
            }
            Inelasticity::Viscous(declared(table, "viscosity", ())?)
        }
        false => read_yield(table, scope)?.map_or(Inelasticity::Elastic, Inelasticity::Plastic),
    };
    table.accept(law.check(scope.state()?))?;
    Some(law)
}

/// One term of the relaxation function of a viscoelastic material.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "ViscousTerm", deny_unknown_fields)]
#[deck(remote = ViscousTerm)]
struct ViscousTermForm {
    /// Share λ of the shear modulus that relaxes.
    #[deck(range = between(0.0, 1.0).described("a number between 0 and 1"))]
    share: f64,
    /// Relaxation time τ.
    #[deck(quantity = Time, range = POSITIVE)]
    time: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(
    remote = "Inelasticity",
    rename_all = "snake_case",
    deny_unknown_fields
)]
enum InelasticityForm {
    Elastic,
    Viscous(#[serde(with = "crate::form")] Vec<ViscousTerm>),
    Plastic(#[serde(with = "crate::form")] Yield),
}

described!(ViscousTerm: ViscousTermForm, Inelasticity: InelasticityForm);
