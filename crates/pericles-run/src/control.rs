//! The quantity that controls the loads of a static run.

use std::fmt;

use pericles::observe::{Probe, Snapshot, StartEnergy};
use pericles::time::State;
use pericles::{PericlesError, System};
use pericles_deck::{BuildError, Fault, LoadControl, Model, Remark};
use pericles_statics::ControlledQuantity;

use crate::signals::SignalRegistry;

/// A displacement of a probe, or a quantity derived from displacements of probes.
pub(crate) struct ControlSignal {
    registry: SignalRegistry,
    index: usize,
}

impl ControlSignal {
    /// Creates the quantity of a model.
    ///
    /// # Errors
    /// A name that is not that of a displacement of a probe or of a quantity derived from such displacements.
    pub(crate) fn new(
        control: &LoadControl,
        model: &Model,
        probes: &[Probe],
    ) -> Result<Self, BuildError> {
        let registry = SignalRegistry::of_probes(model, probes);
        let name = &control.quantity;
        match registry.length(name) {
            Some(index) => Ok(Self { registry, index }),
            None => {
                let known: Vec<&str> = registry.lengths().collect();
                let here = match known.as_slice() {
                    [] => "there is no [[probe]]".to_owned(),
                    known => known.join(", "),
                };
                let fault = Fault::OutOfRange {
                    value: name.clone(),
                    allowed: format!(
                        "allowed: a displacement of a [[probe]] or an [[output.quantity]] in metres that is derived from \
                         displacements of probes alone; here: {here}"
                    ),
                };
                Err(Remark::new("time.control.quantity", fault).into())
            }
        }
    }
}

impl ControlledQuantity for ControlSignal {
    fn value(&self, system: &System, t: f64, u: &[f64]) -> pericles::Result<f64> {
        let mut state = State::of(system);
        state.t = t;
        state.u.copy_from_slice(u);
        let start = StartEnergy::default();
        let snapshot = Snapshot::new(system, &state, start, 0.0);
        let value = self.registry.value(&snapshot, self.index);
        value.map_err(PericlesError::Extension)
    }
}

impl fmt::Debug for ControlSignal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("ControlSignal").field(&self.index).finish()
    }
}
