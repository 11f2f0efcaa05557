//! Range checks of models made by programs. Decks are checked while they are read.

mod body;
mod conditions;
mod contact;
mod course;
mod ranges;

use self::ranges::Check;
use crate::key_path::KeyPath;
use crate::model::{Body, Model};
use crate::remark::BuildError;
use crate::set::Members;

impl Model {
    /// Rejects numbers out of range. Decks have the same ranges, so that a model read from a deck always passes.
    ///
    /// # Errors
    /// All numbers out of range, with their keys.
    pub fn check(&self) -> Result<(), BuildError> {
        let mut check = Check::default();
        let body = KeyPath::from("body");
        match &self.body {
            Body::Solid(solid) => check.solid(&body, solid),
            Body::Surface(surface) => check.surface(surface),
        }
        check.several(self);
        for set in &self.sets {
            if let Members::Region(region) = &set.members {
                check.region(&KeyPath::from("sets").key(&set.name), region);
            }
        }
        check.conditions(self);
        check.contact(self);
        check.thermal(self);
        check.damping(self);
        check.boundaries(&self.boundaries);
        if let Some(exact) = &self.exact {
            check.exact(exact);
        }
        check.time(&self.time);
        check.output(&self.output, self.body.dimension().clamp(1, 3));
        check.checkpoint(self.checkpoint);
        match check.problems.is_empty() {
            true => Ok(()),
            false => Err(BuildError::of(check.problems)),
        }
    }
}
