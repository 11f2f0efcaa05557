#![no_main]
//! Decks that are right as texts, built and begun: any deck runs or is refused, within the memory it is allowed.

use pericles::Control;
use pericles_deck::{Deck, Resources};

/// Bytes that a body may take, so that most inputs take no longer than some milliseconds.
const MEMORY: u64 = 1 << 20;
const STEPS: u32 = 3;

libfuzzer_sys::fuzz_target!(
    init: { pericles_fuzz::one_thread(); },
    |content: &str| {
        let Ok(deck) = Deck::parse(content, "a.toml", &[]) else {
            return;
        };
        let read_points = |_: &std::path::Path, _: usize| Err("no file".to_owned());
        let resources = Resources {
            memory: MEMORY,
            read_points: &read_points,
            ..Resources::default()
        };
        let Ok(model) = deck.build_with(resources) else {
            return;
        };
        let mut left = STEPS;
        let _ = model.simulation().run(|_| {
            left -= 1;
            if left == 0 { Control::Stop } else { Control::Continue }
        });
    }
);
