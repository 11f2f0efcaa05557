//! Declared tables: one annotated type from which reader, range check, defaults and descriptions of the keys follow.
//!
//! A table of a deck is a struct with `#[derive(DeckTable)]`: a field is a key, its attributes give quantity, range and
//! default, and the first paragraph of its documentation describes the key in schema and book:
//!
//! ```text
//! /// Coulomb friction.
//! #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
//! #[serde(deny_unknown_fields)]
//! pub struct ContactFriction {
//!     /// Coefficient of friction μ.
//!     #[deck(range = at_least(0.0))]
//!     pub coefficient: f64,
//!     /// Sliding speed v below which friction decreases.
//!     ///
//!     /// In m/s.
//!     #[deck(quantity = Velocity, range = POSITIVE)]
//!     pub speed: f64,
//! }
//! ```
//!
//! `DeckKeys` derives the same for enums whose variants are selected by a word or by exclusive keys, `DeckWords` for
//! enums of words. The documentation of `pericles-deck-derive` lists all attributes. The derived reader makes the calls
//! of [`Table`] and [`Item`] that a reader written by hand makes, so that locations, collected errors, the record of
//! defaults and the survey for the schema need no code of their own. Types with a reader of their own implement
//! [`DeckValue`].
//!
//! What keys depend on in addition to the keys above them is the scope of a table, of type `S`: the dimension of the body, the
//! names of sets. Tables that depend on nothing else have any scope.

mod check;
#[cfg(test)]
mod tests;
mod values;

pub(crate) use check::Check;
pub(crate) use values::Measured;

pub(crate) use crate::reader::Group;

use crate::key_path::KeyPath;
use crate::reader::{Item, Table};

/// A type that is read from keys of a table.
pub(crate) trait Keyed {
    /// Name of the definition of the table in the schema, if several keys share it.
    const DEFINITION: Option<&'static str> = None;

    /// Returns all its keys.
    fn keys() -> Vec<&'static str>;

    /// Returns the groups of keys that a word of the tag of an enum selects; all keys of other types.
    fn groups(_: &str) -> Vec<Group> {
        vec![(Self::keys(), None)]
    }
}

/// Keys in a table, which may have further keys.
pub(crate) trait DeckKeys<S>: Sized {
    /// Reads the keys; none after reporting an error.
    fn read_keys(table: &Table<'_>, scope: S) -> Option<Self>;

    /// Checks the values of the keys of the table at a path.
    fn check_keys(&self, path: &KeyPath, scope: S, check: &mut Check);
}

/// Keys of which one is given.
pub(crate) trait Exclusive {
    /// Returns these keys.
    fn choices() -> &'static [&'static str];
}

/// Keys of which one is given, which may be choices among further keys.
pub(crate) trait DeckChoice<S>: Exclusive + Sized {
    /// Describes the keys and rejects those that are not allowed.
    fn prepare(table: &Table<'_>, scope: S);

    /// Reads the value of the key that is given; none after reporting an error.
    fn read_choice(table: &Table<'_>, key: &'static str, item: &Item<'_>, scope: S)
    -> Option<Self>;
}

/// A complete table.
pub(crate) trait DeckTable<S>: DeckKeys<S> + Keyed {
    /// Description of the table.
    const ABOUT: &'static str;

    /// The key whose texts are unique in a list of tables, with the fault of a text that another table has.
    const UNIQUE: Option<Unique> = None;

    /// Returns the text of the unique key.
    fn unique_text(&self) -> Option<&str> {
        None
    }

    /// Reads a table and reports unknown keys; none after reporting an error.
    fn read_table(table: Table<'_>, scope: S) -> Option<Self> {
        if let Some(name) = Self::DEFINITION {
            table.define(name);
        }
        table.about(Self::ABOUT);
        let read = Self::read_keys(&table, scope);
        table.finish();
        read
    }
}

/// A key whose texts are unique in a list of tables.
pub(crate) struct Unique {
    pub(crate) key: &'static str,
    /// Why a text that another table has is rejected.
    pub(crate) reason: &'static str,
    pub(crate) allowed: &'static str,
}

/// A value of a key.
pub(crate) trait DeckValue<S>: Sized {
    /// Reads the value; none after reporting an error.
    fn read(item: &Item<'_>, scope: S) -> Option<Self>;

    /// Checks the value at a path.
    fn check(&self, path: KeyPath, scope: S, check: &mut Check);
}

/// Scopes that know the dimension of the body.
pub(crate) trait Spatial {
    /// Returns the dimension of the body; none if another error makes it unknown.
    fn dimension(&self) -> Option<usize>;
}

/// A value that is the default of a missing key.
pub(crate) trait Fallback<S>: Sized {
    /// Records the value as the default of a key and returns it.
    fn missing(self, table: &Table<'_>, key: &'static str, scope: S) -> Option<Self>;
}

/// Reads a list of declared tables.
pub(crate) fn declared<S, T>(table: &Table<'_>, key: &'static str, scope: S) -> Option<Vec<T>>
where
    Vec<T>: DeckValue<S>,
{
    match table.optional(key) {
        Some(item) => DeckValue::read(&item, scope),
        None => Some(Vec::new()),
    }
}
