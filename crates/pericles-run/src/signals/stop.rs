//! Conditions on signals that end a run.

use std::sync::Arc;

use pericles::observe::{ObserveError, Snapshot};
use pericles_deck::{BuildError, Fault, KeyPath, Remark, SignalCondition};

use super::SignalRegistry;
use crate::units::{quantity, significant};

/// Formats a value; units that are not one symbol or a quotient take no prefix.
fn shown(value: f64, unit: &str) -> String {
    match unit.starts_with("kg") || unit.starts_with('1') || unit.contains(['^', ' ']) {
        true => format!("{} {unit}", significant(value, 4)),
        false => quantity(value, unit),
    }
}

/// A condition on signals that ends a run.
#[derive(Debug)]
pub(crate) struct SignalStop {
    registry: Arc<SignalRegistry>,
    condition: SignalCondition,
    /// The signals of the condition.
    indices: Vec<usize>,
}

impl SignalStop {
    /// Creates a condition of a key of the deck.
    ///
    /// # Errors
    /// The condition refers to an unknown column, or compares values with different units.
    pub(crate) fn new(
        registry: &Arc<SignalRegistry>,
        condition: &SignalCondition,
        path: &KeyPath,
    ) -> Result<Self, BuildError> {
        let names = condition.names();
        let indices: Result<Vec<usize>, BuildError> = names
            .iter()
            .map(|name| registry.index(name, path))
            .collect();
        let indices = indices?;
        let of = |name: &str| {
            let mut known = names.iter().zip(&indices);
            known.find(|(known, _)| **known == name).map(|(_, &k)| k)
        };
        let unit = |name: &str| of(name).map_or("", |k| registry.unit(k)).to_owned();
        let whole = |name: &str| of(name).map_or("", |k| registry.whole_unit(k)).to_owned();
        let checked = condition.check_units(&unit);
        let checked = checked.or_else(|reason| condition.check_units(&whole).map_err(|_| reason));
        checked.map_err(|reason| {
            let fault = Fault::BadCondition {
                text: condition.text().into(),
                reason,
                allowed: "compare values with the same unit; plain numbers are in its SI unit",
            };
            BuildError::from(Remark::new(path.clone(), fault))
        })?;
        Ok(Self {
            registry: Arc::clone(registry),
            condition: condition.clone(),
            indices,
        })
    }
}

impl pericles::StopTest for SignalStop {
    fn test(&self, snapshot: &Snapshot<'_>) -> Result<Option<String>, ObserveError> {
        let values = self.registry.values(snapshot, &self.indices)?;
        let names = self.condition.names();
        let index = |name: &String| {
            let place = names.iter().position(|known| known == name);
            self.indices[place.unwrap_or_default()]
        };
        let holds = self.condition.holds(&|side| {
            let given: Vec<f64> = side
                .names()
                .iter()
                .map(|name| values[index(name)])
                .collect();
            side.value(&given)
        });
        if !snapshot.system().domain().all(holds) {
            return Ok(None);
        }
        let shown = self.indices.iter().map(|&k| {
            let (name, unit) = (self.registry.name(k), self.registry.unit(k));
            format!("{name} = {}", shown(values[k], unit))
        });
        Ok(Some(shown.collect::<Vec<_>>().join(", ")))
    }
}
