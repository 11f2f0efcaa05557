//! Values of keys that need no reader of their own.

use std::path::PathBuf;

use serde_json::Value as Json;

use super::{Check, DeckTable, DeckValue, Fallback, Spatial, Unique};
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::range::Range;
use crate::reader::{Item, Table};
use crate::words::Worded;

/// A number or several numbers of a quantity.
pub(crate) trait Measured<S>: Sized {
    /// Reads the value in SI units; none after reporting an error.
    fn read(item: &Item<'_>, quantity: Quantity, range: Range, scope: S) -> Option<Self>;

    /// Reads the value, or none for a word; the outer option is none after reporting an error.
    fn read_or(
        item: &Item<'_>,
        word: &'static str,
        quantity: Quantity,
        range: Range,
        scope: S,
    ) -> Option<Option<Self>> {
        match item.is_number_or(word, quantity)? {
            true => Self::read(item, quantity, range, scope).map(Some),
            false => Some(None),
        }
    }

    /// Checks the range of the value at a path.
    fn check(&self, path: KeyPath, range: Range, scope: S, check: &mut Check);
}

impl<S> Measured<S> for f64 {
    fn read(item: &Item<'_>, quantity: Quantity, range: Range, _: S) -> Option<Self> {
        item.number(quantity, range)
    }

    fn check(&self, path: KeyPath, range: Range, _: S, check: &mut Check) {
        check.number(path, *self, range);
    }
}

impl<S> Measured<S> for u32 {
    /// Reads a whole number; it has no unit.
    fn read(item: &Item<'_>, _: Quantity, range: Range, _: S) -> Option<Self> {
        let count = item.count_within(range)?;
        let number = Self::try_from(count);
        number.map_err(|_| item.out_of_range(&range.words())).ok()
    }

    fn check(&self, path: KeyPath, range: Range, _: S, check: &mut Check) {
        check.number(path, f64::from(*self), range);
    }
}

/// A vector with one component per dimension of the body.
impl<S: Spatial> Measured<S> for [f64; 3] {
    fn read(item: &Item<'_>, quantity: Quantity, range: Range, scope: S) -> Option<Self> {
        item.vector_within(quantity, range, scope.dimension())
    }

    fn check(&self, path: KeyPath, range: Range, scope: S, check: &mut Check) {
        let components = self.iter().take(scope.dimension().unwrap_or(3));
        for (c, component) in components.enumerate() {
            check.number(path.index(c), *component, range);
        }
    }
}

impl<S> DeckValue<S> for bool {
    fn read(item: &Item<'_>, _: S) -> Option<Self> {
        item.boolean()
    }

    fn check(&self, _: KeyPath, _: S, _: &mut Check) {}
}

impl<S, T: Worded> DeckValue<S> for T {
    fn read(item: &Item<'_>, _: S) -> Option<Self> {
        item.choice(T::WHAT, &T::words())
    }

    fn check(&self, _: KeyPath, _: S, _: &mut Check) {}
}

impl<S> DeckValue<S> for u64 {
    fn read(item: &Item<'_>, _: S) -> Option<Self> {
        item.count()
    }

    fn check(&self, path: KeyPath, _: S, check: &mut Check) {
        check.count(path, *self);
    }
}

impl<S> DeckValue<S> for String {
    fn read(item: &Item<'_>, _: S) -> Option<Self> {
        item.text()
    }

    fn check(&self, _: KeyPath, _: S, _: &mut Check) {}
}

impl<S> DeckValue<S> for PathBuf {
    fn read(item: &Item<'_>, _: S) -> Option<Self> {
        item.text().map(Self::from)
    }

    fn check(&self, _: KeyPath, _: S, _: &mut Check) {}
}

/// Reports the text of a unique key if it is known.
fn is_unique<'a>(table: &Table<'a>, unique: &Unique, known: &mut Vec<&'a str>) -> bool {
    let item = table.optional(unique.key);
    let Some((item, text)) = item.and_then(|item| Some((item.clone(), item.word()?))) else {
        return true;
    };
    if known.contains(&text) {
        item.report(Fault::BadName {
            name: text.into(),
            reason: unique.reason,
            allowed: unique.allowed,
        });
        return false;
    }
    known.push(text);
    true
}

/// Records defaults as they are.
macro_rules! recorded {
    ($($type:ty),*) => {$(
        impl<S> Fallback<S> for $type {
            fn missing(self, table: &Table<'_>, key: &'static str, _: S) -> Option<Self> {
                table.record(key, self.clone());
                Some(self)
            }
        }
    )*};
}

recorded!(f64, bool, u32, u64, String);

/// Records one component per dimension of the body; infinite bounds are not recorded.
impl<S: Spatial> Fallback<S> for [f64; 3] {
    fn missing(self, table: &Table<'_>, key: &'static str, scope: S) -> Option<Self> {
        if self.iter().all(|x| x.is_finite()) {
            let dimension = scope.dimension().unwrap_or(3);
            table.record(key, self[..dimension].to_vec());
        }
        Some(self)
    }
}

/// Space, for vectors that do not depend on the dimension of the body.
impl Spatial for () {
    fn dimension(&self) -> Option<usize> {
        Some(3)
    }
}

/// The dimension itself.
impl Spatial for Option<usize> {
    fn dimension(&self) -> Option<usize> {
        *self
    }
}

impl<S, T: Worded> Fallback<S> for T {
    fn missing(self, table: &Table<'_>, key: &'static str, _: S) -> Option<Self> {
        let words = T::words();
        let word = words.iter().find(|(_, value)| *value == self);
        table.record(key, word.map_or(Json::Null, |(word, _)| (*word).into()));
        Some(self)
    }
}

impl<S: Copy, T: DeckTable<S>> DeckValue<S> for Vec<T> {
    fn read(item: &Item<'_>, scope: S) -> Option<Self> {
        let mut known = Vec::new();
        let read: Vec<Option<T>> = item
            .tables()?
            .into_iter()
            .map(|table| {
                let table = table?;
                let is_unique =
                    T::UNIQUE.is_none_or(|unique| is_unique(&table, &unique, &mut known));
                T::read_table(table, scope).filter(|_| is_unique)
            })
            .collect();
        read.into_iter().collect()
    }

    fn check(&self, path: KeyPath, scope: S, check: &mut Check) {
        for (k, table) in self.iter().enumerate() {
            let path = path.index(k);
            table.check_keys(&path, scope, check);
            if let (Some(unique), Some(text)) = (T::UNIQUE, table.unique_text()) {
                let known = self[..k]
                    .iter()
                    .any(|other| other.unique_text() == Some(text));
                check.within(!known, path.key(unique.key), text, unique.allowed);
            }
        }
    }
}
