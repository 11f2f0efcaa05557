//! Section and state of stress of a body, which depend on its dimension.

use pericles::material::StressState;

use crate::quantity::Quantity;
use crate::reader::Table;

/// Area of a bar, thickness of a plate, 1 in three dimensions.
pub(super) fn section(table: &Table<'_>, dimension: usize) -> Option<f64> {
    if dimension != 1 {
        table.forbid("area", "only a bar has an area");
    }
    if dimension != 2 {
        table.forbid(
            "thickness",
            "only bodies of two dimensions (plate, disc) have a thickness",
        );
    }
    match dimension {
        1 => table.or("area", 1.0, |item| item.positive(Quantity::Area)),
        2 => table.or("thickness", 1.0, |item| item.positive(Quantity::Length)),
        _ => Some(1.0),
    }
}

pub(super) fn state(table: &Table<'_>, dimension: usize) -> Option<StressState> {
    const PLANES: [(&str, StressState); 2] = [
        ("stress", StressState::PlaneStress),
        ("strain", StressState::PlaneStrain),
    ];
    if dimension == 2 {
        return table
            .required("plane")
            .and_then(|item| item.choice("state of the plane", &PLANES));
    }
    table.forbid(
        "plane",
        "only bodies of two dimensions (plate, disc) are in plane stress or plane strain",
    );
    Some(if dimension == 1 {
        StressState::Uniaxial
    } else {
        StressState::Spatial
    })
}
