//! Load steps: progress, interruption, independence of the number of threads.

use std::cell::{Cell, RefCell};

use pericles::prelude::*;
use pericles::{Control, Interrupt, IterationProgress, Outcome};
use pericles_statics::{StaticOptions, StaticScheme};

use crate::equilibrium::{stretched_plate, torn_bar};

fn plate() -> Simulation {
    let system = stretched_plate(20);
    let scheme = StaticScheme::new(StaticOptions::default(), &system).unwrap();
    let state = State::of(&system);
    Simulation::new(system, Box::new(scheme), state, 1.0, 1).unwrap()
}

#[test]
fn progress_reports_every_iteration_until_the_residual_is_below_the_tolerance() {
    let seen: RefCell<Vec<IterationProgress>> = RefCell::default();
    let follow = |progress| seen.borrow_mut().push(progress);
    let interrupt = Interrupt::never().following(&follow);
    let mut followed = plate();
    followed
        .run_interruptible(interrupt, |_| Control::Continue)
        .unwrap();
    let seen = seen.into_inner();
    assert!(seen.len() > 2, "{seen:?}");
    let last = seen.last().unwrap();
    assert!(last.residual <= last.tolerance, "{last:?}");
    assert!(seen.iter().any(|one| one.residual > one.tolerance));
    let mut alone = plate();
    alone.run_to_end().unwrap();
    assert_eq!(followed.state().u, alone.state().u);
}

#[test]
fn run_interrupted_within_a_load_step_continues_bitwise_identically() {
    let polls = Cell::new(0u32);
    let count = || {
        polls.set(polls.get() + 1);
        false
    };
    let mut whole = torn_bar();
    whole
        .run_interruptible(Interrupt::when(&count), |_| Control::Continue)
        .unwrap();
    let all = polls.get();
    assert!(all > 20, "{all}");
    for tenths in [1, 4, 7, 9] {
        let left = Cell::new(all * tenths / 10);
        let is_over = || {
            left.set(left.get().saturating_sub(1));
            left.get() == 0
        };
        let mut run = torn_bar();
        let outcome = run
            .run_interruptible(Interrupt::when(&is_over), |_| Control::Continue)
            .unwrap();
        assert_eq!(outcome, Outcome::Stopped, "{tenths}");
        assert!(run.state().step < 4, "{tenths}");
        run.run_to_end().unwrap();
        assert_eq!(run.state().u, whole.state().u, "{tenths}");
        let energies = |run: &Simulation| run.snapshot().energies().balance();
        assert_eq!(energies(&run), energies(&whole), "{tenths}");
    }
}

#[test]
fn static_states_do_not_depend_on_the_number_of_threads() {
    let found: Vec<Vec<f64>> = [1, 2, 3]
        .into_iter()
        .map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            pool.build().unwrap().install(|| {
                let mut run = plate();
                run.run_to_end().unwrap();
                run.state().u.clone()
            })
        })
        .collect();
    assert!(found[0].iter().any(|u| *u != 0.0));
    assert_eq!(found[0], found[1]);
    assert_eq!(found[0], found[2]);
}
