#![no_main]
//! Expressions and conditions, read, evaluated and differentiated: an initial field, a support that moves, and a set.

use pericles_deck::Deck;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let quoted = pericles_fuzz::quoted(text);
    let deck = format!(
        r#"body = {{ shape = "bar", length = 8, spacing = 1 }}
material = {{ model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 2 }}
sets.some = {{ where = {quoted} }}
initial = [{{ displacement = [{{ expression = {quoted} }}] }}]
prescribe = [{{ set = "all", displacement = [{{ expression = {quoted} }}] }}]
time = {{ end = 1, dt = 0.1 }}
"#
    );
    // Whatever of it is right is read in three decks that are right but for one place at most.
    for left_out in ["sets.some", "initial", "prescribe"] {
        let lines = deck.lines().filter(|line| !line.starts_with(left_out));
        let text: String = lines.flat_map(|line| [line, "\n"]).collect();
        if let Ok(deck) = Deck::parse(&text, "a.toml", &[]) {
            let _ = deck.build();
        }
    }
});
