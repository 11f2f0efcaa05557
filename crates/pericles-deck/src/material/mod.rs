//! `[material]`: constants, horizon, influence function and breaking.

mod bond_based;
mod keys;
mod linear_solid;
mod types;

pub use types::{Inclusion, Material, MaterialModel};

pub(crate) use bond_based::inclusion;

use pericles::material::PairLaw;

use crate::body::BodyRead;
use crate::reader::Table;
use crate::set::SetNames;

pub(crate) fn read(table: Table<'_>, body: &BodyRead, sets: &SetNames) -> Option<Material> {
    match model(&table) {
        Some(ModelWord::StateBased) => linear_solid::read(table, body, sets),
        Some(ModelWord::Law(law)) => bond_based::read(table, Some(law), body, sets),
        None => bond_based::read(table, None, body, sets),
    }
}

/// The word of `model`.
#[derive(Clone, Copy)]
enum ModelWord {
    Law(PairLaw),
    StateBased,
}

fn model(table: &Table<'_>) -> Option<ModelWord> {
    table.choice_or_first(
        "model",
        "model",
        &[
            ("bond-stretch", ModelWord::Law(PairLaw::BondStretch)),
            ("linear", ModelWord::Law(PairLaw::Linear)),
            ("green-strain", ModelWord::Law(PairLaw::GreenStrain)),
            ("literal57", ModelWord::Law(PairLaw::Literal57)),
            ("state-based", ModelWord::StateBased),
        ],
    )
}
