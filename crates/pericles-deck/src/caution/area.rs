//! Doubts about the area that a traction acts on.

use crate::wording::short;

/// Why the area that is seen along an axis may not be that of the face meant.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum AreaDoubt {
    /// The set is thinner along another axis.
    Thinner {
        /// The axis along which the area is seen.
        axis: usize,
        /// That area, m².
        area: f64,
        /// The axis along which the set is thinner.
        other: usize,
        /// The area seen along that one, m².
        face: f64,
    },
    /// The set has parts that hide each other, or reaches much deeper in some places than in most.
    Parts {
        /// The axis along which the area is seen.
        axis: usize,
        /// That area, m².
        area: f64,
    },
}

pub(super) fn doubtful_area(doubt: &AreaDoubt) -> String {
    let name = |axis: &usize| ['x', 'y', 'z'][*axis];
    match doubt {
        AreaDoubt::Thinner {
            axis,
            area,
            other,
            face,
        } => format!(
            "this traction acts on {}, the set as seen along {}; the set is a layer normal to {}, whose face has {}",
            square_millimetres(*area),
            name(axis),
            name(other),
            square_millimetres(*face)
        ),
        AreaDoubt::Parts { axis, area } => format!(
            "the set of this traction is not one layer on one face: the force on {}, the set as seen along {}, is spread over all its points",
            square_millimetres(*area),
            name(axis)
        ),
    }
}

/// An area with four digits.
fn square_millimetres(area: f64) -> String {
    format!("{} mm²", short(1e6 * area))
}
