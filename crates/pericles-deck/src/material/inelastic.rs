//! Reads viscosity and plasticity of state-based materials.

use pericles::material::StressState;
use pericles_solids::inelastic::{Inelasticity, ViscousTerm};

use crate::quantity::Quantity;
use crate::reader::Table;
use crate::state_based::read_yield;

/// Reads the inelastic shear behaviour of a material.
pub(super) fn read(table: &Table<'_>, state: Option<StressState>) -> Option<Inelasticity> {
    let law = match table.has("viscosity") {
        true => {
            for key in ["yield_stress", "hardening"] {
                table.forbid(
                    key,
                    "a material is either viscous or plastic: remove `viscosity` or this key",
                );
            }
            let terms: Vec<_> = table.tables("viscosity").into_iter().map(term).collect();
            Inelasticity::Viscous(terms.into_iter().collect::<Option<_>>()?)
        }
        false => read_yield(table)?.map_or(Inelasticity::Elastic, Inelasticity::Plastic),
    };
    table.accept(law.check(state?))?;
    Some(law)
}

/// Reads a term of the relaxation function.
fn term(table: Table<'_>) -> Option<ViscousTerm> {
    let share = table.required("share").and_then(|item| {
        item.within(Quantity::Number, "a number between 0 and 1", |share| {
            share > 0.0 && share < 1.0
        })
    });
    let time = table
        .required("time")
        .and_then(|item| item.positive(Quantity::Time));
    table.finish();
    Some(ViscousTerm {
        share: share?,
        time: time?,
    })
}
