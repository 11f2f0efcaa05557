//! `[sets.NAME]`: named sets of points, and the use of their names.

use pericles::space::Region;

use crate::fault::Fault;
use crate::reader::{Item, Table};
use crate::region::{self, Frame};

/// The name of the set of all points, which is always there.
pub const ALL: &str = "all";

/// A named set of points.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedSet {
    /// Its name.
    pub name: String,
    /// Where its points lie.
    pub region: Region,
}

/// The names that may be used, whether or not their regions could be read.
pub(crate) struct SetNames(Vec<String>);

impl SetNames {
    /// A name that must be defined.
    pub(crate) fn reference(&self, item: &Item<'_>) -> Option<String> {
        let name = item.text()?;
        if self.0.contains(&name) {
            return Some(name);
        }
        item.unknown_word("set", &name, self.0.iter().map(String::as_str));
        None
    }

    /// A list of names that must be defined; a single name may stand without brackets.
    pub(crate) fn references(&self, item: &Item<'_>) -> Option<Vec<String>> {
        if item.word().is_some() {
            return Some(vec![self.reference(item)?]);
        }
        let names: Vec<Option<String>> = item
            .list("a list of names of sets")?
            .iter()
            .map(|name| self.reference(name))
            .collect();
        names.into_iter().collect()
    }
}

pub(crate) fn read(table: Option<Table<'_>>, frame: Frame) -> (Option<Vec<NamedSet>>, SetNames) {
    let mut names = SetNames(vec![ALL.into()]);
    let mut sets = Some(Vec::new());
    for (name, place, item) in table.iter().flat_map(Table::named) {
        if let Some(fault) = bad_name(name) {
            table
                .iter()
                .for_each(|table| table.report_at(place, fault()));
            sets = None;
        }
        names.0.push(name.into());
        let region = item.table().and_then(|table| region::read(table, frame));
        match (region, &mut sets) {
            (Some(region), Some(sets)) => sets.push(NamedSet {
                name: name.into(),
                region,
            }),
            _ => sets = None,
        }
    }
    (sets, names)
}

/// Why a name cannot be used for a set or a probe: it becomes part of a column's name in tables.
pub(crate) fn bad_name(name: &str) -> Option<impl Fn() -> Fault + use<>> {
    let reason = if name == ALL {
        "it always means all points"
    } else if name.is_empty() {
        "it is empty"
    } else if name.contains(|c: char| c.is_control() || matches!(c, ',' | ';' | '"' | '\'')) {
        "it holds a comma, a semicolon, a quotation mark or a control character"
    } else {
        return None;
    };
    let name = name.to_owned();
    Some(move || Fault::BadName {
        name: name.clone(),
        reason,
        allowed: "allowed: any other text, such as \"left_edge\"",
    })
}
