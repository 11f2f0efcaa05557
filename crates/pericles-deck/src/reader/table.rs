//! Typed access to a table.

use std::cell::RefCell;

use serde_json::Value as Json;

use super::{Form, Item, Ledger};
use crate::document::{Entry, Node, Value};
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::nearest::nearest;
use crate::source::Place;
use crate::vocabulary::{canonical, synonyms};
use crate::wording::or;

/// A table being read.
pub(crate) struct Table<'a> {
    ledger: &'a Ledger,
    path: KeyPath,
    place: Place,
    entries: &'a [Entry],
    /// Requested keys, by their first names.
    allowed: RefCell<Vec<&'static str>>,
    /// Keys that are not reported as unknown.
    settled: RefCell<Vec<&'a str>>,
    /// Required keys.
    needed: RefCell<Vec<&'static str>>,
    /// Keys that are not allowed.
    forbidden: RefCell<Vec<&'static str>>,
}

impl<'a> Table<'a> {
    pub(super) fn new(
        ledger: &'a Ledger,
        path: KeyPath,
        place: Place,
        entries: &'a [Entry],
    ) -> Self {
        Self {
            ledger,
            path,
            place,
            entries,
            allowed: RefCell::default(),
            settled: RefCell::default(),
            needed: RefCell::default(),
            forbidden: RefCell::default(),
        }
    }

    /// Records the default of a missing key.
    pub(crate) fn record(&self, key: &str, value: impl Into<Json>) {
        let (path, value) = (self.path.key(key), value.into());
        self.ledger
            .note(|survey| survey.default(&path, value.clone()));
        self.ledger.record(&path, value);
    }

    /// Notes the description of the table in the survey.
    pub(crate) fn about(&self, text: &'static str) {
        self.ledger.note(|survey| survey.about(&self.path, text));
    }

    /// Notes the description of a key in the survey.
    pub(crate) fn describe(&self, key: &str, text: &'static str) {
        self.ledger
            .note(|survey| survey.describe(&self.path, key, text));
    }

    /// Notes in the survey that this table has the shared definition `name`.
    pub(crate) fn define(&self, name: &'static str) {
        self.ledger.note(|survey| survey.define(&self.path, name));
    }

    /// Unwraps a result of the library and reports an error.
    pub(crate) fn accept<T>(&self, result: pericles::Result<T>) -> Option<T> {
        result.map_err(|error| self.report(error.into())).ok()
    }

    /// Reports a fault of the table as a whole.
    pub(crate) fn report(&self, fault: Fault) {
        self.ledger.report(self.place, fault);
    }

    /// Reports a fault at a location.
    pub(crate) fn report_at(&self, place: Place, fault: Fault) {
        self.ledger.report(place, fault);
    }

