//! `[[activation]]`: points that become part of the body during the run.

use std::path::{Path, PathBuf};

use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use crate::component::Component;
use crate::scope::{Scope, set_name};
use crate::set;

/// Points that become part of the body during the run, as in additive manufacturing. Any number of tables; later ones
/// replace earlier ones. Points in none of them belong to the body from the start. A point that is not active yet has no
/// bonds and does not move. When it becomes active, at the end of a step, it takes displacement and velocity of the affine
/// motion of the active points within the horizon, and its bonds to active points are free of stress at that time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = Scope<'s>)]
pub struct Activation {
    /// Set of points.
    #[deck(with = set_name, default = set::ALL.to_owned())]
    pub set: String,
    /// Time from which a point is active.
    #[deck(flatten)]
    pub start: ActivationStart,
    /// Temperature that a point takes when it becomes active, in bodies with heat conduction. Default: points keep their
    /// temperature.
    ///
    /// In K.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[deck(quantity = Temperature)]
    pub temperature: Option<f64>,
}

/// Time from which a point is active.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[deck(exclusive, scope = Scope<'s>)]
pub enum ActivationStart {
    /// Time from which a point is active, a number or an expression of x, y, z.
    ///
    /// In s.
    ActiveFrom(#[deck(quantity = Time, scope = scope.variables(false))] Component),
    /// Path of a source of material.
    Path {
        /// Text file with the path of a source of material: lines with a time (s) and the coordinates (m), in the order of
        /// time. The source moves on straight lines at constant speed; two lines with the same time are a jump. A point is
        /// active from the time at which the source is first within `radius`, and never if it stays farther away.
        ///
        /// A relative path starts at the deck's folder.
        path: PathBuf,
        /// Distance from the path within which points become active.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        radius: f64,
    },
}

impl Activation {
    /// Returns the file of the path, if the times follow from one.
    pub fn file(&self) -> Option<&Path> {
        match &self.start {
            ActivationStart::ActiveFrom(_) => None,
            ActivationStart::Path { path, .. } => Some(path),
        }
    }
}
