#![no_main]
//! Cached kernels and distances that are whole, but not what they should be: the first byte names a deck, the rest spoils what the cache gives it.

use std::collections::HashMap;
use std::sync::{Mutex, OnceLock};

use pericles::Archive;
use pericles::cache::{Cache, Key};
use pericles_deck::Deck;
use pericles_run::{Resources, build};
use pericles_fuzz::{Choices, decks};

/// Keeps what it is given, and gives it back spoilt.
struct Spoiling<'a> {
    kept: &'a Mutex<HashMap<String, Archive>>,
    input: &'a [u8],
}

impl Cache for Spoiling<'_> {
    fn load(&self, key: &Key) -> Option<Archive> {
        let archive = self.kept.lock().ok()?.get(&key.digest())?.clone();
        Some(Choices(self.input).spoil(archive))
    }

    fn store(&self, key: &Key, arrays: &Archive) {
        if let Ok(mut kept) = self.kept.lock() {
            // What replaces a spoilt entry is computed anew, and the same.
            kept.insert(key.digest(), arrays.clone());
        }
    }
}

fn decks_with_caches() -> &'static [Deck] {
    static DECKS: OnceLock<Vec<Deck>> = OnceLock::new();
    DECKS.get_or_init(|| {
        let texts = decks::ALL;
        let cached = texts.iter().filter(|text| ["direct\"", "blocked", "icosphere"].iter().any(|word| text.contains(word)));
        let read = |text: &&str| Deck::parse(text, "a.toml", &[]);
        cached.map(|text| read(text).unwrap_or_else(|error| panic!("{error}"))).collect()
    })
}

pericles_fuzz::target!(|content: &[u8]| {
    static KEPT: OnceLock<Mutex<HashMap<String, Archive>>> = OnceLock::new();
    let kept = KEPT.get_or_init(Mutex::default);
    let Some((first, input)) = content.split_first() else {
        return;
    };
    let decks = decks_with_caches();
    let deck = &decks[usize::from(*first) % decks.len()];
    let cache = Spoiling { kept, input };
    let resources = Resources { cache: &cache, ..Resources::default() };
    let _ = build(deck, &resources);
});
