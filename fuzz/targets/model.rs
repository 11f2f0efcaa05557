#![no_main]
//! Decks that are right as texts, built and begun: any deck runs or is rejected, within the memory it is allowed.

use std::sync::LazyLock;

use pericles_deck::Deck;
use pericles_run::{FileError, Resources, build};
use pericles_fuzz::{Memory, advance};

/// Bytes that a body may take: some hundred points, so that most inputs take less than a millisecond.
const MEMORY: u64 = 1 << 17;
const STEPS: u32 = 3;

static KEPT: LazyLock<Memory> = LazyLock::new(Memory::default);

/// Surfaces are made for the distances of their vertices: surfaces with more than some thousand vertices are left to a test. Counts written in other ways only take longer.
fn is_large(content: &str) -> bool {
    const MOST: [(&str, u32); 5] = [("level", 4), ("around", 99), ("across", 99), ("segments", 99), ("rings", 99)];
    MOST.iter().any(|(key, most)| {
        content.split(key).skip(1).any(|rest| {
            let rest = rest.trim_start_matches([' ', '\t', '"', '=', '+']);
            let digits = rest.split(|c: char| !c.is_ascii_digit() && c != '_').next().unwrap_or_default();
            !digits.is_empty() && digits.replace('_', "").parse().is_ok_and(|count: u64| count > u64::from(*most))
        })
    })
}

pericles_fuzz::target!(|content: &str| {
    if is_large(content) {
        return;
    }
    let Ok(deck) = Deck::parse(content, "a.toml", &[]) else {
        return;
    };
    let read_points =
        |_: &std::path::Path, _: usize, _: u64| Err(FileError::Wrong("no file".to_owned()));
    let resources = Resources {
        memory: MEMORY,
        cache: &*KEPT,
        read_points: &read_points,
        ..Resources::default()
    };
    if let Ok(model) = build(&deck, &resources) {
        let simulation = model.simulation();
        let mut simulation = simulation.unwrap_or_else(|error| panic!("{error}"));
        advance(&mut simulation, STEPS);
    }
});
