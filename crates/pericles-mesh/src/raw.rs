//! Mesh of a file, unchanged.

use std::collections::BTreeMap;

use crate::cell::CellKind;

/// Cells of any type, in the order of the file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Cells {
    kinds: Vec<CellKind>,
    ends: Vec<usize>,
    corners: Vec<u32>,
    /// Numbers in the file; empty while they are 1, 2, 3, ….
    numbers: Vec<u64>,
}

impl Cells {
    /// Returns the number of cells.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Returns whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Adds a cell, numbered by its position. Nodes beyond the corners are ignored; a cell with too few nodes
    /// is not added.
    pub fn push(&mut self, kind: CellKind, nodes: &[u32]) {
        self.push_numbered(self.len() as u64 + 1, kind, nodes);
    }

    /// Adds a cell with its number in the file, otherwise like [`Cells::push`].
    pub fn push_numbered(&mut self, number: u64, kind: CellKind, nodes: &[u32]) {
        let Some(corners) = nodes.get(..kind.corners()) else {
            return;
        };
        let place = self.len() as u64 + 1;
        if number != place && self.numbers.is_empty() {
            self.numbers.extend(1..place);
        }
        if number != place || !self.numbers.is_empty() {
            self.numbers.push(number);
        }
        self.kinds.push(kind);
        self.corners.extend_from_slice(corners);
        self.ends.push(self.corners.len());
    }

    /// Returns the type of a cell.
    pub fn kind(&self, cell: usize) -> CellKind {
        self.kinds[cell]
    }

    /// Returns the corners of a cell: node numbers, from 0.
    pub fn corners(&self, cell: usize) -> &[u32] {
        let begin = if cell == 0 { 0 } else { self.ends[cell - 1] };
        &self.corners[begin..self.ends[cell]]
    }

    /// Returns the number of a cell in the file.
    pub fn number(&self, cell: usize) -> u64 {
        self.numbers.get(cell).copied().unwrap_or(cell as u64 + 1)
    }

    /// Returns type and corners of every cell in turn.
    pub fn iter(&self) -> impl Iterator<Item = (CellKind, &[u32])> {
        (0..self.len()).map(|cell| (self.kind(cell), self.corners(cell)))
    }

    /// Returns the concatenated corners of all cells.
    pub fn all_corners(&self) -> &[u32] {
        &self.corners
    }

    /// Returns the highest dimension of a cell.
    pub fn dimension(&self) -> Option<usize> {
        self.kinds.iter().map(|kind| kind.dimension()).max()
    }

    /// Returns the number of cells of each type present.
    pub fn counts(&self) -> Vec<(CellKind, usize)> {
        let mut counts = BTreeMap::new();
        for &kind in &self.kinds {
            *counts.entry(kind).or_insert(0) += 1;
        }
        counts.into_iter().collect()
    }
}

/// A named list of cells or nodes, by number from 0.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct NamedList {
    /// Name in the file.
    pub name: String,
    /// Cells or nodes, in the order of the file.
    pub members: Vec<u32>,
}

/// A named set of facets of cells.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FaceSet {
    /// Name in the file.
    pub name: String,
    /// The facets, as separate cells.
    pub faces: Cells,
}

/// Nodes, cells and sets of a file, in its length unit.
///
/// The content is not validated: corners may be invalid node numbers. [`RawMesh::check`] validates it, and is
/// called by all functions that use a mesh.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RawMesh {
    /// Positions of the nodes.
    pub nodes: Vec<[f64; 3]>,
    /// Cells of all dimensions.
    pub cells: Cells,
    /// Blocks, physical groups and element sets: lists of cells.
    pub groups: Vec<NamedList>,
    /// Node sets.
    pub node_sets: Vec<NamedList>,
    /// Side sets and surfaces: lists of facets.
    pub face_sets: Vec<FaceSet>,
    /// Given volumes of cells of type [`CellKind::Point`], with the number of the cell, ascending.
    pub point_volumes: Vec<(u32, f64)>,
    /// Elements of unsupported types, with their number.
    pub left_out: BTreeMap<String, usize>,
}

/// Numbers or coordinates that do not define a mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InvalidMesh {
    /// A corner that is not a node.
    #[error("element {number} ({kind}) refers to node {corner}; nodes are numbered 0 to {last}", last = nodes.saturating_sub(1))]
    NoSuchNode {
        /// Number of the element in the file.
        number: u64,
        /// Its type.
        kind: CellKind,
        /// The invalid corner.
        corner: u32,
        /// The number of nodes.
        nodes: usize,
    },
    /// A coordinate that is NaN or infinite.
    #[error("node {node} (from 0) has the coordinate {value}; it must be a finite number")]
    NotFinite {
        /// The node, from 0.
        node: usize,
        /// The coordinate.
        value: f64,
    },
    /// A set member that does not exist.
    #[error("the set {name:?} refers to member {member}; there are only {count}, numbered from 0")]
    NoSuchMember {
        /// Name of the set.
        name: String,
        /// The invalid member.
        member: u32,
        /// Number of cells or nodes.
        count: usize,
    },
}

impl RawMesh {
    /// Adds a polygon: a triangle, a quadrilateral, or a triangle fan from its first corner.
    pub fn polygon(&mut self, corners: &[u32]) {
        match corners.len() {
            0..3 => {}
            3 => self.cells.push(CellKind::Triangle, corners),
            4 => self.cells.push(CellKind::Quadrilateral, corners),
            _ => fan(corners).for_each(|t| self.cells.push(CellKind::Triangle, &t)),
        }
    }

    /// Returns the triangles of all plane cells, in the order of the file; a quadrilateral is split from its
    /// first corner.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let plane = self.cells.iter().filter(|(kind, _)| kind.dimension() == 2);
        plane.flat_map(|(_, corners)| fan(corners)).collect()
    }

    /// Checks coordinates, corners and set members.
    ///
    /// # Errors
    /// Returns an error for the first coordinate that is not finite, corner that is not a node, or set member that does
    /// not exist.
    pub fn check(&self) -> Result<(), InvalidMesh> {
        for (node, x) in self.nodes.iter().enumerate() {
            if let Some(&value) = x.iter().find(|x| !x.is_finite()) {
                return Err(InvalidMesh::NotFinite { node, value });
            }
        }
        let nodes = self.nodes.len();
        let faces = self.face_sets.iter().map(|set| &set.faces);
        for cells in std::iter::once(&self.cells).chain(faces) {
            let all = cells.all_corners();
            if all.iter().all(|&corner| (corner as usize) < nodes) {
                continue;
            }
            for cell in 0..cells.len() {
                let bad = |corner: &&u32| **corner as usize >= nodes;
                if let Some(&corner) = cells.corners(cell).iter().find(bad) {
                    return Err(InvalidMesh::NoSuchNode {
                        number: cells.number(cell),
                        kind: cells.kind(cell),
                        corner,
                        nodes,
                    });
                }
            }
        }
        let groups = self.groups.iter().map(|set| (set, self.cells.len()));
        for (set, count) in groups.chain(self.node_sets.iter().map(|set| (set, nodes))) {
            if let Some(&member) = set.members.iter().find(|&&m| m as usize >= count) {
                let name = set.name.clone();
                return Err(InvalidMesh::NoSuchMember {
                    name,
                    member,
                    count,
                });
            }
        }
        Ok(())
    }
}

/// Returns the triangle fan of a polygon from its first corner.
fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    let pairs = corners.windows(2).skip(1);
    pairs.map(|pair| [corners[0], pair[0], pair[1]])
}
