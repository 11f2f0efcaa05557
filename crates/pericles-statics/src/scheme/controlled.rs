//! Steps in which a quantity of the displacements is prescribed.

use pericles::boundary::{Exchange, ProportionalLoading};
use pericles::time::State;
use pericles::{Interrupt, Result, System};

use super::jump::Change;
use super::{StaticScheme, chord};
use crate::control::Control;
use crate::equilibrium::ControlledTarget;
use crate::error::{StaticsError, is_not_controlled};
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
        self.relaxing = false;
        let mut change = Change::of(system, t, &state.u);
        let before = state.u.clone();
        let work = self.move_on(system, (&step, state), interrupt)?;
        let booked = system.ledger().work;
        let end = chord(t, t - state.t, &state.u, &before, first);
        system.book_equilibrium(&end, &mut state.a);
        let of_means = system.ledger().work - booked;
        let mut is_jump = work.is_none();
        match work {
            Some(work) => system.book_exchange(Exchange {
                work: work - of_means,
                impulse: [0.0; 3],
            }),
            None => self.released += change.lost(system, &state.u) + of_means,
        }
        step.values[0] = step.values[1];
        let rule = self.options.breaking;
        while self.break_bonds(system, state, (t, is_jump), rule) {
            is_jump = true;
            change = Change::of(system, t, &state.u);
            let (before, work) = (state.u.clone(), system.ledger().work);
            self.move_on(system, (&step, state), interrupt)?;
            system.book_equilibrium(&chord(t, 0.0, &state.u, &before, false), &mut state.a);
            self.released += change.lost(system, &state.u) + system.ledger().work - work;
        }
        Ok(())
    }

    /// Advances the state and the factor of the loads along a step with fixed bonds and returns the work done; `None` if
    /// there is no static path and the body fails until it is in equilibrium at the end of the step.
    fn move_on(
        &mut self,
        system: &mut System,
        (step, state): (&ControlledStep<'_>, &mut State),
        interrupt: Interrupt<'_>,
    ) -> Result<Option<f64>> {
        let load_step = LoadStep {
            t: step.t,
            start: step.t,
            loading: Loading::Controlled {
                reference: step.reference,
                control: step.control,
                values: step.values,
            },
            largest: self.largest,
            tolerance: self.options.tolerance,
        };
        let before = (state.u.clone(), self.factor);
        let mut factor = self.factor;
        let followed = self.follow(
            system,
            load_step,
            (&mut state.u, &mut factor, true),
            interrupt,
        );
        let work = match followed {
            Ok(work) => Some(work),
            Err(error) if is_not_controlled(&error) => {
                (state.u, factor) = before;
                self.relaxing = true;
                let target = ControlledTarget {
                    t: step.t,
                    reference: step.reference,
                    control: step.control,
                    value: step.values[1],
                    largest: self.largest,
                };
                let at = (&mut state.u[..], &mut factor);
                let solver = &mut self.equilibrium;
                let effort =
                    solver.fail_to_controlled(system, &target, at, &mut state.a, interrupt)?;
                self.effort.add(effort);
                self.largest = self.largest.max(effort.acting);
                None
            }
            Err(error) => return Err(error),
        };
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
