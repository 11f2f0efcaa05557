//! `[damping]`: Rayleigh damping.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;

/// Rayleigh damping, α ρ u_t + β K u_t.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Damping {
    /// Mass-proportional coefficient α, 1/s.
    #[serde(default)]
    pub mass: f64,
    /// Stiffness-proportional coefficient β, s.
    #[serde(default)]
    pub stiffness: f64,
}

pub(crate) fn read(table: Table<'_>) -> Option<Damping> {
    let factor = |key, quantity| {
        table.or(key, 0.0, |item| {
            item.within(quantity, "zero or a positive number", |value| value >= 0.0)
        })
    };
    if !table.has("mass") && !table.has("stiffness") {
        table.requires_one_of(&["mass", "stiffness"]);
    }
    let mass = factor("mass", Quantity::Rate);
    let stiffness = factor("stiffness", Quantity::Time);
    table.finish();
    Some(Damping {
        mass: mass?,
        stiffness: stiffness?,
    })
}
