//! Point sets from groups, face sets and node sets of a mesh.

use std::collections::{BTreeSet, HashMap};

use super::{PointOptions, Problem};
use crate::cell::CellKind;
use crate::element::facet_measure;
use crate::raw::{Cells, RawMesh};

/// Origin of a point set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SetKind {
    /// Elements of a group.
    Elements,
    /// Elements that own a face of a face set.
    Faces,
    /// Elements that have a node of a node set.
    Nodes,
}

/// A named point set.
#[derive(Debug, Clone, PartialEq)]
pub struct PointSet {
    /// Name of the file, made unique.
    pub name: String,
    /// Origin.
    pub kind: SetKind,
    /// The points, ascending.
    pub points: Vec<u32>,
    /// Area of the faces, m²; for edges, length times thickness. `None` for other sets.
    pub area: Option<f64>,
    /// Number of faces between two elements; 0 for other sets.
    pub inner_faces: usize,
    /// Faces as node numbers of the mesh; empty for other sets.
    pub faces: Cells,
}

/// A set before its points are determined.
struct Definition {
    name: String,
    kind: SetKind,
    points: Vec<u32>,
    faces: Cells,
    nodes: Vec<u32>,
}

impl Definition {
    fn new(name: &str, kind: SetKind) -> Self {
        Self {
            name: name.to_owned(),
            kind,
            points: Vec::new(),
            faces: Cells::default(),
            nodes: Vec::new(),
        }
    }
}

/// Returns all sets and warnings about them.
pub(super) fn point_sets(
    mesh: &RawMesh,
    dimension: usize,
    cells: &[u32],
    options: &PointOptions,
) -> (Vec<PointSet>, Vec<Problem>) {
    let mut definitions = definitions(mesh, dimension, cells);
    let mut warnings = Vec::new();
    let measures = own_faces(mesh, cells, &mut definitions, &mut warnings);
    have_nodes(mesh, cells, &mut definitions);
    // Areas of faces; lengths of edges times the thickness.
    let scale = match dimension {
        2 => options.unit * options.thickness,
        _ => options.unit * options.unit,
    };
    let mut sets: Vec<PointSet> = definitions
        .into_iter()
        .zip(measures)
        .filter(|(set, _)| !set.points.is_empty())
        .map(|(set, (area, inner_faces))| PointSet {
            area: (set.kind == SetKind::Faces).then_some(area * scale),
            inner_faces,
            name: set.name,
            kind: set.kind,
            points: set.points,
            faces: set.faces,
        })
        .collect();
    name_uniquely(&mut sets, cells.len(), &mut warnings);
    (sets, warnings)
}

/// Returns the definitions from all groups, face sets and node sets of the mesh.
fn definitions(mesh: &RawMesh, dimension: usize, cells: &[u32]) -> Vec<Definition> {
    let mut point_of = vec![None; mesh.cells.len()];
    for (point, &cell) in (0u32..).zip(cells) {
        point_of[cell as usize] = Some(point);
    }
    let mut all = Vec::new();
    for group in &mesh.groups {
        let mut elements = Definition::new(&group.name, SetKind::Elements);
        let mut faces = Definition::new(&group.name, SetKind::Faces);
        let mut nodes = Definition::new(&group.name, SetKind::Nodes);
        for &cell in &group.members {
            let (kind, corners) = (
                mesh.cells.kind(cell as usize),
                mesh.cells.corners(cell as usize),
            );
            match point_of[cell as usize] {
                Some(point) => elements.points.push(point),
                None if kind.dimension() + 1 == dimension => faces.faces.push(kind, corners),
                None if kind.dimension() + 1 < dimension => nodes.nodes.extend(corners),
                None => {}
            }
        }
        elements.points.sort_unstable();
        elements.points.dedup();
        all.extend([elements, faces, nodes]);
    }
    for set in &mesh.face_sets {
        let mut definition = Definition::new(&set.name, SetKind::Faces);
        definition.faces = set.faces.clone();
        all.push(definition);
    }
    for set in &mesh.node_sets {
        let mut definition = Definition::new(&set.name, SetKind::Nodes);
        definition.nodes = set.members.clone();
        all.push(definition);
    }
    all
}

/// The corners of a face in ascending order, equal for two cells that share it.
type Key = (CellKind, [u32; 4]);

fn key(kind: CellKind, corners: impl Iterator<Item = u32>) -> Key {
    let mut sorted = [u32::MAX; 4];
    for (place, corner) in sorted.iter_mut().zip(corners) {
        *place = corner;
    }
    sorted.sort_unstable();
    (kind, sorted)
}

