//! The schema of decks: keys, forms of their values and descriptions.
//!
//! Keys, forms, words, ranges and defaults are those that the reader requests while it reads the
//! [`specimens`], so that schema and reader cannot disagree. Descriptions come from the documentation of the fields of
//! declared tables ([`declaration`](crate::declaration)). Tests require a form and a description for every key of the
//! reader. The schema does not contain which keys need which shape, model or scheme: it allows more
//! than the reader, never less.

mod descriptions;
mod json;
mod markdown;
mod specimens;
mod unit;

use std::borrow::Cow;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

use serde_json::Value as Json;

use self::descriptions::Descriptions;
pub use self::unit::unit_of_key;
use crate::deck::Deck;
use crate::reader::{Form, Survey, below};
use crate::vocabulary::synonyms;

/// Returns the JSON Schema of decks, draft 2020-12, with which editors complete keys and words and mark errors.
pub fn json_schema() -> Json {
    json::document(&Schema::new())
}

/// Returns the reference of all keys in Markdown, with a section per table.
pub fn reference() -> String {
    markdown::document(&Schema::new())
}

/// Returns valid decks that together contain every key in every form, each as a text with overrides. Tests of code that
/// reads decks use them.
pub fn specimens() -> impl Iterator<Item = (&'static str, Vec<String>)> {
    specimens::SPECIMENS.iter().map(|specimen| {
        let changes = specimen.changes.iter().map(|&text| text.into());
        (specimen.deck, changes.collect())
    })
}

/// Returns the table to which a key belongs, as written in a deck: `[body]`, `[[output.picture]]`. None for
/// unknown keys, if several tables at the same depth have it, or if `is_table` and it takes no table.
pub(crate) fn home_of(key: &str, is_table: bool) -> Option<&'static str> {
    static HOMES: OnceLock<(Homes, BTreeSet<&'static str>)> = OnceLock::new();
    let (homes, of_tables) = HOMES.get_or_init(|| {
        let schema = Schema::new();
        (homes(&schema), of_tables(&schema))
    });
    if is_table && !of_tables.contains(key) {
        return None;
    }
    homes.get(key)?.as_deref()
}

/// The table of each key; `None` for keys of several tables.
type Homes = BTreeMap<&'static str, Option<String>>;

/// Returns the names of the keys whose values may be tables or lists of tables.
fn of_tables(schema: &Schema) -> BTreeSet<&'static str> {
    let takes_tables = |place: String| {
        [format!("{place}[]"), place].iter().any(|place| {
            let forms = schema.forms(place).into_iter();
            let mut forms =
                forms.map(|form| matches!(form, Form::Table | Form::Names(_) | Form::Defined(_)));
            forms.any(|is_table| is_table)
        })
    };
    let tables = schema.survey.tables();
    let keys = tables.flat_map(|(place, table)| table.keys().map(move |key| (place, key)));
    keys.filter(|(place, key)| takes_tables(below(place, key)))
        .flat_map(|(_, key)| names(key))
        .collect()
}

fn homes(schema: &Schema) -> Homes {
    let definitions = schema.survey.definitions();
    let mut found: BTreeMap<&'static str, ((usize, bool), Option<String>)> = BTreeMap::new();
    for (place, table) in schema.survey.tables() {
        let first = place.split(['.', '[']).next().unwrap_or_default();
        // Shared definitions do not belong to a single table.
        if place.is_empty() || definitions.contains(&first) && !schema.is_shared(first) {
            continue;
        }
        // A table takes precedence over a list of tables.
        let depth = (place.split('.').count(), place.ends_with("[]"));
        let written = match place.strip_suffix("[]") {
            Some(list) => format!("[[{list}]]"),
            None => format!("[{place}]"),
        };
        for key in table.keys().flat_map(names) {
            match found.entry(key) {
                Entry::Vacant(entry) => {
                    entry.insert((depth, Some(written.clone())));
                }
                Entry::Occupied(mut entry) if entry.get().0 > depth => {
                    entry.insert((depth, Some(written.clone())));
                }
                Entry::Occupied(mut entry) if entry.get().0 == depth => {
                    entry.insert((depth, None));
                }
                Entry::Occupied(_) => {}
            }
        }
    }
    let homes = found.into_iter();
    homes.map(|(key, (_, home))| (key, home)).collect()
}

