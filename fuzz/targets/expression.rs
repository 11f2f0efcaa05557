#![no_main]
//! Expressions and conditions, read, evaluated and differentiated: the first byte says where one stands, as a set, as an initial field or as a support that moves.

use pericles_deck::Deck;
use pericles_run::{Resources, build};

pericles_fuzz::target!(|content: &[u8]| {
    let Some((first, text)) = content.split_first() else {
        return;
    };
    let quoted = pericles_fuzz::quoted(&String::from_utf8_lossy(text));
    let use_of_it = match first % 3 {
        0 => format!("sets.some = {{ where = {quoted} }}"),
        1 => format!("initial = [{{ displacement = [{{ expression = {quoted} }}] }}]"),
        _ => format!("constraint = [{{ set = \"all\", displacement = [{{ expression = {quoted} }}] }}]"),
    };
    let deck = format!(
        r#"body = {{ shape = "bar", length = 8, spacing = 1 }}
material = {{ model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 2 }}
{use_of_it}
time = {{ end = 1, dt = 0.1 }}
"#
    );
    if let Ok(deck) = Deck::parse(&deck, "a.toml", &[]) {
        let _ = build(&deck, &Resources::default());
    }
});
