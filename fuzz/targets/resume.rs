#![no_main]
//! Checkpoints that are whole, but not of this run: the first byte names a deck, the rest spoils the arrays of its state. What is taken back must go on, or
//! fail as runs may; and whatever was taken, the true state can be taken back after it, to the last bit.

use std::cell::RefCell;

use pericles::{Archive, Checkpointed, Simulation};
use pericles_deck::Deck;
use pericles_run::{Resources, build};
use pericles_fuzz::{Choices, advance, decks};

/// Steps before the state is stored, and after it is taken back.
const BEFORE: u32 = 5;
const AFTER: u32 = 3;

/// A run, and its state after some steps.
struct Run {
    simulation: Simulation,
    stored: Archive,
}

thread_local! {
    static RUNS: RefCell<Vec<Run>> = RefCell::new(decks::ALL.iter().map(|text| begun(text)).collect());
}

fn begun(text: &str) -> Run {
    let deck = Deck::parse(text, "a.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let model = build(&deck, &Resources::default()).unwrap_or_else(|error| panic!("{error}"));
    let simulation = model.simulation();
    let mut simulation = simulation.unwrap_or_else(|error| panic!("{error}"));
    advance(&mut simulation, BEFORE);
    let stored = state(&simulation);
    Run { simulation, stored }
}

fn state(simulation: &Simulation) -> Archive {
    let mut archive = Archive::default();
    simulation.save(&mut archive);
    archive
}

pericles_fuzz::target!(|content: &[u8]| {
    let mut choices = Choices(content);
    let number = usize::from(choices.byte()) % decks::ALL.len();
    RUNS.with_borrow_mut(|runs| {
        let Run { simulation, stored } = &mut runs[number];
        let spoilt = choices.spoil(stored.clone());
        if simulation.restore(&spoilt).is_ok() {
            advance(simulation, AFTER);
        }
        if let Err(error) = simulation.restore(stored) {
            panic!("the true state is rejected: {error}");
        }
        assert!(state(simulation) == *stored, "the true state is not what was stored");
    });
});
