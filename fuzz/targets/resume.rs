#![no_main]
//! Checkpoints that are whole, but not of this run: the first byte names a deck, the rest spoils the arrays of its state. What is taken back must go on, or
//! fail as runs may.

use std::sync::OnceLock;

use pericles::{Archive, Control, Saved, Simulation};
use pericles_deck::Deck;
use pericles_fuzz::{Choices, decks};

/// Steps before the state is stored, and after it is taken back.
const BEFORE: u32 = 5;
const AFTER: u32 = 3;

fn simulation(deck: &Deck) -> Simulation {
    deck.build().unwrap_or_else(|error| panic!("{error}")).simulation()
}

fn advance(simulation: &mut Simulation, steps: u32) {
    let mut left = steps;
    let _ = simulation.run(|_| {
        left -= 1;
        if left == 0 { Control::Stop } else { Control::Continue }
    });
}

fn stored() -> &'static [(Deck, Archive)] {
    static STORED: OnceLock<Vec<(Deck, Archive)>> = OnceLock::new();
    STORED.get_or_init(|| {
        let begun = |text: &&str| {
            let deck = Deck::parse(text, "a.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
            let mut simulation = simulation(&deck);
            advance(&mut simulation, BEFORE);
            let mut archive = Archive::default();
            simulation.save(&mut archive);
            (deck, archive)
        };
        decks::ALL.iter().map(begun).collect()
    })
}

libfuzzer_sys::fuzz_target!(
    init: { pericles_fuzz::one_thread(); },
    |content: &[u8]| {
        let mut choices = Choices(content);
        let stored = stored();
        let (deck, archive) = &stored[usize::from(choices.byte()) % stored.len()];
        let spoilt = choices.spoil(archive.clone());
        let mut simulation = simulation(deck);
        if simulation.restore(&spoilt).is_ok() {
            advance(&mut simulation, AFTER);
        }
    }
);
