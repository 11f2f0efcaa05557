//! Descriptions of tables and keys.

use toml::Table;

/// The key of the description of a table itself.
const ABOUT: &str = "about";

/// Descriptions by table and key; names of tables have no list brackets.
pub(super) struct Descriptions(Table);

impl Descriptions {
    /// Collects the descriptions of `descriptions.toml` and of declared tables.
    pub(super) fn new<'a>(
        declared: impl Iterator<Item = (&'a str, Option<&'a str>, String)>,
    ) -> Self {
        let text = include_str!("descriptions.toml");
        let mut all: Table = text
            .parse()
            .unwrap_or_else(|error| panic!("descriptions.toml: {error}"));
        for (table, key, text) in declared {
            let place = table.replace("[]", "");
            let keys = all.entry(place).or_insert_with(|| Table::new().into());
            if let Some(keys) = keys.as_table_mut() {
                let key = key.unwrap_or(ABOUT);
                // Keys of several tables with one name have several descriptions.
                let other = keys.get(key).and_then(|other| other.as_str());
                let text = other.map_or(text.clone(), |other| format!("{other} {text}"));
                keys.insert(key.to_owned(), text.into());
            }
        }
        Self(all)
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
        self.0.get(table)?.get(key)?.as_str()
    }

    /// Returns all tables and keys with a description; no key for the description of a table.
    #[cfg(test)]
    pub(super) fn all(&self) -> impl Iterator<Item = (&str, Option<&str>)> {
        self.0.iter().flat_map(|(table, keys)| {
            let keys = keys.as_table().into_iter().flatten();
            keys.map(move |(key, text)| {
                assert!(text.is_str(), "[{table}] {key}");
                (table.as_str(), (key != ABOUT).then_some(key.as_str()))
            })
        })
    }
}
