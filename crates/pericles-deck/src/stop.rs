//! `[[time.stop_when]]`: conditions that end a run before its last step.

use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use crate::expression::SignalCondition;
use crate::fault::Fault;
use crate::range::{Range, between, from_below};
use crate::reader::Item;
use crate::set::SetNames;

/// Condition that ends the run early, as if at its last step: output is written, the exit status is 0, and run.json names
/// the condition. Evaluated after every step or load step. Any number of tables.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = &'s SetNames)]
pub struct StopWhen {
    /// The condition.
    #[deck(flatten)]
    pub condition: StopCondition,
    /// Monitored set of points.
    ///
    /// None for conditions on scalars of the run.
    #[serde(default)]
    #[deck(
        with = set_name,
        required_if(is_of_set(condition)),
        forbid_if(is_of_scalars(condition), "`condition` refers to columns of the tables")
    )]
    pub set: Option<String>,
}

/// Kinds of stop conditions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case")]
#[deck(exclusive)]
pub enum StopCondition {
    /// Stop when the reaction of the set, the norm of the sum of its support forces, falls below this fraction of its
    /// maximum so far. The set needs a `[[constraint]]`. The reaction oscillates through zero in dynamic runs.
    ReactionBelow(#[deck(range = REACTIONS)] f64),
    /// Stop when the damage of any point of the set exceeds this value.
    DamageAbove(#[deck(range = DAMAGES)] f64),
    /// Stop when this condition holds: comparisons of columns of the tables of the run and of quantities of
    /// `[[output.quantity]]`, such as "CMOD > 1e-4 && broken_bonds > 0", combined with `&&` (and), `||` (or) and `!`
    /// (not), in SI units. Comparisons with missing values are false. Energies and crack tips take additional time per
    /// step.
    #[deck(key = "condition")]
    Holds(#[deck(with = condition)] SignalCondition),
}

/// Range of fractions of the largest reaction.
const REACTIONS: Range = between(0.0, 1.0)
    .described("a number above 0 and below 1, a fraction of the largest reaction so far");

/// Range of damages that can be exceeded.
const DAMAGES: Range = from_below(0.0, 1.0).described("a damage of at least 0 and below 1");

fn is_of_scalars(condition: Option<&StopCondition>) -> bool {
    matches!(condition, Some(StopCondition::Holds(_)))
}

fn is_of_set(condition: Option<&StopCondition>) -> bool {
    use StopCondition::{DamageAbove, ReactionBelow};
    matches!(condition, Some(ReactionBelow(_) | DamageAbove(_)))
}

fn set_name(item: &Item<'_>, sets: &SetNames) -> Option<String> {
    sets.reference(item)
}

fn condition<S>(item: &Item<'_>, _: S) -> Option<SignalCondition> {
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