/// The sets that contain a face, and the number of elements that own it.
struct Owned {
    sets: Vec<u32>,
    owners: u8,
}

/// Adds the elements that own a face of a face set; returns the area of these faces, in the units of the file,
/// and the number of those between two elements.
fn own_faces(
    mesh: &RawMesh,
    cells: &[u32],
    definitions: &mut [Definition],
    warnings: &mut Vec<Problem>,
) -> Vec<(f64, usize)> {
    let mut faces: HashMap<Key, Owned> = HashMap::new();
    let mut on_face = vec![false; mesh.nodes.len()];
    for (number, set) in (0u32..).zip(definitions.iter()) {
        for (kind, corners) in set.faces.iter() {
            let entry = faces.entry(key(kind, corners.iter().copied()));
            let owned = entry.or_insert(Owned {
                sets: Vec::new(),
                owners: 0,
            });
            if owned.sets.last() != Some(&number) {
                owned.sets.push(number);
            }
            for &node in corners {
                on_face[node as usize] = true;
            }
        }
    }
    for (point, &cell) in (0u32..).zip(cells) {
        let corners = mesh.cells.corners(cell as usize);
        for (kind, places) in mesh.cells.kind(cell as usize).facets() {
            if !places.iter().all(|&place| on_face[corners[place] as usize]) {
                continue;
            }
            let face = key(*kind, places.iter().map(|&place| corners[place]));
            if let Some(owned) = faces.get_mut(&face) {
                owned.owners = owned.owners.saturating_add(1);
                for &set in &owned.sets {
                    let points = &mut definitions[set as usize].points;
                    if points.last() != Some(&point) {
                        points.push(point);
                    }
                }
            }
        }
    }
    let mut measures = Vec::new();
    for set in definitions.iter() {
        let (mut area, mut unowned, mut inner) = (0.0, 0, 0);
        let mut counted = BTreeSet::new();
        for (kind, corners) in set.faces.iter() {
            let face = key(kind, corners.iter().copied());
            if !counted.insert(face) {
                continue;
            }
            match faces.get(&face) {
                Some(owned) if owned.owners > 0 => {
                    inner += usize::from(owned.owners > 1);
                    area += facet_measure(kind, &mesh.corner_positions(corners));
                }
                _ => unowned += 1,
            }
        }
        if unowned > 0 {
            warnings.push(Problem::UnownedFaces {
                name: set.name.clone(),
                count: unowned,
            });
        }
        measures.push((area, inner));
    }
    measures
}

/// Adds the elements that have a node of a node set.
fn have_nodes(mesh: &RawMesh, cells: &[u32], definitions: &mut [Definition]) {
    for set in definitions.iter_mut().filter(|set| !set.nodes.is_empty()) {
        let mut wanted = vec![false; mesh.nodes.len()];
        for &node in &set.nodes {
            wanted[node as usize] = true;
        }
        for (point, &cell) in (0u32..).zip(cells) {
            let mut corners = mesh.cells.corners(cell as usize).iter();
            if corners.any(|&node| wanted[node as usize]) {
                set.points.push(point);
            }
        }
    }
}

/// Name of the set of all points in decks, which no set of a mesh may have.
const ALL: &str = "all";

/// Makes names unique: element sets keep their names, face and node sets get a suffix, and remaining
/// duplicates are numbered. A set with the reserved name gets a suffix, with a warning
/// if it does not contain all points.
fn name_uniquely(sets: &mut [PointSet], points: usize, warnings: &mut Vec<Problem>) {
    let mut order: Vec<usize> = (0..sets.len()).collect();
    order.sort_by_key(|&set| sets[set].kind);
    let mut taken = BTreeSet::from([ALL.to_owned()]);
    for set in order {
        let ending = match sets[set].kind {
            SetKind::Elements => "elements",
            SetKind::Faces => "faces",
            SetKind::Nodes => "nodes",
        };
        let base = sets[set].name.clone();
        let mut name = base.clone();
        let mut number = 1;
        while !taken.insert(name.clone()) {
            name = match number {
                1 => format!("{base} ({ending})"),
                _ => format!("{base} ({ending} {number})"),
            };
            number += 1;
        }
        if base == ALL && sets[set].points.len() < points {
            warnings.push(Problem::ReservedName {
                name: base,
                other: name.clone(),
            });
        }
        sets[set].name = name;
    }
}
