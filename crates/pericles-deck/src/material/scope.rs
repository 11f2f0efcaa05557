//! Scope of the keys of a material.

use pericles::material::StressState;

use crate::body::BodyRead;
use crate::reader::Table;
use crate::set::SetNames;
use crate::vocabulary::{BY_STATE, STRENGTHS};

/// Why bars have no Poisson's ratio.
pub(super) const BAR: &str =
    "the motion of a bar does not depend on Poisson's ratio; remove the key";

/// What the keys of a material depend on.
#[derive(Clone, Copy)]
pub(super) struct MaterialScope<'s> {
    pub(super) body: &'s BodyRead,
    pub(super) sets: &'s SetNames,
    /// Whether other materials inherit its shared keys.
    pub(super) is_shared: bool,
    /// Whether it is a table of `[materials]`.
    pub(super) is_named: bool,
    /// Word of `model`, which may be invalid; empty if it is missing.
    pub(super) model: &'s str,
    /// Word of `failure`, which may be invalid; empty if it is missing.
    pub(super) failure: &'s str,
    /// Whether a strength of its bonds is given.
    pub(super) breaks: bool,
}

impl<'s> MaterialScope<'s> {
    /// Returns the scope of a table.
    pub(super) fn of<'a: 's>(
        table: &Table<'a>,
        body: &'s BodyRead,
        sets: &'s SetNames,
        [is_shared, is_named]: [bool; 2],
    ) -> Self {
        let word = |key| table.word_of(key).unwrap_or_default();
        Self {
            body,
            sets,
            is_shared,
            is_named,
            model: word("model"),
            failure: word("failure"),
            breaks: STRENGTHS.iter().any(|key| table.has(key)),
        }
    }

    /// Returns the stress state; none if it is invalid.
    pub(super) fn state(self) -> Option<StressState> {
        self.body.state
    }

    /// Returns whether the body is a bar.
    pub(super) fn is_bar(self) -> bool {
        self.state() == Some(StressState::Uniaxial)
    }

    /// Returns whether points have a stress: whether it is a state-based or correspondence material.
    pub(super) fn is_solid(self) -> bool {
        ["state-based", "correspondence"].contains(&self.model)
    }

    /// Returns the key of the limit of bonds that break by stress or strain.
    pub(super) fn limit(self) -> Option<&'static str> {
        let found = BY_STATE.iter().find(|(word, _)| *word == self.failure);
        found.filter(|_| self.is_solid()).map(|(_, key)| *key)
    }
}
