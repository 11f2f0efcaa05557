//! Serialised form of output schedules.

use pericles::observe::Schedule;
use serde::{Deserialize, Serialize};

use super::described;

#[derive(Serialize, Deserialize)]
#[serde(remote = "Schedule", rename_all = "snake_case")]
enum ScheduleForm {
    Never,
    Every(u64),
    Interval(f64),
    Count(u64),
}

described!(Schedule: ScheduleForm);
