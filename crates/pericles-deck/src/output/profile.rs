//! `[[output.profile]]`: a field along a straight line at the end of a run.

use pericles::observe::Field;
use pericles::space::Point;
use serde::{Deserialize, Serialize};

use super::{field, quantity};
use crate::component::{Component, Variables, component};
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};

/// A field, or a component of it, along a straight line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// The name, part of the names of its files.
    pub name: String,
    /// The field.
    #[serde(with = "crate::form")]
    pub field: Field,
    /// Which component of a vector; its magnitude if none.
    #[serde(default)]
    pub component: Option<usize>,
    /// Where the line begins, m.
    pub from: Point,
    /// Where it ends, m.
    pub to: Point,
    /// A known solution, drawn beside it.
    #[serde(default)]
    pub reference: Option<Component>,
}

/// All profiles of a deck.
pub(super) fn read(tables: Vec<Table<'_>>, dimension: Option<usize>) -> Option<Vec<Profile>> {
    let mut names: Vec<String> = Vec::new();
    let profiles: Vec<Option<Profile>> = tables
        .into_iter()
        .map(|table| profile(table, dimension, &mut names))
        .collect();
    profiles.into_iter().collect()
}

fn profile(table: Table<'_>, dimension: Option<usize>, names: &mut Vec<String>) -> Option<Profile> {
    let name = table.required("name").and_then(|item| name(&item, names));
    let of = table
        .required("field")
        .and_then(|item| field(&item, dimension));
    let end = |key| {
        let item = table.required(key)?;
        let place = item.vector(Quantity::Length, dimension)?;
        Some((item, place))
    };
    let (from, to) = (end("from"), end("to"));
    let to = match (&from, to) {
        (Some((_, from)), Some((item, to))) if *from == to => {
            item.out_of_range(
                "a place other than `from`: the profile is taken along the line between them",
            );
            None
        }
        (_, to) => to,
    };
    let unit = of.map_or(Quantity::Number, |(field, _)| quantity(field));
    let variables = Variables {
        dimension,
        time: true,
    };
    let reference = table.maybe("reference", |item| component(&item, unit, variables));
    table.finish();
    let (field, component) = of?;
    Some(Profile {
        name: name?,
        field,
        component,
        from: from?.1,
        to: to?.1,
        reference: reference?,
    })
}

/// A name that is part of a file's.
fn name(item: &Item<'_>, names: &mut Vec<String>) -> Option<String> {
    let name = item.text()?;
    /// Maximum length; file systems allow 255 bytes for the name of the file.
    const LONGEST: usize = 120;
    let usable = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    let reason = if name.is_empty() || name.len() > LONGEST || !name.chars().all(usable) {
        Some("it is part of a file's name")
    } else if names.contains(&name) {
        Some("another profile has it")
    } else {
        None
    };
    names.push(name.clone());
    match reason {
        None => Some(name),
        Some(reason) => {
            item.report(Fault::BadName {
                name,
                reason,
                allowed: "allowed: at most 120 letters, digits, `_` and `-`, a name of its own for each profile",
            });
            None
        }
    }
}
