//! The stop conditions of a model.

use pericles::{StopCondition, StopWhen, System};
use pericles_deck::{BuildError, Fault, KeyPath, StopCondition as StopRule};

use super::assembler::Assembler;
use super::discretisation::Sets;
use super::refusal::at_path;

impl Assembler<'_> {
    /// The stop conditions; those that can never be met are refused.
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
                    // The motions of a system are those of the deck, in its order.
                    let of_set = |k: &usize| self.model.prescribe[*k].set == stop.set;
                    let motions: Vec<usize> =
                        (0..self.model.prescribe.len()).filter(of_set).collect();
                    if motions.is_empty() {
                        return never(
                            "no [[prescribe]] names this set, so that it has no reaction",
                        );
                    }
                    StopCondition::ReactionBelow { share, motions }
                }
                StopRule::DamageAbove(_) if !system.operator().can_break() => {
                    return never("the bonds of this body never break");
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
