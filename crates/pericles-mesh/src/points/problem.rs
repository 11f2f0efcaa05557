//! What can be wrong with a mesh, as errors and warnings.

use std::fmt;

use crate::cell::CellKind;
use crate::digits::short;
use crate::raw::InvalidMesh;

/// An element's size and centroid, m.
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
        [] => "no elements (Gmsh saves only elements in physical groups once there is a group: add the volume to one, or set Mesh.SaveAll)".to_owned(),
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

/// What is wrong with a mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// Numbers or coordinates that make no mesh.
    #[error(transparent)]
    Invalid(#[from] InvalidMesh),
    /// There is nothing that could become points.
    #[error(
        "the mesh has {}; elements of dimension 2 or 3, or points with volumes, are needed",
        kind_list(kinds)
    )]
    NoElements {
        /// The number of cells of every kind.
        kinds: Vec<(CellKind, usize)>,
    },
    /// A block that is asked for is not in the mesh.
    #[error("the mesh has no block {name:?}; it has {}", list(known))]
    UnknownBlock {
        /// The name.
        name: String,
        /// The names of all groups.
        known: Vec<String>,
    },
    /// The volume of an element is positive at one corner and negative at another.
    #[error(
        "element {number} ({kind}) is folded: its corners are {}",
        corner_list(corners)
    )]
    Folded {
        /// The number of the element in the file.
        number: u64,
        /// Its kind.
        kind: CellKind,
        /// Its corners, in the file's unit.
        corners: Vec<[f64; 3]>,
    },
    /// Elements without volume.
    #[error("{count} element(s) have no volume, the first of them element {first}")]
    NoVolume {
        /// The number of the first one in the file.
        first: u64,
        /// How many there are.
        count: usize,
    },
    /// A plane mesh with several z.
    #[error("the mesh consists of triangles and quadrilaterals with z from {} to {}; a plane mesh must lie in a plane of constant z, a solid one have solid elements", short(*low), short(*high))]
    NotPlane {
        /// The smallest z, in the file's unit.
        low: f64,
        /// The largest z.
        high: f64,
    },
    /// Elements larger than half the horizon. A warning.
    #[error("fewer than 2 cells in a horizon of {} m: the elements have sizes from {smallest} to {largest}; refine the mesh, or choose a horizon of at least twice the largest size", short(*horizon))]
    Coarse {
        /// The smallest element.
        smallest: ElementSize,
        /// The largest element.
        largest: ElementSize,
        /// The horizon, m.
        horizon: f64,
    },
    /// Elements too different in size. A warning.
    #[error(
        "the elements have sizes from {smallest} to {largest}, which differ more than 8 : 1; make the mesh more uniform"
    )]
    Graded {
        /// The smallest element.
        smallest: ElementSize,
        /// The largest element.
        largest: ElementSize,
    },
    /// A body of unlikely size. A warning.
    #[error("the largest side of the mesh is {} m: is the unit of the file right?", short(*side))]
    DoubtfulUnit {
        /// The largest side, m.
        side: f64,
    },
    /// Faces of a set that belong to no point. A warning.
    #[error("{count} face(s) of the set {name:?} belong to no element")]
    UnownedFaces {
        /// The name of the set.
        name: String,
        /// How many there are.
        count: usize,
    },
}
