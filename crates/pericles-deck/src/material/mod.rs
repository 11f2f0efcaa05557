//! `[material]` and `[materials.NAME]`: constants, horizon, influence function and failure.

mod bond_based;
mod correspondence;
mod inelastic;
mod keys;
mod linear_solid;
mod scatter;
mod several;
mod shared;
mod softening;
mod types;

pub use scatter::{Scatter, ScatteredStrength};
pub use softening::{BondSoftening, FailureSurface};
pub use types::{Material, MaterialModel, NamedMaterial};

pub(crate) use several::{Materials, read};
pub(crate) use shared::difference;

use pericles::material::PairLaw;

use crate::body::BodyRead;
use crate::reader::Table;
use crate::set::SetNames;

/// Reads the table of a material. `shared`: other materials inherit its shared keys.
fn material(table: Table<'_>, body: &BodyRead, sets: &SetNames, shared: bool) -> Option<Material> {
    match model(&table) {
        Some(ModelWord::StateBased) => linear_solid::read(table, body, sets, shared),
        Some(ModelWord::Correspondence) => correspondence::read(table, body, sets, shared),
        Some(ModelWord::Law(law)) => bond_based::read(table, Some(law), body, sets, shared),
        None => bond_based::read(table, None, body, sets, shared),
    }
}

/// Words of `model`.
#[derive(Clone, Copy)]
enum ModelWord {
    Law(PairLaw),
    StateBased,
    Correspondence,
}

fn model(table: &Table<'_>) -> Option<ModelWord> {
    table.choice_or_first(
        "model",
        "model",
        &[
            ("bond-stretch", ModelWord::Law(PairLaw::BondStretch)),
            ("linear", ModelWord::Law(PairLaw::Linear)),
            ("green-strain", ModelWord::Law(PairLaw::GreenStrain)),
            ("cubic-softening", ModelWord::Law(PairLaw::CubicSoftening)),
            ("state-based", ModelWord::StateBased),
            ("correspondence", ModelWord::Correspondence),
        ],
    )
}
