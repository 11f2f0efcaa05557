//! Deprecated names of keys and words, replaced by the present ones before a deck is read.
//!
//! Decks and overrides may use either. A deck with deprecated names causes one warning, which lists the present ones.

use crate::document::{Node, Value};
use crate::source::Place;

/// A replaced name.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Renamed {
    /// Its location.
    pub(crate) place: Place,
    pub(crate) former: &'static str,
    pub(crate) present: &'static str,
}

/// Table, deprecated and present key. Tables are keys joined by dots, with `*` for any name; entries of lists
/// of tables have the path of the list.
const KEYS: &[(&str, &str, &str)] = &[
    ("", "prescribe", "constraint"),
    ("body", "around", "major_segments"),
    ("body", "across", "minor_segments"),
    ("material", "treatment", "approximation"),
    ("materials.*", "treatment", "approximation"),
    ("material", "self_cell", "self_interaction"),
    ("materials.*", "self_cell", "self_interaction"),
    ("boundary", "exterior_data", "exterior_extent"),
    ("time.adaptive", "hold", "keep_checks"),
];

/// Key, deprecated and present word.
const WORDS: &[(&str, &str, &str)] = &[
    ("material.model", "literal57", "cubic-softening"),
    ("materials.*.model", "literal57", "cubic-softening"),
    ("material.influence.function", "classes", "lattice-classes"),
    (
        "materials.*.influence.function",
        "classes",
        "lattice-classes",
    ),
    ("time.scheme", "rk3-mts", "multirate-rk3"),
    ("time.scheme", "rk4-mts", "multirate-rk4"),
    ("time.scheme", "relaxation", "adaptive-dynamic-relaxation"),
];

/// Returns the present name of a key in a table; `table` is the path of keys from the root.
pub(crate) fn present<'k>(table: &[&str], key: &'k str) -> &'k str {
    find(KEYS, table, key).map_or(key, |(_, present)| present)
}

/// Replaces deprecated keys and words of a deck. A deprecated key beside its present name in the same table
/// is left to the reader, which refuses it.
pub(crate) fn modernise(root: &mut Node) -> Vec<Renamed> {
    let mut renamed = Vec::new();
    visit(root, &mut Vec::new(), &mut renamed);
    renamed.sort_by_key(|one: &Renamed| (one.place.source, one.place.start));
    renamed
}

fn visit(node: &mut Node, path: &mut Vec<String>, renamed: &mut Vec<Renamed>) {
    match &mut node.value {
        Value::Array(items) => {
            for item in items {
                visit(item, path, renamed);
            }
        }
        Value::Table(entries) => {
            for k in 0..entries.len() {
                let found = find(KEYS, &borrowed(path), &entries[k].key);
                let is_free =
                    |present: &str| entries.iter().all(|entry| entry.key.as_str() != present);
                if let Some((former, present)) = found.filter(|(_, present)| is_free(present)) {
                    renamed.push(Renamed {
                        place: entries[k].key_place,
                        former,
                        present,
                    });
                    entries[k].key = present.into();
                }
                path.push(entries[k].key.clone());
                visit(&mut entries[k].node, path, renamed);
                path.pop();
            }
        }
        Value::Text(word) => {
            if let Some((former, present)) = find(WORDS, &borrowed(path), word) {
                renamed.push(Renamed {
                    place: node.place,
                    former,
                    present,
                });
                *word = present.into();
            }
        }
        _ => {}
    }
}

fn borrowed(path: &[String]) -> Vec<&str> {
    path.iter().map(String::as_str).collect()
}

fn find(
    names: &'static [(&str, &str, &str)],
    path: &[&str],
    name: &str,
) -> Option<(&'static str, &'static str)> {
    let found = names
        .iter()
        .find(|(place, former, _)| *former == name && matches(place, path));
    found.map(|(_, former, present)| (*former, *present))
}

/// Returns whether a path matches a pattern.
fn matches(pattern: &str, path: &[&str]) -> bool {
    let mut steps = pattern.split('.').filter(|step| !step.is_empty());
    let all = path.iter().all(|name| {
        steps
            .next()
            .is_some_and(|step| step == "*" || step == *name)
    });
    all && steps.next().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deprecated_keys_are_renamed_in_their_tables_only() {
        assert_eq!(present(&[], "prescribe"), "constraint");
        assert_eq!(present(&["sets"], "prescribe"), "prescribe");
        assert_eq!(
            present(&["materials", "glass"], "treatment"),
            "approximation"
        );
        assert_eq!(present(&["materials"], "treatment"), "treatment");
        assert_eq!(present(&["time", "adaptive"], "hold"), "keep_checks");
    }
}
