//! A mesh as it is in a file.

use std::collections::BTreeMap;

use crate::cell::CellKind;

/// Cells of any kinds, in the order of the file.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Cells {
    kinds: Vec<CellKind>,
    ends: Vec<usize>,
    corners: Vec<u32>,
    /// The file's own numbers; empty as long as they are 1, 2, 3, ….
    numbers: Vec<u64>,
}

impl Cells {
    /// Number of cells.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there is no cell.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Adds a cell, numbered by its place. Nodes beyond the corners are left out; a cell of fewer nodes than its kind has corners is not added.
    pub fn push(&mut self, kind: CellKind, nodes: &[u32]) {
        self.push_numbered(self.len() as u64 + 1, kind, nodes);
    }

    /// Adds a cell with its number in the file, as [`Cells::push`].
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

    /// The kind of a cell.
    pub fn kind(&self, cell: usize) -> CellKind {
        self.kinds[cell]
    }

    /// The corners of a cell: numbers of nodes, from 0.
    pub fn corners(&self, cell: usize) -> &[u32] {
        let begin = if cell == 0 { 0 } else { self.ends[cell - 1] };
        &self.corners[begin..self.ends[cell]]
    }

    /// The number of a cell in the file.
    pub fn number(&self, cell: usize) -> u64 {
        self.numbers.get(cell).copied().unwrap_or(cell as u64 + 1)
    }

    /// Kind and corners of every cell in turn.
    pub fn iter(&self) -> impl Iterator<Item = (CellKind, &[u32])> {
        (0..self.len()).map(|cell| (self.kind(cell), self.corners(cell)))
    }

    /// The corners of all cells, one after the other.
    pub fn all_corners(&self) -> &[u32] {
        &self.corners
    }

    /// The highest dimension of a cell.
    pub fn dimension(&self) -> Option<usize> {
        self.kinds.iter().map(|kind| kind.dimension()).max()
    }

    /// The number of cells of every kind that there is.
    pub fn counts(&self) -> Vec<(CellKind, usize)> {
        let mut counts = BTreeMap::new();
        for &kind in &self.kinds {
            *counts.entry(kind).or_insert(0) += 1;
        }
        counts.into_iter().collect()
    }
}

/// A named list: of cells or of nodes, by number from 0.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct NamedList {
    /// The name in the file.
    pub name: String,
    /// Cells or nodes, in the file's order.
    pub members: Vec<u32>,
}

/// A named set of facets of cells.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FaceSet {
    /// The name in the file.
    pub name: String,
    /// The facets, as cells of their own.
    pub faces: Cells,
}

/// Nodes, cells and sets of a file, in the file's unit of length.
///
/// Nothing is checked here: corners may be numbers of no node. [`RawMesh::check`] does that, and everything that uses a mesh calls it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct RawMesh {
    /// Positions of the nodes.
    pub nodes: Vec<[f64; 3]>,
    /// Cells, of all dimensions.
    pub cells: Cells,
    /// Blocks, physical groups, element sets: lists of cells.
    pub groups: Vec<NamedList>,
    /// Lists of nodes.
    pub node_sets: Vec<NamedList>,
    /// Side sets, surfaces: lists of facets.
    pub face_sets: Vec<FaceSet>,
    /// Volumes that the file gives to cells of the kind [`CellKind::Point`], with the number of the cell, ascending.
    pub point_volumes: Vec<(u32, f64)>,
    /// Elements of types that are not used, with their number.
    pub left_out: BTreeMap<String, usize>,
}

/// A number or coordinate that makes no mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum InvalidMesh {
    /// A corner is no node.
    #[error("element {number} ({kind}) has the corner {corner}; the nodes are numbered 0 to {last}", last = nodes.saturating_sub(1))]
    NoSuchNode {
        /// The number of the element in the file.
        number: u64,
        /// Its kind.
        kind: CellKind,
        /// The corner.
        corner: u32,
        /// The number of nodes.
        nodes: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("node {node} (from 0) has the coordinate {value}; it must be a finite number")]
    NotFinite {
        /// The node, from 0.
        node: usize,
        /// The coordinate.
        value: f64,
    },
    /// A set has a member that is not there.
    #[error("the set {name:?} has the member {member}; {count} are there, numbered from 0")]
    NoSuchMember {
        /// The name of the set.
        name: String,
        /// The member.
        member: u32,
        /// The number of cells or nodes.
        count: usize,
    },
}

impl RawMesh {
    /// Adds a polygon: a triangle, a quadrilateral, or the triangles of a fan from its first corner.
    pub fn polygon(&mut self, corners: &[u32]) {
        match corners.len() {
            0..3 => {}
            3 => self.cells.push(CellKind::Triangle, corners),
            4 => self.cells.push(CellKind::Quadrilateral, corners),
            _ => fan(corners).for_each(|t| self.cells.push(CellKind::Triangle, &t)),
        }
    }

    /// The triangles of all plane cells, in the order of the file; a quadrilateral is cut from its first corner.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let plane = self.cells.iter().filter(|(kind, _)| kind.dimension() == 2);
        plane.flat_map(|(_, corners)| fan(corners)).collect()
    }

    /// Checks coordinates, corners and members of sets.
    ///
    /// # Errors
    /// The first coordinate that is not finite, corner that is no node, or member of a set that is not there.
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

/// The triangles of a polygon, from its first corner.
fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    let pairs = corners.windows(2).skip(1);
    pairs.map(|pair| [corners[0], pair[0], pair[1]])
}
