//! Schemes that take several steps at once, as devices do: observers see the same states.

use std::sync::{Arc, Mutex};

use crate::implicit::{Action, from_rest, loaded};
use pericles::observe::{ObserveError, Observer, Schedule, Snapshot};
use pericles::time::{Integrator, State, VelocityVerlet};
use pericles::{Archive, Checkpointed, Interrupt, Result, StepKind, System};

/// Velocity Verlet that takes several steps at once, as devices do.
struct Batches(u64);

impl Integrator for Batches {
    fn name(&self) -> &'static str {
        "batches"
    }

    fn step_kind(&self) -> StepKind {
        VelocityVerlet.step_kind()
    }

    fn order(&self) -> u32 {
        VelocityVerlet.order()
    }

    fn stability_limit(&self) -> Option<f64> {
        VelocityVerlet.stability_limit()
    }

    fn steps_at_once(&self) -> u64 {
        self.0
    }

    fn advance(
        &mut self,
        system: &mut System,
        state: &mut State,
        (dt, steps): (f64, u64),
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        assert!((1..=self.0).contains(&steps));
        for _ in 0..steps {
            self.step(system, state, (state.step + 1) as f64 * dt, interrupt)?;
        }
        Ok(())
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        VelocityVerlet.step(system, state, t_next, interrupt)
    }
}

impl Checkpointed for Batches {
    fn save(&self, _archive: &mut Archive) {}

    fn restore(&mut self, _archive: &Archive) -> Result<()> {
        Ok(())
    }
}

/// Steps with their displacements.
type States = Vec<(u64, Vec<f64>)>;

/// The states that an observer has seen.
#[derive(Clone, Default)]
struct Seen(Arc<Mutex<States>>);

impl Observer for Seen {
    fn observe(&mut self, snapshot: &Snapshot<'_>) -> std::result::Result<(), ObserveError> {
        let state = snapshot.state();
        self.0.lock().unwrap().push((state.step, state.u.clone()));
        Ok(())
    }
}

impl Checkpointed for Seen {
    fn save(&self, _archive: &mut Archive) {}

    fn restore(&mut self, _archive: &Archive) -> Result<()> {
        Ok(())
    }
}

/// Runs 23 steps with observers of every fourth step and of five times, and returns what they have seen and the number of calls
/// of the controlling closure.
fn seen(at_once: u64) -> ([States; 2], usize) {
    let scheme = move |_: &System| -> Box<dyn Integrator> { Box::new(Batches(at_once)) };
    let mut run = from_rest(loaded(Action::Ramp), &scheme, 4e-8, 23);
    let observers = [Seen::default(), Seen::default()];
    for (observer, schedule) in observers
        .iter()
        .zip([Schedule::Every(4), Schedule::Count(5)])
    {
        run.observe(schedule, Box::new(observer.clone()));
    }
    let mut calls = 0;
    run.run(|_| {
        calls += 1;
        pericles::Control::Continue
    })
    .unwrap();
    let states = observers.map(|observer| observer.0.lock().unwrap().clone());
    (states, calls)
}

#[test]
fn observers_see_the_same_states_of_schemes_that_take_several_steps_at_once() {
    let (single, steps) = seen(1);
    assert_eq!(steps, 22);
    for at_once in [2, 3, 100] {
        let (states, visits) = seen(at_once);
        assert!(visits < steps, "{visits} visits");
        assert_eq!(single, states, "{at_once} steps at once");
    }
}
