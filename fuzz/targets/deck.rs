#![no_main]
//! Decks: the text, and after a line `%%` one override a line.

pericles_fuzz::target!(|content: &str| {
    let mut parts = content.splitn(2, "\n%%\n");
    let text = parts.next().unwrap_or_default();
    let overrides: Vec<String> = parts
        .next()
        .map(|rest| rest.lines().map(str::to_owned).collect())
        .unwrap_or_default();
    if let Err(error) = pericles_deck::Deck::parse(text, "a.toml", &overrides) {
        // Messages are made of the text's parts, wherever they are cut.
        assert!(!error.to_string().is_empty());
    }
});
