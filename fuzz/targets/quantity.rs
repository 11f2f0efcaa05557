#![no_main]
//! Numbers with units, of every dimension in decks.

use pericles_deck::Deck;

const DECK: &str = r#"body = { shape = "bar", length = 8, spacing = 1, area = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon = 2 }
time = { end = 1, dt = 0.1 }
"#;

const KEYS: [&str; 6] = [
    "body.length",
    "body.area",
    "material.density",
    "material.youngs_modulus",
    "material.horizon",
    "time.end",
];

pericles_fuzz::target!(|text: &str| {
    let quoted = pericles_fuzz::quoted(text);
    let overrides = KEYS.map(|key| format!("{key}={quoted}"));
    let _ = Deck::parse(DECK, "a.toml", &overrides);
    let _ = pericles_deck::seconds(text);
});
