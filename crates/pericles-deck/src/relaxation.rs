//! Options of `scheme = "adaptive-dynamic-relaxation"` and `scheme = "fire"`.

use pericles::time::{Damping, RelaxationOptions};
use pericles_deck_derive::DeckTable;
use serde::{Deserialize, Serialize};

use crate::declaration::DeckKeys;
use crate::form::described;
use crate::quantity::Quantity;
use crate::range::{Range, from_to};
use crate::reader::{Item, Table};

/// Keys of adaptive dynamic relaxation only.
pub(crate) const KEYS: [&str; 1] = ["damping"];

/// The key of static schemes for the number of load steps.
pub(crate) const LOAD_STEPS: &str = "load_steps";

/// Default pseudo-time at which all loads have their final values.
pub(crate) const END: f64 = 1.0;

/// The scope is the damping, which one of the two schemes reads.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "RelaxationOptions", deny_unknown_fields)]
#[deck(remote = RelaxationOptions, scope = Option<Damping>)]
struct RelaxationOptionsForm {
    #[serde(with = "crate::form")]
    #[deck(flatten, keys(), with = given)]
    damping: Damping,
    #[deck(range = RESIDUALS, default = RelaxationOptions::default().tolerance)]
    tolerance: f64,
    #[deck(range = count_to(100_000_000), default = RelaxationOptions::default().iterations)]
    iterations: u32,
}

/// Range of relative residuals.
const RESIDUALS: Range = from_to(1e-12, 0.1)
    .described("a number from 1e-12 to 0.1, the residual relative to loads and reactions");

fn given(_: &Table<'_>, damping: Option<Damping>) -> Option<Damping> {
    damping
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Damping", rename_all = "snake_case")]
enum DampingForm {
    Adaptive,
    Viscous(f64),
    Fire,
}

described!(
    RelaxationOptions: RelaxationOptionsForm,
    Damping: DampingForm,
);

/// Reads the damping of adaptive dynamic relaxation.
pub(crate) fn damping(table: &Table<'_>) -> Option<Damping> {
    match table.optional("damping") {
        None => {
            table.record("damping", "adaptive");
            Some(Damping::Adaptive)
        }
        Some(item) => damping_of(&item),
    }
}

/// Reads the options of both schemes.
pub(crate) fn read(table: &Table<'_>, damping: Option<Damping>) -> Option<RelaxationOptions> {
    RelaxationOptions::read_keys(table, damping)
}

fn damping_of(item: &Item<'_>) -> Option<Damping> {
    if item.is_keyword("adaptive") {
        return Some(Damping::Adaptive);
    }
    match item.word() {
        Some(word) if !word.contains(|c: char| c.is_ascii_digit()) => {
            item.unknown_word("damping", word, std::iter::once("adaptive"));
            None
        }
        _ => item
            .within(
                Quantity::Number,
                "\"adaptive\", or a number above 0 and below 2, per iteration",
                |c| c > 0.0 && c < 2.0,
            )
            .map(Damping::Viscous),
    }
}

/// Reads the number of load steps up to the end.
pub(crate) fn load_steps(table: &Table<'_>) -> Option<u64> {
    for key in ["dt", "safety"] {
        table.forbid(key, "static schemes have no time step: set load_steps");
    }
    table.or(LOAD_STEPS, 1, |item| item.count())
}
