//! `[[assign]]`: materials and relative stiffnesses of sets of points.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;
use crate::set::SetNames;
use crate::vocabulary::ASSIGNED;

/// Material or relative stiffness of sets of points. Later assignments replace earlier ones, separately for
/// material and stiffness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Assignment {
    /// Names of the sets, at least one.
    pub sets: Vec<String>,
    /// Name of the material, if one is assigned: the name of an entry of [`Model::materials`](crate::Model::materials), or
    /// [`Material::name`](method@crate::Material::name) of the body's material.
    #[serde(default)]
    pub material: Option<String>,
    /// Stiffness relative to the point's material, if it is assigned; a bond has the mean of its end points.
    /// Density and critical stretch are unchanged.
    #[serde(default)]
    pub stiffness: Option<f64>,
}

/// Kinds of assignment that a body allows.
pub(crate) enum Assignable<'m> {
    /// Bond-based materials with these names, and stiffnesses.
    Bonds(&'m [String]),
    /// State-based or correspondence materials with these names.
    StateBased(&'m [String]),
    /// Stiffnesses only.
    Surface,
}

pub(crate) fn read(
    table: Table<'_>,
    assignable: &Assignable<'_>,
    sets: &SetNames,
) -> Option<Assignment> {
    let place = table
        .required("set")
        .and_then(|item| sets.references(&item));
    if !ASSIGNED.iter().any(|key| table.has(key)) {
        table.requires_one_of(ASSIGNED);
    }
    let material = match assignable {
        Assignable::Surface => {
            table.forbid("material", "a 2-manifold has one material; set `stiffness`");
            Some(None)
        }
        Assignable::Bonds(names) | Assignable::StateBased(names) => {
            table.maybe("material", |item| {
                let name = item.text()?;
                if names.contains(&name) {
                    return Some(name);
                }
                item.unknown_word("material", &name, names.iter().map(String::as_str));
                None
            })
        }
    };
    let stiffness = match assignable {
        Assignable::StateBased(_) => {
            table.forbid(
                "stiffness",
                "it scales the bond constant, which state-based and correspondence materials do not have; assign a material with other elastic constants",
            );
            Some(None)
        }
        _ => table.maybe("stiffness", |item| item.positive(Quantity::Number)),
    };
    table.finish();
    Some(Assignment {
        sets: place?,
        material: material?,
        stiffness: stiffness?,
    })
}
