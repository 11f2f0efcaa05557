//! Properties that all materials of a body share.

use super::types::{Material, MaterialModel};

/// Returns the first shared key in which two materials of a body differ.
///
/// A bond belongs to both of its end points, so that it has one law and one influence function. Density,
/// elastic constants, failure and the horizon of bond-based materials may differ. All state-based materials
/// of a body have the same horizon, because the weighted volume of a point is a sum over its family.
pub(crate) fn difference(a: &MaterialModel, b: &MaterialModel) -> Option<&'static str> {
    let horizon =
        matches!(a, MaterialModel::StateBased(_)) && !same_length(a.horizon(), b.horizon());
    let correction = a.volume_correction() != b.volume_correction();
    let (law, influence) = match (a, b) {
        (MaterialModel::Bonds(a), MaterialModel::Bonds(b)) => {
            (a.law != b.law, a.influence != b.influence)
        }
        (MaterialModel::StateBased(a), MaterialModel::StateBased(b)) => {
            let influence = a.solid.influence != b.solid.influence;
            (a.strains != b.strains, influence)
        }
        (MaterialModel::Correspondence(a), MaterialModel::Correspondence(b)) => {
            let influence = a.solid.influence != b.solid.influence;
            (a.stabilisation != b.stabilisation, influence)
        }
        _ => return Some("model"),
    };
    let law_key = match (a.name() == b.name(), a) {
        (false, _) => "model",
        (true, MaterialModel::Bonds(_)) => "approximation",
        (true, MaterialModel::StateBased(_)) => "strains",
        (true, MaterialModel::Correspondence(_)) => "stabilisation",
    };
    let keys = [
        (law, law_key),
        (horizon, "horizon"),
        (influence, "influence"),
        (correction, "volume_correction"),
    ];
    first(&keys)
}

/// Returns the first shared key in which the tables of two materials differ.
pub(super) fn difference_of_tables(a: &Material, b: &Material) -> Option<&'static str> {
    let keys = [
        (
            a.surface_correction != b.surface_correction,
            "surface_correction",
        ),
        (a.no_fail != b.no_fail, "no_fail"),
        (a.scatter != b.scatter, "scatter"),
        (
            a.strength_surface.is_some() != b.strength_surface.is_some(),
            "failure",
        ),
        (a.softening != b.softening, "softening"),
        (a.damage != b.damage, "damage"),
        (a.form != b.form, "bonds"),
    ];
    difference(&a.model, &b.model).or_else(|| first(&keys))
}

fn first(keys: &[(bool, &'static str)]) -> Option<&'static str> {
    let found = keys.iter().find(|(differs, _)| *differs);
    found.map(|(_, key)| *key)
}

/// Returns whether two lengths are equal up to rounding, such as a length and a multiple of the spacing.
pub(super) fn same_length(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * a.abs().max(b.abs())
}