/// Survey and descriptions of decks.
struct Schema {
    survey: Survey,
    descriptions: Descriptions,
}

impl Schema {
    fn new() -> Self {
        let mut survey = Survey::default();
        for specimen in specimens::SPECIMENS {
            let changes: Vec<String> = specimen.changes.iter().map(|&text| text.into()).collect();
            survey = Deck::survey(specimen.deck, &changes, survey)
                .unwrap_or_else(|error| panic!("a specimen is rejected: {changes:?} {error}"));
        }
        let descriptions = Descriptions::new(survey.descriptions());
        Self {
            survey,
            descriptions,
        }
    }

    /// Returns whether a table of the deck is also a definition: `[material]` has the keys of every entry of
    /// `[materials]`.
    fn is_shared(&self, place: &str) -> bool {
        let root = self.survey.table("");
        let of_the_deck = root.is_some_and(|root| root.keys().any(|key| key == place));
        of_the_deck && self.survey.definitions().contains(&place)
    }

    /// Returns the forms of a value, except for those covered by its definition.
    fn forms(&self, place: &str) -> Vec<&Form> {
        let all = || self.survey.value(place).into_iter().flat_map(|v| &v.forms);
        let defined = all().any(|form| matches!(form, Form::Defined(_) | Form::Names(_)));
        all()
            .filter(|form| !(defined && matches!(form, Form::Table)))
            .collect()
    }

    /// Returns the description of a value: of the key, the table or the definition.
    fn description(&self, place: &str) -> Option<&str> {
        let own = self.descriptions.of_key(place);
        let defined = || {
            self.forms(place).into_iter().find_map(|form| match form {
                Form::Defined(name) => self.descriptions.of_table(name),
                _ => None,
            })
        };
        own.or_else(|| self.descriptions.of_table(place))
            .or_else(defined)
    }

    /// Returns the ranges of a value in words, except for those implied by its form.
    fn ranges(&self, place: &str) -> Vec<Cow<'_, str>> {
        let forms = self.forms(place).into_iter();
        let mut ranges: Vec<Cow<'_, str>> = forms
            .filter_map(|form| match form {
                Form::Number {
                    allowed: Some(allowed),
                    ..
                } if allowed != crate::range::POSITIVE_WORDS => Some(allowed.into()),
                Form::Count { range } if *range != crate::range::COUNT => Some(range.words()),
                _ => None,
            })
            .collect();
        ranges.dedup();
        ranges
    }
}

