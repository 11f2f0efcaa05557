//! Tests of the book and the Markdown pages: their decks are built, their command lines are parsed.
//!
//! A TOML block is marked as `deck` (a complete deck) or with the name of a deck in `book/decks/`, whose keys it
//! replaces.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Parser;
use pericles::observe::{Field, FieldKind};
use pericles_deck::Deck;
use pericles_run::{build, readers};

use crate::args::{Cli, Command};

/// A fenced block of a page.
struct Block {
    /// Page and line, for messages.
    place: String,
    /// `toml`, `sh`, …
    language: String,
    /// The mark after the language.
    mark: String,
    text: String,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn pages() -> Vec<PathBuf> {
    let mut pages = vec![root().join("README.md")];
    let mut folders = vec![root().join("book/src"), root().join("examples")];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "md") {
                pages.push(path);
            }
        }
    }
    assert!(pages.len() > 20, "{pages:?}");
    pages
}

fn blocks(page: &Path) -> Vec<Block> {
    let text = fs::read_to_string(page).unwrap();
    let mut found: Vec<Block> = Vec::new();
    let mut inside = false;
    for (line, number) in text.lines().zip(1..) {
        if let Some(info) = line.strip_prefix("```") {
            inside = !inside;
            if inside {
                let (language, mark) = info.split_once(',').unwrap_or((info, ""));
                found.push(Block {
                    place: format!("{}:{number}", page.display()),
                    language: language.into(),
                    mark: mark.into(),
                    text: String::new(),
                });
            }
        } else if let Some(block) = found.last_mut().filter(|_| inside) {
            let included = line
                .strip_prefix("{{#include ")
                .and_then(|rest| rest.strip_suffix("}}"));
            match included {
                Some(path) => {
                    let path = page.parent().unwrap().join(path);
                    block.text += &fs::read_to_string(path).unwrap();
                }
                None => block.text += line,
            }
            block.text.push('\n');
        }
    }
    assert!(!inside, "{}: unterminated block", page.display());
    found
}

/// Replaces keys of a deck by those of a fragment.
fn put(part: toml::Table, whole: &mut toml::Table) {
    for (key, value) in part {
        match (value, whole.get_mut(&key)) {
            (toml::Value::Table(part), Some(toml::Value::Table(whole)))
                if !part.contains_key("shape") =>
            {
                put(part, whole);
            }
            (value, _) => {
                whole.insert(key, value);
            }
        }
    }
}

/// Returns the complete deck of a block.
fn deck(block: &Block) -> String {
    if block.mark == "deck" {
        return block.text.clone();
    }
    let base = root()
        .join("book/decks")
        .join(format!("{}.toml", block.mark));
    let base = fs::read_to_string(base).unwrap_or_else(|_| {
        panic!(
            "{}: mark it as `deck`, or with the name of a deck in book/decks",
            block.place
        )
    });
    let mut whole: toml::Table = base.parse().unwrap();
    let part = block.text.parse();
    let part = part.unwrap_or_else(|error| panic!("{}: {error}", block.place));
    put(part, &mut whole);
    toml::to_string(&whole).unwrap()
}

#[test]
fn decks_of_the_book_are_valid() {
    let mut count = 0;
    for page in pages()
        .iter()
        .filter(|page| page.starts_with(root().join("book")))
    {
        for block in blocks(page).iter().filter(|block| block.language == "toml") {
            let (place, text) = (&block.place, deck(block));
            // Files are read from the folder of the examples.
            let name = root().join("examples/geometry/page.toml");
            let deck = Deck::parse(&text, &name.display().to_string(), &[]);
            let deck = deck.unwrap_or_else(|error| panic!("{place}: {error}\n{text}"));
            let built = build(&deck, &readers());
            built.unwrap_or_else(|error| panic!("{place}: {error}\n{text}"));
            count += 1;
        }
    }
    assert!(count > 20, "{count}");
}

