//! The sections `$Nodes` and `$Elements`.

use std::collections::HashMap;

use super::groups::Groups;
use super::numbers::{Numbers, Version};
use super::{Format, line_end};
use crate::cell::CellKind;
use crate::fault::Fault;
use crate::raw::RawMesh;
use crate::scan::{Numbering, Words};

/// Number of nodes of each element type, from type 1 (Gmsh reference manual, MSH file format).
const NODES: [usize; 31] = [
    2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6,
    20, 35, 56,
];

/// Returns the number of nodes of an element type; `None` for an unknown type.
fn nodes_of(kind: i64) -> Option<usize> {
    NODES.get(usize::try_from(kind - 1).ok()?).copied()
}

/// Returns the cell type of an element type; its corners are its first nodes.
fn kind_of(kind: i64) -> CellKind {
    match kind {
        15 => CellKind::Point,
        2 | 9 | 20..=25 => CellKind::Triangle,
        3 | 10 | 16 => CellKind::Quadrilateral,
        4 | 11 | 29..=31 => CellKind::Tetrahedron,
        5 | 12 | 17 => CellKind::Hexahedron,
        6 | 13 | 18 => CellKind::Wedge,
        7 | 14 | 19 => CellKind::Pyramid,
        _ => CellKind::Line,
    }
}

/// Cell type and sorted corners of a cell; unused entries have the maximum value.
type Key = (CellKind, [u32; 8]);

/// State of reading nodes and elements.
#[derive(Default)]
pub(super) struct Reading {
    pub(super) mesh: RawMesh,
    pub(super) groups: Groups,
    nodes: Numbering,
    /// Index of each cell of version 2, in which an element of several groups is repeated for each with
    /// different numbers.
    seen: HashMap<Key, u32>,
}

/// Reads the number of nodes or elements of version 2, which is text also in binary files.
fn count_of_two(
    numbers: &mut Numbers<'_>,
    content: &[u8],
    what: &str,
    numbers_each: usize,
) -> Result<usize, Fault> {
    if let Numbers::Binary(bytes) = numbers {
        let mut words = Words::new(content, None);
        words.skip_to(bytes.position());
        let count: u64 = words.number(&format!("a number of {what}"))?;
        bytes.take(line_end(content, words.position()).min(content.len()) - bytes.position())?;
        return bytes.room(count, 4 * numbers_each, what);
    }
    numbers.count(Version::Two, what, numbers_each)
}

