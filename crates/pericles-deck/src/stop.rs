//! `[[time.stop_when]]`: conditions that end a run before its last step.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;
use crate::set::SetNames;

/// A stop condition on a set of points; the run ends after the first step at which one is met.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StopWhen {
    /// Name of the set.
    pub set: String,
    /// The condition.
    pub condition: StopCondition,
}

/// Kinds of stop conditions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StopCondition {
    /// The reaction is below this fraction of its maximum.
    ReactionBelow(f64),
    /// The damage of any point is above this value.
    DamageAbove(f64),
}

pub(crate) fn stop_when(table: Table<'_>, sets: &SetNames) -> Option<StopWhen> {
    let set = table.required("set").and_then(|item| sets.reference(&item));
    let condition = table
        .exactly_one(&["reaction_below", "damage_above"])
        .and_then(|(key, item)| {
            if key == "reaction_below" {
                let share = item.within(
                    Quantity::Number,
                    "a number above 0 and below 1, a fraction of the largest reaction so far",
                    |share| share > 0.0 && share < 1.0,
                );
                share.map(StopCondition::ReactionBelow)
            } else {
                let damage = item.within(
                    Quantity::Number,
                    "a damage of at least 0 and below 1",
                    |damage| (0.0..1.0).contains(&damage),
                );
                damage.map(StopCondition::DamageAbove)
            }
        });
    table.finish();
    Some(StopWhen {
        set: set?,
        condition: condition?,
    })
}
