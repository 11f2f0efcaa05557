//! `[[time.stop_when]]`: conditions that end a run before its last step.

use serde::{Deserialize, Serialize};

use crate::expression::SignalCondition;
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::SetNames;

/// A stop condition; the run ends after the first step at which one is met.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StopWhen {
    /// Name of the set of points; none for conditions on scalars of the run.
    #[serde(default)]
    pub set: Option<String>,
    /// The condition.
    pub condition: StopCondition,
}

/// Kinds of stop conditions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StopCondition {
    /// The reaction is below this fraction of its maximum.
    ReactionBelow(f64),
    /// The damage of any point is above this value.
    DamageAbove(f64),
    /// A condition on columns of the tables and derived quantities.
    Holds(SignalCondition),
}

pub(crate) fn stop_when(table: Table<'_>, sets: &SetNames) -> Option<StopWhen> {
    const CONDITION: &str = "condition";
    let of_set = !table.has(CONDITION);
    let set = if of_set {
        let set = table.required("set").and_then(|item| sets.reference(&item));
        set.map(Some)
    } else {
        table.forbid("set", "`condition` refers to columns of the tables");
        Some(None)
    };
    let condition = table
        .exactly_one(&["reaction_below", "damage_above", CONDITION])
        .and_then(|(key, item)| match key {
            "reaction_below" => {
                let share = item.within(
                    Quantity::Number,
                    "a number above 0 and below 1, a fraction of the largest reaction so far",
                    |share| share > 0.0 && share < 1.0,
                );
                share.map(StopCondition::ReactionBelow)
            }
            "damage_above" => {
                let damage = item.within(
                    Quantity::Number,
                    "a damage of at least 0 and below 1",
                    |damage| (0.0..1.0).contains(&damage),
                );
                damage.map(StopCondition::DamageAbove)
            }
            _ => condition(&item).map(StopCondition::Holds),
        });
    table.finish();
    Some(StopWhen {
        set: set?,
        condition: condition?,
    })
}

fn condition(item: &Item<'_>) -> Option<SignalCondition> {
    let text = item.text()?;
    match SignalCondition::parse(&text) {
        Ok(condition) => Some(condition),
        Err(malformed) => {
            item.report(Fault::BadCondition {
                text,
                reason: malformed.reason,
                allowed: SignalCondition::ALLOWED,
            });
            None
        }
    }
}
