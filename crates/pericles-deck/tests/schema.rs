//! Tests of the JSON Schema with an independent validator.

use std::fs;
use std::path::{Path, PathBuf};

use boon::{Compiler, SchemaIndex, Schemas};
use serde_json::Value as Json;

struct Validator {
    schemas: Schemas,
    deck: SchemaIndex,
}

impl Validator {
    fn new() -> Self {
        let (mut schemas, mut compiler) = (Schemas::new(), Compiler::new());
        let place = "http://localhost/deck.json";
        let schema = pericles_deck::json_schema();
        compiler.add_resource(place, schema).unwrap();
        let deck = compiler.compile(place, &mut schemas).unwrap();
        Self { schemas, deck }
    }

    /// Returns the errors of a deck; empty if it is valid.
    fn says(&self, text: &str) -> String {
        let table: toml::Table = toml::from_str(text).unwrap();
        let deck = json(&toml::Value::Table(table));
        let checked = self.schemas.validate(&deck, self.deck);
        checked.map_or_else(|error| error.to_string(), |()| String::new())
    }
}

/// Converts TOML to JSON, as editors do.
fn json(value: &toml::Value) -> Json {
    match value {
        toml::Value::String(text) => Json::from(text.as_str()),
        toml::Value::Integer(number) => Json::from(*number),
        toml::Value::Float(number) => Json::from(*number),
        toml::Value::Boolean(boolean) => Json::from(*boolean),
        toml::Value::Datetime(date) => Json::from(date.to_string()),
        toml::Value::Array(items) => items.iter().map(json).collect(),
        toml::Value::Table(table) => {
            let members = table.iter().map(|(key, value)| (key.clone(), json(value)));
            Json::Object(members.collect())
        }
    }
}

/// Collects the decks in a folder and its subfolders.
fn decks(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            decks(&path, found);
        } else if name.ends_with(".toml") && name != "expected.toml" {
            found.push(path);
        }
    }
}

fn below(place: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    decks(&root.join(place), &mut found);
    found.sort();
    found
}

#[test]
fn every_valid_deck_satisfies_the_schema() {
    let validator = Validator::new();
    let mut decks = below("examples");
    decks.extend(below("book/decks"));
    assert!(decks.len() > 25, "{}", decks.len());
    decks.push(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/complete.toml"));
    for deck in decks {
        let said = validator.says(&fs::read_to_string(&deck).unwrap());
        assert!(said.is_empty(), "{}: {said}", deck.display());
    }
}

#[test]
fn the_schema_detects_typos_and_wrong_types_only() {
    /// Errors that a schema can detect: keys, types, words, signs. It does not contain the dimension of the
    /// body, so that it accepts a single value for several axes.
    const SEEN: [&str; 8] = [
        "decimal-comma",
        "lost-heading",
        "missing-section",
        "negative-density",
        "several",
        "unknown-key",
        "wrong-word",
        "misplaced-key",
    ];
    let validator = Validator::new();
    for deck in below("crates/pericles-cli/tests/wrong") {
        let name = deck.file_stem().unwrap().to_str().unwrap().to_owned();
        // Invalid TOML.
        if name == "syntax" {
            continue;
        }
        let said = validator.says(&fs::read_to_string(&deck).unwrap());
        assert_eq!(!said.is_empty(), SEEN.contains(&&*name), "{name}: {said}");
    }
}
