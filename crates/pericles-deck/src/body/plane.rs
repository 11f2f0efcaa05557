//! Cross-section and stress state of a body, which depend on its dimension.

use pericles::material::StressState;

use crate::quantity::Quantity;
use crate::reader::Table;

/// Reads the area of a bar or the thickness of a plate; 1 in 3D.
pub(super) fn section(table: &Table<'_>, dimension: Option<usize>) -> Option<f64> {
    let Some(dimension) = dimension else {
        table.know(&["area", "thickness"]);
        return None;
    };
    if dimension != 1 {
        table.forbid("area", "only a bar has an area");
    }
    if dimension != 2 {
        table.forbid("thickness", "only 2D bodies (plate, disc) have a thickness");
    }
    match dimension {
        1 => table.or("area", 1.0, |item| item.positive(Quantity::Area)),
        2 => table.or("thickness", 1.0, |item| item.positive(Quantity::Length)),
        _ => Some(1.0),
    }
}

pub(super) fn state(table: &Table<'_>, dimension: Option<usize>) -> Option<StressState> {
    let Some(dimension) = dimension else {
        table.know(&["plane"]);
        return None;
    };
    const PLANES: [(&str, StressState); 2] = [
        ("stress", StressState::PlaneStress),
        ("strain", StressState::PlaneStrain),
    ];
    if dimension == 2 {
        return table
            .required("plane")
            .and_then(|item| item.choice("plane state", &PLANES));
    }
    table.forbid(
        "plane",
        "plane stress and plane strain are for 2D bodies (plate, disc)",
    );
    Some(if dimension == 1 {
        StressState::Uniaxial
    } else {
        StressState::Spatial
    })
}
