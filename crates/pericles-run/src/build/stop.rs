//! The stop conditions of a model.

use pericles::{StopCondition, StopWhen, System};
use pericles_deck::{BuildError, Fault, KeyPath, StopCondition as StopRule};

use super::assembler::Assembler;
use super::discretisation::Sets;
use super::rejection::at_path;

impl Assembler<'_> {
    /// Returns the stop conditions; those that can never be satisfied are rejected.
    pub(super) fn stops(&self, system: &System, sets: &Sets) -> Result<Vec<StopWhen>, BuildError> {
        let mut stops = Vec::new();
        for (k, stop) in self.model.time.stop_when.iter().enumerate() {
            let path = KeyPath::from("time.stop_when").index(k);
            let never = |reason| {
                let set = stop.set.clone();
                Err(at_path(&path, Fault::NeverStops { set, reason }))
            };
            let condition = match stop.condition {
                StopRule::ReactionBelow(share) => {
                    // The prescribed motions of a system are in the order of the deck.
                    let of_set = |k: &usize| self.model.constraints[*k].set == stop.set;
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
                StopRule::DamageAbove(damage) => {
                    let points = self.members(sets, &stop.set, &path)?.clone();
                    StopCondition::DamageAbove { damage, points }
                }
            };
            stops.push(StopWhen::new(stop.set.clone(), condition));
        }
        Ok(stops)
    }
}
