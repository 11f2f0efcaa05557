//! Schedules of outputs.

use pericles::observe::Schedule;
use pericles_deck_derive::DeckKeys;
use serde::{Deserialize, Serialize};

use crate::form::described;

/// The scope of a schedule is its default.
#[derive(Serialize, Deserialize, DeckKeys)]
#[serde(remote = "Schedule", rename_all = "snake_case")]
#[deck(remote = Schedule, exclusive, scope = Schedule, default = scope)]
enum ScheduleForm {
    Never,
    /// Simulated time between outputs.
    Interval(#[deck(quantity = Time, range = POSITIVE)] f64),
    /// Steps between outputs.
    Every(u64),
    /// Number of outputs over the run.
    Count(u64),
}

described!(Schedule: ScheduleForm);
