//! Options of `scheme = "adaptive-dynamic-relaxation"` and `scheme = "fire"`.

use pericles::time::{Damping, RelaxationOptions};

use crate::quantity::Quantity;
use crate::reader::{Item, Table};

/// Keys of adaptive dynamic relaxation only.
pub(crate) const KEYS: [&str; 1] = ["damping"];

/// The key of static schemes for the number of load steps.
pub(crate) const LOAD_STEPS: &str = "load_steps";

/// Default pseudo-time at which all loads have their final values.
pub(crate) const END: f64 = 1.0;

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
    let default = RelaxationOptions::default();
    let tolerance = table.or("tolerance", default.tolerance, |item| {
        item.within(
            Quantity::Number,
            "a number from 1e-12 to 0.1, the residual relative to loads and reactions",
            |tolerance| (1e-12..=0.1).contains(&tolerance),
        )
    });
    let iterations = table.or("iterations", default.iterations, |item| {
        const MOST: u64 = 100_000_000;
        let count = item.count()?;
        if count <= MOST {
            return Some(count as u32);
        }
        item.out_of_range("a whole number from 1 to 100000000");
        None
    });
    Some(RelaxationOptions {
        damping: damping?,
        tolerance: tolerance?,
        iterations: iterations?,
    })
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
