//! `[[output.profile]]`: a field along a straight line at the end of a run.

use pericles::observe::Field;
use pericles::space::Point;
use pericles_deck_derive::DeckTable;
use serde::{Deserialize, Serialize};

use super::{check_component, field_component, unit_of, whole_field};
use crate::component::{Component, Variables};
use crate::fault::Fault;
use crate::reader::Item;

/// Fields along straight lines at the end of the run, each a table `profile_<name>.csv` and a chart `profile_<name>.png`;
/// any number. The points within half a spacing of the line count; those at the same distance along it are averaged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = Variables, unique("name", "profile"))]
pub struct Profile {
    /// The name, part of the file names: letters, digits, `_` and `-`.
    #[deck(with = name)]
    pub name: String,
    /// The field; vectors by magnitude and tensors by norm, or one of their components.
    #[serde(with = "crate::form")]
    #[deck(with = whole_field)]
    pub field: Field,
    /// Component of a vector; its magnitude if none.
    #[serde(default)]
    #[deck(
        flatten,
        keys(),
        with = field_component,
        scope = (field, scope),
        check = check_component
    )]
    pub component: Option<usize>,
    /// Where the line begins.
    ///
    /// In m.
    #[deck(quantity = Length)]
    pub from: Point,
    /// Where the line ends.
    ///
    /// In m.
    #[deck(
        quantity = Length,
        allow_if(
            from != to,
            "a place other than `from`: the profile is taken along the line between them"
        )
    )]
    pub to: Point,
    /// A known solution, drawn beside the field: a value in the field's unit, or an expression of the place and the time.
    #[serde(default)]
    #[deck(quantity = unit_of(field))]
    pub reference: Option<Component>,
}

/// Reads a name that is part of the name of a file.
fn name(item: &Item<'_>, _: Variables) -> Option<String> {
    let name = item.text()?;
    /// Maximum length; file systems allow 255 bytes for the name of the file.
    const LONGEST: usize = 120;
    let usable = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    if !name.is_empty() && name.len() <= LONGEST && name.chars().all(usable) {
        return Some(name);
    }
    item.report(Fault::BadName {
        name,
        reason: "it is part of a file's name",
        allowed: "allowed: at most 120 letters, digits, `_` and `-`, a name of its own for each profile",
    });
    None
}
