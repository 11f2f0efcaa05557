//! The state of a system in checkpoints.

use super::System;
use crate::accounts::Ledger;

crate::saved! {
    impl Checkpointed for System {
        forces: part,
        motions: under("motion"),
        boundaries: part,
        interactions: part,
        fields: part,
        ledger: array("ledger"),
        loading: array("loading"),
        evaluated: array("evaluated"),
        coarse_breaks: array("coarse breaks"),
        cloud, density, loads: fixed,
    }
}

crate::saved! {
    impl Entry<Number = f64> for Ledger { work, exchanged, impulse }
}