/// Returns the example of the same name as the deck of a command line.
fn example(deck: &Path) -> Option<PathBuf> {
    let name = deck.file_name()?;
    let topics = fs::read_dir(root().join("examples")).unwrap();
    topics
        .map(|topic| topic.unwrap().path().join(name))
        .find(|path| path.is_file())
}

#[test]
fn command_lines_of_the_pages_are_valid() {
    let mut count = 0;
    for page in pages() {
        for block in blocks(&page).iter().filter(|block| block.language == "sh") {
            for line in block.text.lines() {
                let line = line.replacen("cargo run --release -- ", "pericles ", 1);
                if !line.starts_with("pericles ") {
                    continue;
                }
                let place = &block.place;
                let words = shlex::split(&line);
                let words = words.unwrap_or_else(|| panic!("{place}: {line}"));
                let words = words
                    .into_iter()
                    .take_while(|word| word != "|" && word != ">");
                let cli = Cli::try_parse_from(words);
                let cli = cli.unwrap_or_else(|error| panic!("{place}: {line}\n{error}"));
                let (deck, overrides) = match cli.command {
                    Command::Run(run) => (run.deck, run.overrides),
                    Command::Check(check) => (check.deck, check.overrides),
                    Command::Modes(modes) => (modes.deck, modes.overrides),
                    Command::Dispersion(dispersion) => (dispersion.deck, dispersion.overrides),
                    _ => continue,
                };
                if let Some(deck) = example(&deck) {
                    let deck = Deck::read(deck, &overrides.set);
                    deck.unwrap_or_else(|error| panic!("{place}: {line}\n{error}"));
                    count += 1;
                }
            }
        }
    }
    assert!(count > 10, "{count}");
}

#[test]
fn the_deck_reference_is_up_to_date() {
    let page = fs::read_to_string(root().join("book/src/deck.md")).unwrap();
    assert!(
        page.trim_end() == pericles_deck::reference().trim_end(),
        "regenerate it: pericles schema --markdown > book/src/deck.md"
    );
}

/// Returns the example that the comments at the start of a deck name: `pericles run examples/…`.
fn named_example(deck: &str) -> Option<PathBuf> {
    deck.lines()
        .take_while(|line| line.starts_with('#'))
        .filter_map(|line| line.strip_prefix("#   pericles run"))
        .find_map(|arguments| arguments.trim_start().strip_prefix("examples/"))
        .and_then(|arguments| arguments.split_whitespace().next())
        .map(|name| root().join("examples").join(name))
}

/// Examples on a page equal their files.
#[test]
fn examples_in_the_book_are_up_to_date() {
    let mut count = 0;
    for page in pages()
        .iter()
        .filter(|page| page.starts_with(root().join("book")))
    {
        for block in blocks(page).iter().filter(|block| block.mark == "deck") {
            let Some(path) = named_example(&block.text) else {
                continue;
            };
            let text = fs::read_to_string(&path).unwrap();
            assert!(
                block.text.trim_end() == text.trim_end(),
                "{} differs from {}: run book/tutorials.py --decks",
                block.place,
                path.display()
            );
            count += 1;
        }
    }
    assert!(count >= 6, "{count}");
}

/// The table of fields is that of the engine, with `1` for dimensionless numbers and `–` for integers.
#[test]
fn the_page_of_outputs_has_all_fields_with_their_units() {
    let page = fs::read_to_string(root().join("book/src/outputs.md")).unwrap();
    let rows: Vec<[&str; 2]> = (page.lines())
        .filter_map(|line| {
            let mut cells = line.strip_prefix("| `")?.split(" | ");
            Some([cells.next()?.strip_suffix('`')?, cells.next()?])
        })
        .collect();
    for field in Field::ALL {
        let unit = match (field.kind(), field.unit()) {
            (FieldKind::Integer, _) => "–",
            (_, "") => "1",
            (_, unit) => unit,
        };
        let row = [field.name(), unit];
        assert!(rows.contains(&row), "the page lacks the row {row:?}");
    }
}
