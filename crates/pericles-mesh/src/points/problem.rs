//! Errors and warnings about a mesh.

use std::fmt;

use crate::cell::CellKind;
use crate::digits::short;
use crate::raw::InvalidMesh;

/// Size and centroid of an element, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementSize {
    /// The size, m.
    pub size: f64,
    /// The centroid, m.
    pub position: [f64; 3],
}

impl fmt::Display for ElementSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.position.map(short);
        write!(f, "{} m at ({x}, {y}, {z})", short(self.size))
    }
}

fn list(names: &[String]) -> String {
    match names {
        [] => "no groups".to_owned(),
        _ => names.join(", "),
    }
}

fn kind_list(counts: &[(CellKind, usize)]) -> String {
    let words = counts
        .iter()
        .map(|(kind, count)| format!("{count} {}", kind.word(*count)));
    match counts {
        [] => "no elements (if there are physical groups, Gmsh saves only their elements: add the volume to a group, or set Mesh.SaveAll)".to_owned(),
        _ => words.collect::<Vec<_>>().join(", ") + " only",
    }
}

fn corner_list(corners: &[[f64; 3]]) -> String {
    let words = corners.iter().map(|x| {
        let [x, y, z] = x.map(short);
        format!("({x}, {y}, {z})")
    });
    words.collect::<Vec<_>>().join(" ")
}

/// Error or warning about a mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// Numbers or coordinates that do not define a mesh.
    #[error(transparent)]
    Invalid(#[from] InvalidMesh),
    /// No elements that could become points.
    #[error(
        "the mesh has {}; elements of dimension 2 or 3, or points with volumes, are required",
        kind_list(kinds)
    )]
    NoElements {
        /// Number of cells of each type.
        kinds: Vec<(CellKind, usize)>,
    },
    /// A selected block that is not in the mesh.
    #[error("the mesh has no block {name:?}; available: {}", list(known))]
    UnknownBlock {
        /// Its name.
        name: String,
        /// Names of all groups.
        known: Vec<String>,
    },
    /// An element whose volume is positive at one corner and negative at another.
    #[error(
        "element {number} ({kind}) is folded (inverted at some of its corners): its corners are {}",
        corner_list(corners)
    )]
    Folded {
        /// Number of the element in the file.
        number: u64,
        /// Its type.
        kind: CellKind,
        /// Its corners, in the units of the file.
        corners: Vec<[f64; 3]>,
    },
    /// Elements without volume.
    #[error("{count} element(s) have zero volume, the first is element {first}")]
    NoVolume {
        /// Number of the first one in the file.
        first: u64,
        /// Number of such elements.
        count: usize,
    },
    /// A plane mesh with several values of z.
    #[error("the mesh consists of triangles and quadrilaterals with z from {} to {}; a plane mesh must lie in a plane of constant z, a solid mesh needs solid elements", short(*low), short(*high))]
    NotPlane {
        /// Minimum of z, in the units of the file.
        low: f64,
        /// Maximum of z.
        high: f64,
    },
    /// Warning: elements larger than half the horizon.
    #[error("the horizon of {} m spans fewer than 2 elements: the element sizes range from {smallest} to {largest}; refine the mesh, or choose a horizon of at least twice the largest size", short(*horizon))]
    Coarse {
        /// Smallest element.
        smallest: ElementSize,
        /// Largest element.
        largest: ElementSize,
        /// Horizon, m.
        horizon: f64,
    },
    /// Warning: elements of very different size.
    #[error(
        "the element sizes range from {smallest} to {largest}, a ratio above 8 : 1; make the mesh more uniform"
    )]
    Graded {
        /// Smallest element.
        smallest: ElementSize,
        /// Largest element.
        largest: ElementSize,
    },
    /// Warning: a body of unlikely size.
    #[error("the largest side of the mesh is {} m; check the unit of the file", short(*side))]
    ImplausibleUnit {
        /// Largest side, m.
        side: f64,
    },
    /// Warning: a set with the reserved name.
    #[error(
        "the set {name:?} of the mesh is available as {other:?}, because {name:?} is the set of all points"
    )]
    ReservedName {
        /// Its name in the file.
        name: String,
        /// Its name in decks.
        other: String,
    },
    /// Warning: faces of a set that do not belong to any point.
    #[error("{count} face(s) of the set {name:?} do not belong to any element")]
    UnownedFaces {
        /// Name of the set.
        name: String,
        /// Number of such faces.
        count: usize,
    },
}
