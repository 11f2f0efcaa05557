//! `[damping]`: Rayleigh damping.

use pericles_deck_derive::DeckTable;
use serde::{Deserialize, Serialize};

/// Rayleigh damping: ρ u_tt = f − α ρ u_t − β K u_t. A vibration of angular frequency ω has the damping ratio
/// (α/ω + β ω)/2. Constrained points are not damped.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(at_least_one("mass", "stiffness"))]
pub struct Damping {
    /// Mass-proportional coefficient α. Needs scheme = "velocity-verlet", rk3, rk4, dormand-prince, multirate-rk3 or
    /// multirate-rk4.
    ///
    /// In 1/s.
    #[serde(default)]
    #[deck(quantity = Rate, range = NOT_NEGATIVE, default = 0.0)]
    pub mass: f64,
    /// Stiffness-proportional coefficient β; K is the tangent stiffness of the intact bonds in the current
    /// configuration. Needs scheme = "velocity-verlet". dt = "auto" stays below 1/(β ω²) with the highest frequency ω.
    ///
    /// In s.
    #[serde(default)]
    #[deck(quantity = Time, range = NOT_NEGATIVE, default = 0.0)]
    pub stiffness: f64,
}