    /// Returns whether a key is present, under any of its names.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.place_of(key).is_some()
    }

    /// Returns the name of the table in messages.
    pub(crate) fn name(&self) -> String {
        self.path.to_string()
    }

    /// Returns the location of the value of a key, under any of its names.
    pub(crate) fn place_of(&self, key: &str) -> Option<Place> {
        self.node_of(key).map(|node| node.place)
    }

    /// Returns the word that is the value of a key, also if it is not allowed.
    pub(crate) fn word_of(&self, key: &str) -> Option<&'a str> {
        match &self.node_of(key)?.value {
            Value::Text(word) => Some(word),
            _ => None,
        }
    }

    /// Returns the value of a key, under any of its names.
    fn node_of(&self, key: &str) -> Option<&'a Node> {
        let names =
            |entry: &&Entry| entry.key == key || synonyms(key).contains(&entry.key.as_str());
        self.entries.iter().find(names).map(|entry| &entry.node)
    }

    /// Returns the number that was read from a key, in SI units; also one out of range.
    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        self.ledger.number(&self.path.key(key))
    }

    /// Returns the value of an optional key.
    pub(crate) fn optional(&self, key: &'static str) -> Option<Item<'a>> {
        let mut allowed = self.allowed.borrow_mut();
        if !allowed.contains(&key) {
            allowed.push(key);
        }
        drop(allowed);
        self.ledger.note(|survey| survey.key(&self.path, key));
        let mut found: Option<&Entry> = None;
        for name in std::iter::once(key).chain(synonyms(key).iter().copied()) {
            let Some(entry) = self.entries.iter().find(|entry| entry.key == name) else {
                continue;
            };
            self.settled.borrow_mut().push(&entry.key);
            match found {
                None => found = Some(entry),
                Some(first) => {
                    let mut pair = [first, entry];
                    pair.sort_by_key(|entry| entry.key_place.start);
                    self.ledger.report(
                        pair[1].key_place,
                        Fault::Exclusive {
                            given: pair.iter().map(|entry| entry.key.clone()).collect(),
                            table: self.path.to_string(),
                            allowed: pair.iter().map(|entry| entry.key.clone()).collect(),
                        },
                    );
                }
            }
        }
        found.map(|entry| Item::new(self.ledger, self.path.key(key), &entry.node))
    }

    /// Returns the value of a required key.
    pub(crate) fn required(&self, key: &'static str) -> Option<Item<'a>> {
        let item = self.optional(key);
        let mut needed = self.needed.borrow_mut();
        if !needed.contains(&key) {
            needed.push(key);
            self.ledger.note(|survey| survey.needed(&self.path, key));
        }
        if item.is_none() {
            self.requires_one_of(&[key]);
        }
        item
    }

    /// Returns at most one of several exclusive keys with its value; the outer option is none after reporting several.
    pub(crate) fn at_most_one(
        &self,
        keys: &'static [&'static str],
    ) -> Option<Option<(&'static str, Item<'a>)>> {
        self.choice_of(keys, false)
    }

    /// Notes that keys that are exclusive in other decks may be given together.
    pub(crate) fn together(&self, keys: &'static [&'static str]) {
        self.ledger.note(|survey| survey.together(&self.path, keys));
    }

    fn choice_of(
        &self,
        keys: &'static [&'static str],
        needed: bool,
    ) -> Option<Option<(&'static str, Item<'a>)>> {
        self.ledger
            .note(|survey| survey.choice(&self.path, keys, needed));
        let forbidden = self.forbidden.borrow();
        let allowed = keys.iter().filter(|key| !forbidden.contains(key));
        let mut found: Vec<(&'static str, Item<'a>)> = allowed
            .filter_map(|key| Some((*key, self.optional(key)?)))
            .collect();
        if found.len() > 1 {
            let place = found
                .iter()
                .map(|(_, item)| item.place())
                .max_by_key(|place| (place.source, place.start))
                .unwrap_or(self.place);
            self.ledger.report(
                place,
                Fault::Exclusive {
                    given: found.iter().map(|(key, _)| (*key).to_owned()).collect(),
                    table: self.path.to_string(),
                    allowed: owned(keys),
                },
            );
            return None;
        }
        Some(found.pop())
    }

    /// Returns exactly one of several exclusive keys with its value.
    pub(crate) fn exactly_one(
        &self,
        keys: &'static [&'static str],
    ) -> Option<(&'static str, Item<'a>)> {
        let found = self.choice_of(keys, true)?;
        let forbidden = self.forbidden.borrow();
        let (without, allowed): (Vec<&str>, Vec<&str>) = keys
            .iter()
            .copied()
            .partition(|key| forbidden.contains(key));
        // A key that is not allowed is reported already.
        if found.is_none() && !without.iter().any(|key| self.has(key)) {
            self.requires_one_of(&allowed);
        }
        found
    }

    /// Returns the value of a key that has been requested before and is allowed.
    pub(crate) fn read_before(&self, key: &'static str) -> Option<Item<'a>> {
        let is_known = self.allowed.borrow().contains(&key);
        let is_allowed = !self.forbidden.borrow().contains(&key);
        match is_known && is_allowed {
            true => self.optional(key),
            false => None,
        }
    }

    /// Requires at least one of several keys.
    pub(crate) fn at_least_one(&self, keys: &[&str]) {
        if !keys.iter().any(|key| self.has(key)) {
            self.requires_one_of(keys);
        }
    }

    /// Reports that none of several keys is given.
    pub(crate) fn requires_one_of(&self, keys: &[&str]) {
        let table = self.path.to_string();
        self.report(match keys {
            [key] => Fault::MissingKey {
                key: (*key).into(),
                synonyms: owned(synonyms(key)),
                table,
            },
            _ => Fault::MissingChoice {
                table,
                allowed: owned(keys),
            },
        });
    }

    /// Reads an optional value; the outer option is none if it is present and invalid.
    pub(crate) fn maybe<T>(
        &self,
        key: &'static str,
        read: impl FnOnce(Item<'a>) -> Option<T>,
    ) -> Option<Option<T>> {
        match self.optional(key) {
            Some(item) => read(item).map(Some),
            None => Some(None),
        }
    }

    /// Returns an inner table, or an empty one if it is missing, so that its defaults are recorded.
    pub(crate) fn table_or_empty(&self, key: &'static str) -> Option<Table<'a>> {
        match self.optional(key) {
            Some(item) => item.table(),
            None => {
                let path = self.path.key(key);
                self.ledger.note(|survey| survey.form(&path, Form::Table));
                Some(Table::new(self.ledger, path, self.place, &[]))
            }
        }
    }

    /// Records a default, of which `none` is recorded as a word.
    pub(crate) fn record_or<T: Copy + Into<Json>>(&self, key: &str, value: Option<T>, none: &str) {
        match value {
            Some(value) => self.record(key, value),
            None => self.record(key, none),
        }
    }

    /// Reads a value with a default, which is recorded.
    pub(crate) fn or<T: Clone + Into<Json>>(
        &self,
        key: &'static str,
        default: T,
        read: impl FnOnce(Item<'a>) -> Option<T>,
    ) -> Option<T> {
        match self.optional(key) {
            Some(item) => read(item),
            None => {
                self.record(key, default.clone());
                Some(default)
            }
        }
    }

    /// Reads a word from a list; the default is the first.
    pub(crate) fn choice_or_first<T: Copy>(
        &self,
        key: &'static str,
        what: &'static str,
        words: &[(&'static str, T)],
    ) -> Option<T> {
        match self.optional(key) {
            Some(item) => item.choice(what, words),
            None => {
                let (word, value) = words.first()?;
                self.record(key, *word);
                Some(*value)
            }
        }
    }

    /// Returns the tables of an array of tables; empty if the key is missing.
    pub(crate) fn tables(&self, key: &'static str) -> Vec<Table<'a>> {
        let tables = self.optional(key).and_then(|item| item.tables());
        tables.into_iter().flatten().flatten().collect()
    }

    /// Rejects a key that is not allowed in this table, with the reason.
    pub(crate) fn forbid(&self, key: &'static str, allowed: &str) {
        self.forbidden.borrow_mut().push(key);
        for entry in self
            .entries
            .iter()
            .filter(|entry| entry.key == key || synonyms(key).contains(&entry.key.as_str()))
        {
            self.settled.borrow_mut().push(&entry.key);
            self.ledger.report(
                entry.key_place,
                Fault::Misplaced {
                    key: entry.key.clone(),
                    table: self.path.to_string(),
                    allowed: allowed.into(),
                },
            );
        }
    }

    /// Rejects keys of other alternatives than the given one; `selector`: what precedes their names in the reasons.
    pub(crate) fn forbid_others(&self, selector: &str, own: usize, all: &[Alternative]) {
        for other in all {
            for (key, reason) in other.keys().filter(|(key, _)| !all[own].has(key)) {
                match reason {
                    Some(reason) => self.forbid(key, reason),
                    None if self.has(key) => {
                        let with = all.iter().filter(|one| one.has(key)).map(|one| one.name);
                        self.forbid(key, &format!("it requires {selector}{}", or(with)));
                    }
                    None => {}
                }
            }
        }
    }

    /// Marks keys as known whose values depend on an invalid one.
    pub(crate) fn know(&self, keys: &[&'static str]) {
        let forbidden = self.forbidden.borrow();
        for key in keys.iter().filter(|key| !forbidden.contains(key)) {
            self.optional(key);
        }
    }

    /// Returns all keys with their values, for tables whose keys are names.
    pub(crate) fn named(
        &self,
        kind: &'static str,
    ) -> impl Iterator<Item = (&'a str, Place, Item<'a>)> + '_ {
        self.entries.iter().map(move |entry| {
            self.settled.borrow_mut().push(&entry.key);
            let path = self.path.key(&entry.key);
            self.ledger
                .note(|survey| survey.define_named(&self.path, &path, kind));
            let item = Item::new(self.ledger, path, &entry.node);
            (entry.key.as_str(), entry.key_place, item)
        })
    }

    /// Marks all keys as known, because other tables inherit them.
    pub(crate) fn taken_over(&self) {
        self.ledger.note(|survey| survey.visited(&self.path));
    }

    /// Redirects messages about the values of an inner table to another table, if one is given.
    pub(crate) fn place_as(&self, key: &str, written: Option<KeyPath>) {
        if let Some(written) = written {
            self.ledger.alias(self.path.key(key), written);
        }
    }

    /// Reports keys that were not requested as unknown.
    pub(crate) fn finish(self) {
        self.ledger.note(|survey| survey.visited(&self.path));
        let settled = self.settled.borrow();
        let allowed = self.allowed.borrow();
        for entry in self.entries {
            if settled.contains(&entry.key.as_str()) {
                continue;
            }
            let words = allowed
                .iter()
                .flat_map(|key| std::iter::once(*key).chain(synonyms(key).iter().copied()));
            let nearest = nearest(&entry.key, words);
            if let Some(nearest) = nearest {
                self.ledger
                    .found_misspelt(canonical(nearest), &self.path.to_string());
            }
            self.ledger.report(
                entry.key_place,
                Fault::UnknownKey {
                    key: entry.key.clone(),
                    table: self.path.to_string(),
                    nearest: nearest.map(String::from),
                    // A key of other bodies does not belong to this table either.
                    home: nearest
                        .is_none()
                        .then(|| self.ledger.home_of(&entry.key, entry.node.value.is_table()))
                        .flatten()
                        .filter(|home| *home != self.path.to_string()),
                    allowed: owned(&allowed),
                },
            );
        }
    }
}

impl<'a> Item<'a> {
    /// Returns the value as a table.
    pub(crate) fn table(&self) -> Option<Table<'a>> {
        let entries = self.table_entries()?;
        Some(Table::new(
            self.ledger(),
            self.path().clone(),
            self.place(),
            entries,
        ))
    }

    /// Returns the tables of a list of tables; none for entries that are not tables.
    pub(crate) fn tables(&self) -> Option<Vec<Option<Table<'a>>>> {
        let items = self.list("a list of tables, written [[…]] or [{ … }]")?;
        Some(items.iter().map(Item::table).collect())
    }
}

/// An alternative of a table: a word or an exclusive key, with the keys that it selects.
pub(crate) struct Alternative {
    pub(crate) name: &'static str,
    pub(crate) groups: Vec<Group>,
}

/// Keys of an alternative, and why other alternatives reject them, if the reason is not the choice itself.
pub(crate) type Group = (Vec<&'static str>, Option<&'static str>);

impl Alternative {
    fn keys(&self) -> impl Iterator<Item = (&'static str, Option<&'static str>)> {
        let groups = self.groups.iter();
        groups.flat_map(|(keys, reason)| keys.iter().map(|key| (*key, *reason)))
    }

    fn has(&self, wanted: &str) -> bool {
        self.keys().any(|(key, _)| key == wanted)
    }
}

fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}