impl Reading {
    pub(super) fn read_nodes(
        &mut self,
        numbers: &mut Numbers<'_>,
        format: Format,
        content: &[u8],
    ) -> Result<(), Fault> {
        let (nodes, positions) = (&mut self.nodes, &mut self.mesh.nodes);
        let mut add = |numbers: &Numbers<'_>, tag: i64, point: [f64; 3]| {
            if !nodes.insert(tag, positions.len() as u32) {
                return Err(numbers.fault(format!("node {tag} is defined twice")));
            }
            positions.push(point);
            Ok(())
        };
        if format.version == Version::Two {
            for _ in 0..count_of_two(numbers, content, "nodes", 4)? {
                let tag = numbers.int()?;
                let point = numbers.point()?;
                add(numbers, tag, point)?;
            }
            return Ok(());
        }
        let blocks = numbers.count(Version::Four, "node blocks", 4)?;
        for _ in 0..3 {
            numbers.tag(Version::Four)?;
        }
        for _ in 0..blocks {
            let dimension = numbers.int()?;
            numbers.int()?;
            let parametric = numbers.int()? != 0;
            let extra = if parametric { dimension.clamp(0, 3) } else { 0 };
            let count = numbers.count(Version::Four, "nodes", 4)?;
            let tags = (0..count)
                .map(|_| numbers.tag(Version::Four))
                .collect::<Result<Vec<i64>, Fault>>()?;
            for tag in tags {
                let point = numbers.point()?;
                for _ in 0..extra {
                    numbers.real()?;
                }
                add(numbers, tag, point)?;
            }
        }
        Ok(())
    }

    pub(super) fn read_elements(
        &mut self,
        numbers: &mut Numbers<'_>,
        format: Format,
        content: &[u8],
    ) -> Result<(), Fault> {
        match format.version {
            Version::Two => self.read_elements_of_two(numbers, content),
            Version::Four => self.read_elements_of_four(numbers),
        }
    }

    fn read_elements_of_four(&mut self, numbers: &mut Numbers<'_>) -> Result<(), Fault> {
        let blocks = numbers.count(Version::Four, "element blocks", 4)?;
        for _ in 0..3 {
            numbers.tag(Version::Four)?;
        }
        for _ in 0..blocks {
            let dimension = numbers.int()?;
            let entity = numbers.int()?;
            let kind = numbers.int()?;
            let groups = self.groups.of_entity(dimension, entity);
            let count = numbers.count(Version::Four, "elements", 2)?;
            for _ in 0..count {
                let tag = numbers.tag(Version::Four)?;
                let (kind, corners) = self.element(numbers, Version::Four, kind)?;
                self.add(tag, kind, &corners[..kind.corners()], &groups);
            }
        }
        Ok(())
    }

    fn read_elements_of_two(
        &mut self,
        numbers: &mut Numbers<'_>,
        content: &[u8],
    ) -> Result<(), Fault> {
        let mut left = count_of_two(numbers, content, "elements", 3)?;
        while left > 0 {
            // In text files every element has its own header; in binary files several elements of one type
            // share one.
            let (first, kind, count, tags) = match numbers {
                Numbers::Text(_) => (numbers.int()?, numbers.int()?, 1, numbers.int()?),
                Numbers::Binary(_) => {
                    let (kind, count, tags) = (numbers.int()?, numbers.int()?, numbers.int()?);
                    let count = usize::try_from(count)
                        .ok()
                        .filter(|&count| (1..=left).contains(&count));
                    let count = count.ok_or_else(|| {
                        numbers.fault(format!(
                            "the block has more elements than the {left} that remain"
                        ))
                    })?;
                    (0, kind, count, tags)
                }
            };
            for _ in 0..count {
                let number = match numbers {
                    Numbers::Text(_) => first,
                    Numbers::Binary(_) => numbers.int()?,
                };
                let mut group = 0;
                for place in 0..tags {
                    let tag = numbers.int()?;
                    if place == 0 {
                        group = tag.unsigned_abs();
                    }
                }
                let (kind, corners) = self.element(numbers, Version::Two, kind)?;
                let groups: &[u64] = if group == 0 { &[] } else { &[group] };
                self.add_once(number, kind, corners, groups);
            }
            left -= count;
        }
        Ok(())
    }

    /// Reads the nodes of an element; returns its cell type and corners.
    fn element(
        &self,
        numbers: &mut Numbers<'_>,
        version: Version,
        kind: i64,
    ) -> Result<(CellKind, [u32; 8]), Fault> {
        let Some(count) = nodes_of(kind) else {
            return Err(numbers.fault(format!("unknown element type {kind}; allowed: 1 to 31")));
        };
        let kind = kind_of(kind);
        let mut corners = [u32::MAX; 8];
        for place in 0..count {
            let tag = numbers.tag(version)?;
            if place < kind.corners() {
                corners[place] = self.nodes.get(tag).ok_or_else(|| {
                    numbers.fault(format!(
                        "an element refers to node {tag}, which is not defined"
                    ))
                })?;
            }
        }
        Ok((kind, corners))
    }

    fn add(&mut self, number: i64, kind: CellKind, corners: &[u32], groups: &[u64]) {
        let cell = self.mesh.cells.len() as u32;
        self.mesh
            .cells
            .push_numbered(number.unsigned_abs(), kind, corners);
        for &group in groups {
            self.groups.add(kind.dimension(), group, cell);
        }
    }

    /// Adds an element, or adds groups to an existing one.
    fn add_once(&mut self, number: i64, kind: CellKind, corners: [u32; 8], groups: &[u64]) {
        let mut sorted = corners;
        sorted.sort_unstable();
        let cell = self.mesh.cells.len() as u32;
        let place = *self.seen.entry((kind, sorted)).or_insert(cell);
        if place == cell {
            self.add(number, kind, &corners[..kind.corners()], groups);
            return;
        }
        for &group in groups {
            self.groups.add(kind.dimension(), group, place);
        }
    }
}
