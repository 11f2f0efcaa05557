//! Cross-section and stress state of a body, which depend on its dimension.

use pericles::material::StressState;

use crate::quantity::Quantity;
use crate::reader::Table;

const AREA: &str = "Bar: cross-sectional area. With 1 m², the default, forces, energies, momenta and masses are reported per square metre (N/m2, J/m2).";
const THICKNESS: &str = "Thickness of a plate, disc, outline or plane mesh. With 1 m, the default, forces, energies, momenta and masses are reported per metre of thickness (N/m, J/m).";

/// Reads the area of a bar or the thickness of a plate; 1 in 3D.
pub(super) fn section(table: &Table<'_>, dimension: Option<usize>) -> Option<f64> {
    table.describe("area", AREA);
    table.describe("thickness", THICKNESS);
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

/// Reads the stress state.
pub(super) fn state(table: &Table<'_>, dimension: Option<usize>) -> Option<StressState> {
    table.describe(
        "plane",
        "Plane stress or plane strain. Required for 2D bodies.",
    );
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
