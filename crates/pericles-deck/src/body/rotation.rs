//! Rotations of pieces and impactors.

use pericles_deck_derive::DeckTable;
use serde::{Deserialize, Serialize};

use crate::declaration::{Check, Spatial};
use crate::key_path::KeyPath;
use crate::reader::Item;
use crate::region;

/// Rotation about an axis. Pieces: applied to the points at their positions; rotated pieces use a neighbour list. Impactors:
/// about the centre of mass.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(define = "rotation", scope = RotationScope)]
pub struct Rotation {
    /// Angle, anticlockwise about the axis: "30 deg", or a number in radians.
    #[deck(quantity = Number)]
    pub angle: f64,
    /// Direction of the axis, of any length. 2D bodies rotate in their plane and have no axis.
    #[deck(
        with = axis,
        check = check_axis,
        default = [0.0, 0.0, 1.0],
        required_if(scope.dimension == Some(3)),
        forbid_if(scope.dimension == Some(2), "a 2D piece rotates in its plane")
    )]
    pub axis: [f64; 3],
    /// Pieces: a point on the axis. Default: the centre of the bounding box of the piece.
    ///
    /// In m.
    #[serde(default)]
    #[deck(
        quantity = Length,
        forbid_if(!scope.is_eccentric, "an impactor is rotated about its centre of mass")
    )]
    pub centre: Option<[f64; 3]>,
}

impl Rotation {
    /// Returns the matrix of the rotation by rows (formula of Rodrigues).
    pub fn matrix(&self) -> [[f64; 3]; 3] {
        let length = self.axis.iter().map(|a| a * a).sum::<f64>().sqrt();
        let a = self.axis.map(|entry| entry / length);
        let (sin, cos) = self.angle.sin_cos();
        std::array::from_fn(|r| {
            std::array::from_fn(|c| {
                let across = match (3 + c - r) % 3 {
                    0 => cos,
                    1 => -sin * a[3 - r - c],
                    _ => sin * a[3 - r - c],
                };
                across + (1.0 - cos) * a[r] * a[c]
            })
        })
    }
}

/// Scope of a rotation.
#[derive(Clone, Copy)]
pub(crate) struct RotationScope {
    /// Dimension of the body; none if another error makes it unknown.
    dimension: Option<usize>,
    /// Whether the axis may be anywhere.
    is_eccentric: bool,
}

impl RotationScope {
    pub(crate) fn of_piece(dimension: Option<usize>) -> Self {
        Self {
            dimension,
            is_eccentric: true,
        }
    }

    pub(crate) fn of_impactor(dimension: Option<usize>) -> Self {
        Self {
            dimension,
            is_eccentric: false,
        }
    }
}

impl Spatial for RotationScope {
    fn dimension(&self) -> Option<usize> {
        self.dimension
    }
}

fn axis(item: &Item<'_>, scope: RotationScope) -> Option<[f64; 3]> {
    region::direction(item, scope.dimension.or(Some(3)))
}

/// Checks that an axis has a direction.
pub(crate) fn check_axis<S>(axis: &[f64; 3], path: &KeyPath, _: S, check: &mut Check) {
    let right = axis.iter().any(|&x| x != 0.0) && axis.iter().all(|x| x.is_finite());
    check.within(right, path.key("axis"), "zero", "allowed: a nonzero vector");
}
