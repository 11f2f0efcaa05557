//! The stop conditions of a model.

use std::sync::Arc;

use pericles::{StopCondition, StopWhen, System};
use pericles_deck::{BuildError, Fault, KeyPath, StopCondition as StopRule};

use super::assembler::Assembler;
use super::discretisation::Sets;
use super::rejection::at_path;
use crate::signals::{SignalRegistry, SignalStop};

impl Assembler<'_> {
    /// Returns the stop conditions; those that can never be satisfied are rejected.
    pub(super) fn stops(
        &self,
        system: &System,
        sets: &Sets,
        signals: &Arc<SignalRegistry>,
    ) -> Result<Vec<StopWhen>, BuildError> {
        let mut stops = Vec::new();
        for (k, stop) in self.model.time.stop_when.iter().enumerate() {
            let path = KeyPath::from("time.stop_when").index(k);
            let set = stop.set.clone().unwrap_or_default();
            let never = |reason| {
                let fault = Fault::other(
                    "never met",
                    format!("the stop condition on `{set}` can never be met: {reason}"),
                    "reaction_below needs a set with a [[constraint]], damage_above a material with fracture",
                );
                Err(at_path(&path, fault))
            };
            let condition = match &stop.condition {
                StopRule::Holds(condition) => {
                    let test = SignalStop::new(signals, condition, &path.key("condition"))?;
                    let name = condition.text().to_owned();
                    stops.push(StopWhen::new(name, StopCondition::Test(Arc::new(test))));
                    continue;
                }
                &StopRule::ReactionBelow(share) => {
                    // The prescribed motions of a system are in the order of the deck.
                    let of_set = |k: &usize| self.model.constraints[*k].set == set;
                    let motions: Vec<usize> =
                        (0..self.model.constraints.len()).filter(of_set).collect();
                    if motions.is_empty() {
                        return never(
                            "no [[constraint]] refers to this set, so it has no reaction",
                        );
                    }
                    StopCondition::ReactionBelow { share, motions }
                }
                StopRule::DamageAbove(_) if !system.operator().can_break() => {
                    return never("the bonds of this body do not break");
                }
                &StopRule::DamageAbove(damage) => {
                    let points = self.members(sets, &set, &path)?.clone();
                    StopCondition::DamageAbove { damage, points }
                }
            };
            stops.push(StopWhen::new(set, condition));
        }
        Ok(stops)
    }
}
