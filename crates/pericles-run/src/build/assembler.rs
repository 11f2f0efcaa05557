//! The assembler of a model.

use std::cell::RefCell;

use pericles::family::{Crack, EndRule};
use pericles::space::PointSet;
use pericles_deck::{BuildError, Caution, Fault, Keys, Model, ModelWarning, Remark};

use super::discretisation::Sets;
use super::property::{CONSTANT, Properties};
use super::rejection::at_path;

/// The warnings of a build in the order in which they are found, with key, kind and advice.
#[derive(Debug, Default)]
pub(super) struct Warnings(RefCell<Vec<ModelWarning>>);

impl Warnings {
    /// Adds warnings.
    pub(super) fn extend(&self, found: impl IntoIterator<Item = ModelWarning>) {
        // Finding them may add others.
        let found: Vec<ModelWarning> = found.into_iter().collect();
        self.0.borrow_mut().extend(found);
    }

    /// Takes all warnings.
    pub(super) fn taken(&self) -> Vec<ModelWarning> {
        self.0.take()
    }
}

/// Builds the parts of an assembly; the modules of this folder add methods.
#[derive(Clone, Copy)]
pub(super) struct Assembler<'a> {
    pub(super) model: &'a Model,
    /// The pre-cracks; empty before they are read.
    pub(super) cracks: &'a [(Crack, EndRule)],
    /// Properties of the materials that are functions.
    pub(super) properties: &'a Properties,
    pub(super) warnings: &'a Warnings,
}

impl<'a> Assembler<'a> {
    /// Creates the assembler of a model whose pre-cracks are not yet read.
    pub(super) fn new(model: &'a Model, warnings: &'a Warnings) -> Self {
        Self {
            model,
            cracks: &[],
            properties: &CONSTANT,
            warnings,
        }
    }

    /// Adds a warning about a value.
    pub(super) fn warn(&self, keys: impl Into<Keys>, caution: Caution) {
        self.warnings.extend([Remark::new(keys, caution)]);
    }

    /// Returns the points of a set. A model from a deck refers only to sets that it defines; one built by a program
    /// may not.
    pub(super) fn members<'s>(
        self,
        sets: &'s Sets,
        name: &str,
        path: impl Into<Keys>,
    ) -> Result<&'s PointSet, BuildError> {
        let found = sets.iter().find(|(known, _)| known == name);
        found.map(|(_, points)| points).ok_or_else(|| {
            let known = sets.iter().map(|(known, _)| known.as_str());
            at_path(path, Fault::unknown_word("set", name, known))
        })
    }
}
