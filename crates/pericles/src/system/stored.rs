//! The state of a system in checkpoints.

use super::System;
use crate::accounts::Ledger;
use crate::archive::{Laid, Layout};

crate::saved! {
    impl Checkpointed for System {
        forces: part,
        motions: under("motion"),
        boundaries: part,
        interactions: part,
        fields: part,
        activation: part,
        ledger: array("ledger"),
        loading: array("loading"),
        evaluated: by(Laid::new("evaluated", Layout::Count)),
        coarse_breaks: by(Laid::new("coarse breaks", Layout::Count)),
        cloud, density, loads: fixed,
    } then |system| {
        system.note_active();
        Ok(())
    }
}

crate::saved! {
    impl Entry<Number = f64> for Ledger { work, largest_work, exchanged, impulse }
}
