//! A thin typed reader over the located document.
//!
//! [`Table`] returns the values of requested keys; [`Table::finish`] reports all other keys as unknown.
//! [`Item`] converts one value to a number, a word, a vector …. Both return `None` after noting a [`Problem`]
//! in the [`Ledger`], so that one pass over a deck reports all errors. The ledger also records the location
//! of each value and its conversion to SI units.

mod item;
mod survey;
mod table;

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::mem::{Discriminant, discriminant};

use serde_json::{Map, Value as Json};

pub(crate) use item::Item;
pub(crate) use survey::{Form, Survey, TableSurvey, below};
pub(crate) use table::{Alternative, Group, Table};

use crate::document::Node;
use crate::fault::Fault;
use crate::finding::Problem;
use crate::key_path::{KeyPath, Step};
use crate::source::{Place, Sources};
use crate::wording::shortened;

/// Returns the table to which a key belongs.
pub(crate) type HomeOf = fn(&str, bool) -> Option<&'static str>;

/// Problems and values recorded while a deck is read.
pub(crate) struct Ledger {
    sources: Sources,
    /// None for a survey, from which the tables of keys follow.
    home_of: Option<HomeOf>,
    problems: RefCell<Vec<Problem>>,
    reported: RefCell<HashSet<(Place, Discriminant<Fault>)>>,
    /// Keys that are present but misspelt, with their tables; they are not reported as missing.
    misspelt: RefCell<BTreeSet<(String, String)>>,
    places: RefCell<BTreeMap<KeyPath, Place>>,
    aliases: RefCell<Vec<(KeyPath, KeyPath)>>,
    json: RefCell<Json>,
    survey: Option<RefCell<Survey>>,
}

impl Ledger {
    /// Creates a ledger; `home_of` returns the table that messages about unknown keys name.
    pub(crate) fn new(sources: Sources, home_of: HomeOf) -> Self {
        Self {
            home_of: Some(home_of),
            ..Self::without_homes(sources)
        }
    }

    fn without_homes(sources: Sources) -> Self {
        Self {
            sources,
            home_of: None,
            problems: RefCell::default(),
            reported: RefCell::default(),
            misspelt: RefCell::default(),
            places: RefCell::default(),
            aliases: RefCell::default(),
            json: RefCell::new(Json::Object(Map::new())),
            survey: None,
        }
    }

    /// Creates a ledger with a survey, which records what the reader requests.
    pub(crate) fn surveyed(sources: Sources, mut survey: Survey) -> Self {
        survey.begin();
        Self {
            survey: Some(RefCell::new(survey)),
            ..Self::without_homes(sources)
        }
    }

    fn note(&self, note: impl FnOnce(&mut Survey)) {
        if let Some(survey) = &self.survey {
            note(&mut survey.borrow_mut());
        }
    }

