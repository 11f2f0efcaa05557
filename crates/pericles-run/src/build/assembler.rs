//! The assembler of a model.

use pericles::family::{Crack, EndRule};
use pericles::space::PointSet;
use pericles_deck::{BuildError, Fault, Keys, Model};

use super::discretisation::Sets;
use super::property::{CONSTANT, Properties};
use super::rejection::at_path;

/// Builds the parts of an assembly; the modules of this folder add methods.
#[derive(Clone, Copy)]
pub(super) struct Assembler<'a> {
    pub(super) model: &'a Model,
    /// The pre-cracks; empty before they are read.
    pub(super) cracks: &'a [(Crack, EndRule)],
    /// Properties of the materials that are functions.
    pub(super) properties: &'a Properties,
}

impl<'a> Assembler<'a> {
    /// Creates the assembler of a model whose pre-cracks are not yet read.
    pub(super) fn new(model: &'a Model) -> Self {
        Self {
            model,
            cracks: &[],
            properties: &CONSTANT,
        }
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
