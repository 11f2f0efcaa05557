//! Descriptions of tables and keys.

use std::collections::BTreeMap;

/// The key of the description of a table itself.
const ABOUT: &str = "about";

/// Descriptions by table and key; names of tables have no list brackets.
#[derive(Default)]
pub(super) struct Descriptions(BTreeMap<(String, String), String>);

impl Descriptions {
    /// Collects the descriptions that the reader notes.
    pub(super) fn new<'a>(noted: impl Iterator<Item = (&'a str, Option<&'a str>, String)>) -> Self {
        let mut all = Self::default();
        for (table, key, text) in noted {
            let key = key.unwrap_or(ABOUT).to_owned();
            let slot = all.0.entry((table.replace("[]", ""), key)).or_default();
            // Keys of several tables with one name have several descriptions.
            if !slot.is_empty() {
                slot.push(' ');
            }
            slot.push_str(&text);
        }
        all
    }

    /// Returns the description of a table or definition.
    pub(super) fn of_table(&self, place: &str) -> Option<&str> {
        self.get(&place.replace("[]", ""), ABOUT)
    }

    /// Returns the description of a key.
    pub(super) fn of_key(&self, place: &str) -> Option<&str> {
        let place = place.replace("[]", "");
        let (table, key) = place.rsplit_once('.').unwrap_or(("", &place));
        self.get(table, key)
    }

    fn get(&self, table: &str, key: &str) -> Option<&str> {
        let text = self.0.get(&(table.to_owned(), key.to_owned()));
        text.map(String::as_str)
    }
}
