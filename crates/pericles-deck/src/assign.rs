//! `[[assign]]`: materials and relative stiffnesses of sets of points.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;
use crate::set::SetNames;
use crate::vocabulary::ASSIGNED;

/// What the points of some sets have in place of the body's. Later assignments replace earlier ones, each for what it gives.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Assignment {
    /// The sets, at least one.
    pub sets: Vec<String>,
    /// The name of their material, if it is assigned: that of an entry of [`Model::materials`](crate::Model::materials), or
    /// [`Material::name`](method@crate::Material::name) of the body's.
    #[serde(default)]
    pub material: Option<String>,
    /// Stiffness over that of the points' material, if it is assigned; a bond has the mean of its ends. Density and critical stretch are the material's.
    #[serde(default)]
    pub stiffness: Option<f64>,
}

/// What may be assigned to the points of a body.
pub(crate) enum Assignable<'m> {
    /// Bond-based materials of these names, and stiffnesses.
    Bonds(&'m [String]),
    /// State-based or correspondence materials of these names.
    StateBased(&'m [String]),
    /// Stiffnesses.
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
        table.lacks_one_of(ASSIGNED);
    }
    let material = match assignable {
        Assignable::Surface => {
            table.forbid("material", "a surface has one material; give `stiffness`");
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
                "it scales the constant of bonds, which state-based and correspondence materials do not have; assign a material with elastic constants of its own",
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