/// Returns the names of a key, the first name first.
fn names(key: &'static str) -> impl Iterator<Item = &'static str> {
    std::iter::once(key).chain(synonyms(key).iter().copied())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deck::Document;
    use crate::document::{Node, Value};
    use crate::reader::Ledger;

    /// Returns all keys with their places.
    fn keys(schema: &Schema) -> Vec<String> {
        let tables = schema.survey.tables();
        tables
            .flat_map(|(place, table)| table.keys().map(move |key| below(place, key)))
            .collect()
    }

    #[test]
    fn every_specimen_is_valid() {
        let rejections: Vec<String> = specimens::SPECIMENS
            .iter()
            .filter_map(|specimen| {
                let changes: Vec<String> =
                    specimen.changes.iter().map(|&text| text.into()).collect();
                let error = Deck::survey(specimen.deck, &changes, Survey::default()).err()?;
                Some(format!("{changes:?} {error}"))
            })
            .collect();
        assert!(rejections.is_empty(), "{rejections:#?}");
    }

    #[test]
    fn keys_of_a_single_table_have_a_home() {
        for (key, home) in [
            ("shape", Some("[body]")),
            ("E", Some("[material]")),
            ("youngs_modulus", Some("[material]")),
            ("density", Some("[material]")),
            ("segment", Some("[[crack]]")),
            // A key of [time] and of [thermal].
            ("scheme", None),
            ("end", Some("[time]")),
            ("animation", Some("[[output.picture]]")),
            ("set", None),
            ("radius", Some("[body]")),
            ("unheard_of", None),
        ] {
            assert_eq!(home_of(key, false), home, "{key}");
        }
        // `[[step]]` is not the time step of heat conduction; `[[hole]]` belongs to the body.
        assert_eq!(home_of("step", false), Some("[thermal]"));
        assert_eq!(home_of("step", true), None);
        assert_eq!(home_of("hole", true), Some("[body]"));
        assert_eq!(home_of("picture", true), Some("[output]"));
    }

    #[test]
    fn every_key_has_a_description_and_a_form() {
        let schema = Schema::new();
        let keys = keys(&schema);
        assert!(keys.len() > 200, "{}", keys.len());
        let (mut unexplained, mut formless) = (Vec::new(), Vec::new());
        for place in keys {
            if schema.description(&place).is_none() {
                unexplained.push(place.clone());
            }
            if schema.forms(&place).is_empty() {
                formless.push(place);
            }
        }
        assert!(
            unexplained.is_empty(),
            "keys without documentation: {unexplained:#?}"
        );
        assert!(formless.is_empty(), "no specimen has {formless:#?}");
    }

    /// Returns the number of keys of a document, in all tables.
    fn count(node: &Node) -> usize {
        match &node.value {
            Value::Table(entries) => entries.iter().map(|entry| 1 + count(&entry.node)).sum(),
            Value::Array(items) => items.iter().map(count).sum(),
            _ => 0,
        }
    }

    /// Removes a key by its place in the order of [`count`]; returns what is left to count.
    fn remove(node: &mut Node, mut number: usize) -> Result<(), usize> {
        match &mut node.value {
            Value::Table(entries) => {
                for k in 0..entries.len() {
                    if number == 0 {
                        entries.remove(k);
                        return Ok(());
                    }
                    match remove(&mut entries[k].node, number - 1) {
                        Ok(()) => return Ok(()),
                        Err(left) => number = left,
                    }
                }
            }
            Value::Array(items) => {
                for item in items {
                    match remove(item, number) {
                        Ok(()) => return Ok(()),
                        Err(left) => number = left,
                    }
                }
            }
            _ => {}
        }
        Err(number)
    }

    #[test]
    fn the_reference_has_every_default_that_the_reader_fills_in() {
        let schema = Schema::new();
        let mut wrong = BTreeSet::new();
        let mut valid = 0;
        for specimen in specimens::SPECIMENS {
            let changes: Vec<String> = specimen.changes.iter().map(|&text| text.into()).collect();
            let document = || Document::of(specimen.deck, "specimen", &changes).unwrap();
            for number in 0..count(&document().root) {
                let mut document = document();
                remove(&mut document.root, number).unwrap();
                let ledger = Ledger::surveyed(document.sources, Survey::default());
                let read = Deck::read_with(ledger, &document.root, &[]);
                // A required key.
                let Ok((_, filled)) = read else { continue };
                valid += 1;
                // Their default schedule is the schedule of the history.
                let places = filled
                    .places()
                    .filter(|(place, _)| !place.starts_with("output.cracks."));
                for (place, value) in places {
                    let known = schema.survey.value(place).map(|known| &known.defaults[..]);
                    for default in &value.defaults {
                        if !known.unwrap_or_default().contains(default) {
                            wrong.insert(format!("{place}: {default}"));
                        }
                    }
                }
            }
        }
        assert!(valid > 1000, "{valid}");
        assert!(
            wrong.is_empty(),
            "add specimens without these keys: {wrong:#?}"
        );
    }
}
