//! Steps in which a quantity of the displacements is prescribed.

use pericles::boundary::{Exchange, ProportionalLoading};
use pericles::time::State;
use pericles::{Interrupt, Result, System};

use super::{StaticScheme, chord};
use crate::control::Control;
use crate::error::StaticsError;
use crate::path::{LoadStep, Loading};
use crate::reference::Reference;

impl StaticScheme {
    /// Advances `state` to the static state in which the controlled quantity has its value at time `t`, and breaks the
    /// bonds beyond their limits at this value until no bond breaks.
    pub(super) fn step_controlled(
        &mut self,
        system: &mut System,
        state: &mut State,
        (t, control): (f64, &Control),
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        self.prepare(system, control.reference)?;
        let first = state.step == 0;
        if first && !system.domain().all(state.u.iter().all(|u| *u == 0.0)) {
            return Err(StaticsError::NoControl {
                reason: "an initial displacement is not a multiple of the loads (remove it from [[initial]])",
            }
            .into());
        }
        let reference = Reference::of(system, control.reference);
        self.equilibrium.check_loads(system, t, &reference.load)?;
        let rest = vec![0.0; self.entries];
        let unloaded = control.quantity.value(system, t, &rest)?;
        let values = [state.t, t].map(|t| control.value_at(t, unloaded));
        let mut step = ControlledStep {
            t,
            reference: &reference,
            control,
            values,
        };
        let before = state.u.clone();
        let work = self.move_on(system, (&step, &mut state.u), interrupt)?;
        let booked = system.ledger().work;
        let end = chord(t, t - state.t, &state.u, &before, first);
        system.book_equilibrium(&end, &mut state.a);
        let of_means = system.ledger().work - booked;
        system.book_exchange(Exchange {
            work: work - of_means,
            impulse: [0.0; 3],
        });
        step.values[0] = step.values[1];
        let rule = self.options.breaking;
        while let Some(beyond) = rule.apply(system, t, &state.u, &mut state.a) {
            self.released += beyond;
            let before = state.u.clone();
            let (elastic, work) = (system.stored_energy(t, &before), system.ledger().work);
            self.move_on(system, (&step, &mut state.u), interrupt)?;
            system.book_equilibrium(&chord(t, 0.0, &state.u, &before, false), &mut state.a);
            self.released +=
                elastic - system.stored_energy(t, &state.u) + system.ledger().work - work;
        }
        Ok(())
    }

    /// Advances `u` and the factor of the loads along a step with fixed bonds and returns the work done.
    fn move_on(
        &mut self,
        system: &mut System,
        (step, u): (&ControlledStep<'_>, &mut Vec<f64>),
        interrupt: Interrupt<'_>,
    ) -> Result<f64> {
        let load_step = LoadStep {
            t: step.t,
            start: step.t,
            loading: Loading::Controlled {
                reference: step.reference,
                control: step.control,
                values: step.values,
            },
            largest: self.largest,
        };
        let mut factor = self.factor;
        let work = self.follow(system, load_step, (u, &mut factor, true), interrupt)?;
        system.load_proportionally(ProportionalLoading {
            reference: step.reference.t,
            factors: [self.factor, factor],
        });
        self.factor = factor;
        Ok(work)
    }
}

/// A step of the controlled quantity.
struct ControlledStep<'a> {
    t: f64,
    reference: &'a Reference,
    control: &'a Control,
    /// Values of the quantity before and after, m.
    values: [f64; 2],
}
