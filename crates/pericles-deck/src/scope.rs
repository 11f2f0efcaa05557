//! Scope of declared tables: what their keys depend on in addition to the keys above them.

use crate::component::Variables;
use crate::course::TimeHistory;
use crate::declaration::Spatial;
use crate::property::PropertyScope;
use crate::reader::Item;
use crate::set::{SetNames, bad_name};

/// The body and the names to which the tables of a deck refer.
#[derive(Clone, Copy)]
pub(crate) struct Scope<'s> {
    /// Dimension of the body; none if another error makes it unknown.
    pub(crate) dimension: Option<usize>,
    /// Names of the sets.
    pub(crate) sets: &'s SetNames,
    /// Names of the materials.
    pub(crate) materials: &'s [String],
    /// Time function of loads and displacements without one.
    pub(crate) usual: &'s TimeHistory,
}

impl Scope<'_> {
    /// Calls `with` with the scope of a model made by a program, whose names are checked when it is built.
    pub(crate) fn of_model(dimension: usize, with: impl FnOnce(Scope<'_>)) {
        with(Scope {
            dimension: Some(dimension),
            sets: &SetNames::any(),
            materials: &[],
            usual: &TimeHistory::Constant,
        });
    }

    /// Returns the scope of expressions of position, and of time if `time`.
    pub(crate) fn variables(self, time: bool) -> Variables {
        Variables {
            dimension: self.dimension,
            time,
        }
    }

    /// Returns the scope of properties of materials that may be functions of position.
    pub(crate) fn of_place(self) -> PropertyScope {
        PropertyScope {
            dimension: self.dimension,
            temperature: false,
        }
    }
}

impl Spatial for Scope<'_> {
    fn dimension(&self) -> Option<usize> {
        self.dimension
    }
}

/// Reads a name that becomes part of column names.
pub(crate) fn name<S>(item: &Item<'_>, _: S) -> Option<String> {
    let name = item.text()?;
    match bad_name(&name) {
        Some(fault) => {
            item.report(fault());
            None
        }
        None => Some(name),
    }
}

/// Reads the name of a set.
pub(crate) fn set_name(item: &Item<'_>, scope: Scope<'_>) -> Option<String> {
    scope.sets.reference(item)
}

/// Reads the name of a material.
pub(crate) fn material_name(item: &Item<'_>, scope: Scope<'_>) -> Option<String> {
    let name = item.text()?;
    if scope.materials.contains(&name) {
        return Some(name);
    }
    let names = scope.materials.iter().map(String::as_str);
    item.unknown_word("material", &name, names);
    None
}
