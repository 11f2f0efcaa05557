//! Warnings about the area on which a traction acts.

use crate::wording::short;

/// Reasons why the projected area of a set may differ from the area of the intended face.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum AreaCaution {
    /// The set is thinner along another axis.
    Thinner {
        /// The axis of projection.
        axis: usize,
        /// The projected area, m².
        area: f64,
        /// The axis along which the set is thinner.
        other: usize,
        /// The area projected along that axis, m².
        face: f64,
    },
    /// The set has parts that overlap in the projection, or is much thicker in some places than in most.
    Parts {
        /// The axis of projection.
        axis: usize,
        /// The projected area, m².
        area: f64,
    },
}

pub(super) fn area_caution(caution: &AreaCaution) -> String {
    let name = |axis: &usize| ['x', 'y', 'z'][*axis];
    match caution {
        AreaCaution::Thinner {
            axis,
            area,
            other,
            face,
        } => format!(
            "this traction acts on {}, the area of the set projected along {}; the set is a layer normal to {}, whose face has {}",
            square_millimetres(*area),
            name(axis),
            name(other),
            square_millimetres(*face)
        ),
        AreaCaution::Parts { axis, area } => format!(
            "the set of this traction is not a single layer on one face: the force on {}, the area of the set projected along {}, is distributed over all its points",
            square_millimetres(*area),
            name(axis)
        ),
    }
}

/// An area in mm² with four digits.
fn square_millimetres(area: f64) -> String {
    format!("{} mm²", short(1e6 * area))
}
