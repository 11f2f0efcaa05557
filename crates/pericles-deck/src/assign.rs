//! `[[assign]]`: materials and relative stiffnesses of sets of points.

use pericles_deck_derive::DeckTable;
use serde::{Deserialize, Serialize};

use crate::reader::Item;
use crate::scope::Scope;

/// Material or relative stiffness of a set of points. Any number of tables; later ones replace earlier ones, separately for
/// `material` and `stiffness`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = AssignScope<'s>, at_least_one("material", "stiffness"))]
pub struct Assignment {
    /// Set, or list of sets, of points.
    ///
    /// At least one name.
    #[deck(key = "set", required, with = set_names)]
    pub sets: Vec<String>,
    /// Name of the material: a table of `[materials]`, the `name` of `[material]`, or "default" if it has no name.
    #[serde(default)]
    #[deck(
        with = material_name,
        forbid_if(
            scope.of == Assignable::Stiffness,
            "a 2-manifold has one material; set `stiffness`"
        )
    )]
    pub material: Option<String>,
    /// Stiffness relative to the point's material; a bond has the mean of its end points. Density and critical stretch do
    /// not change. Bond-based materials and 2-manifolds only.
    #[serde(default)]
    #[deck(range = POSITIVE, forbid_if(scope.of == Assignable::Material, NO_STIFFNESS))]
    pub stiffness: Option<f64>,
}

/// What may be assigned to points of a body.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Assignable {
    /// Bond-based materials and stiffnesses.
    Both,
    /// State-based or correspondence materials.
    Material,
    /// Stiffnesses, for 2-manifolds.
    Stiffness,
}

/// Scope of `[[assign]]`.
#[derive(Clone, Copy)]
pub(crate) struct AssignScope<'s> {
    pub(crate) deck: Scope<'s>,
    pub(crate) of: Assignable,
}

/// Why points of some materials have no stiffness of their own.
const NO_STIFFNESS: &str = "it scales the bond constant, which state-based and correspondence materials do not have; assign a material with other elastic constants";

fn set_names(item: &Item<'_>, scope: AssignScope<'_>) -> Option<Vec<String>> {
    scope.deck.sets.references(item)
}

fn material_name(item: &Item<'_>, scope: AssignScope<'_>) -> Option<String> {
    crate::scope::material_name(item, scope.deck)
}