    /// Returns the table to which a key belongs.
    fn home_of(&self, key: &str, is_table: bool) -> Option<&'static str> {
        self.home_of.and_then(|home_of| home_of(key, is_table))
    }

    /// Returns the root table.
    pub(crate) fn root<'a>(&'a self, root: &'a Node) -> Option<Table<'a>> {
        Item::new(self, KeyPath::default(), root).table()
    }

    pub(crate) fn report(&self, place: Place, fault: Fault) {
        // Errors in keys that several tables inherit are reported once.
        let missing = matches!(
            fault,
            Fault::MissingKey { .. } | Fault::MissingChoice { .. }
        );
        let found = (place, discriminant(&fault));
        if self.reported.borrow_mut().insert(found) || missing {
            let at = self.sources.locate(place);
            self.problems.borrow_mut().push(Problem::new(fault, at));
        }
    }

    /// Removes the report of a missing key that is present but misspelt.
    fn found_misspelt(&self, key: &str, table: &str) {
        let found = (key.to_owned(), table.to_owned());
        self.misspelt.borrow_mut().insert(found);
    }

    /// Reports a fault with the text at a location.
    fn report_value(&self, place: Place, fault: impl FnOnce(String) -> Fault) {
        let value = self.excerpt(place);
        self.report(place, fault(value));
    }

    /// Returns the text at a location, shortened if it is long.
    fn excerpt(&self, place: Place) -> String {
        let at = self.sources.locate(place);
        let text = at.excerpt();
        let text = text
            .strip_prefix('"')
            .and_then(|inner| inner.strip_suffix('"'))
            .unwrap_or(text);
        shortened(text)
    }

    fn note_place(&self, path: &KeyPath, place: Place) {
        self.places.borrow_mut().insert(path.clone(), place);
    }

    /// Redirects messages about the table at one path to another path.
    fn alias(&self, known: KeyPath, written: KeyPath) {
        self.aliases.borrow_mut().push((known, written));
    }

    /// Records a value.
    pub(crate) fn record(&self, path: &KeyPath, value: Json) {
        let mut slot = &mut *self.json.borrow_mut();
        for step in path.steps() {
            slot = match step {
                Step::Key(key) => {
                    if !slot.is_object() {
                        *slot = Json::Object(Map::new());
                    }
                    let Json::Object(members) = slot else { return };
                    members.entry(key.clone()).or_insert(Json::Null)
                }
                Step::Index(index) => {
                    if !slot.is_array() {
                        *slot = Json::Array(Vec::new());
                    }
                    let Json::Array(items) = slot else { return };
                    if items.len() <= *index {
                        items.resize(index + 1, Json::Null);
                    }
                    &mut items[*index]
                }
            };
        }
        *slot = value;
    }

    /// Returns the number that was recorded at a path.
    fn number(&self, path: &KeyPath) -> Option<f64> {
        let pointer: String = path.steps().iter().map(|step| format!("/{step}")).collect();
        self.json.borrow().pointer(&pointer)?.as_f64()
    }

    /// Returns problems and record.
    pub(crate) fn close(self) -> Closed {
        let mut problems = self.problems.into_inner();
        let misspelt = self.misspelt.into_inner();
        problems.retain(|problem| match problem.subject() {
            Fault::MissingKey { key, table, .. } => {
                !misspelt.contains(&(key.clone(), table.clone()))
            }
            Fault::MissingChoice { table, allowed } => {
                let is_misspelt = |key: &String| misspelt.contains(&(key.clone(), table.clone()));
                !allowed.iter().any(is_misspelt)
            }
            _ => true,
        });
        Closed {
            problems,
            record: Record {
                sources: self.sources,
                places: self.places.into_inner(),
                aliases: self.aliases.into_inner(),
                json: self.json.into_inner(),
            },
            survey: self.survey.map(RefCell::into_inner).unwrap_or_default(),
        }
    }
}

/// Result of reading: problems and record.
pub(crate) struct Closed {
    pub(crate) problems: Vec<Problem>,
    pub(crate) record: Record,
    pub(crate) survey: Survey,
}

/// Locations and values of a deck that was read.
#[derive(Debug, Clone, Default)]
pub(crate) struct Record {
    pub(crate) sources: Sources,
    places: BTreeMap<KeyPath, Place>,
    /// Paths in messages, with the paths of their tables in the text.
    aliases: Vec<(KeyPath, KeyPath)>,
    pub(crate) json: Json,
}

impl Record {
    /// Returns the location of the first of several values that the deck sets, otherwise where the last one is missing.
    pub(crate) fn place_of_any(&self, paths: &[KeyPath]) -> Place {
        let given = paths.iter().find(|path| self.is_given(path));
        given
            .or(paths.last())
            .map_or_else(Place::default, |path| self.place(path))
    }

    /// Returns the location of a value, or of the table that requires it.
    pub(crate) fn place(&self, path: &KeyPath) -> Place {
        let mut path = path.clone();
        loop {
            if let Some(place) = self.given(&path) {
                return place;
            }
            match path.parent() {
                Some(parent) => path = parent,
                None => return Place::default(),
            }
        }
    }

    /// Returns whether the deck sets a value instead of using its default.
    pub(crate) fn is_given(&self, path: &KeyPath) -> bool {
        self.given(path).is_some()
    }

    fn given(&self, path: &KeyPath) -> Option<Place> {
        let aliases = self.aliases.iter();
        let mut others = aliases.filter_map(|(known, written)| path.moved(known, written));
        let own = self.places.get(path).copied();
        own.or_else(|| others.find_map(|path| self.places.get(&path).copied()))
    }
}
