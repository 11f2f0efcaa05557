//! VTK XML files: `UnstructuredGrid` with cells, `PolyData` with polygons, in one or several pieces.
//!
//! Integer cell data whose name contains block, material, region, group or physical define groups, one for
//! each value.

mod array;
mod fields;
mod file;

use std::collections::BTreeMap;
use std::ops::Range;

use crate::cell::CellKind;
use crate::fault::Fault;
use crate::raw::{NamedList, RawMesh};
use crate::scan::{no_vertex, vertex_number};
use array::Numbers;
pub use fields::{FieldColumn, FieldData, parse_fields};
use file::File;

/// Words in the names of cell data that define groups.
const GROUPING: [&str; 5] = ["block", "material", "region", "group", "physical"];

/// Ordering of the corners of a cell type.
enum Corners {
    /// In the order of Pericles, followed by higher-order nodes.
    InOrder(CellKind),
    /// Row by row, as in pixels and voxels.
    ByRows(CellKind),
    /// Around a polygon.
    Polygon,
}

/// Returns the properties of a VTK cell type (vtkCellType.h); `None` for unsupported types.
fn cell_type(number: i64) -> Option<Corners> {
    use CellKind::{Hexahedron, Line, Point, Pyramid, Quadrilateral, Tetrahedron, Triangle, Wedge};
    Some(match number {
        1 => Corners::InOrder(Point),
        3 | 21 | 35 | 68 => Corners::InOrder(Line),
        5 | 22 | 34 | 69 => Corners::InOrder(Triangle),
        7 => Corners::Polygon,
        8 => Corners::ByRows(Quadrilateral),
        9 | 23 | 28 | 30 | 70 => Corners::InOrder(Quadrilateral),
        10 | 24 | 71 => Corners::InOrder(Tetrahedron),
        11 => Corners::ByRows(Hexahedron),
        12 | 25 | 29 | 33 | 72 => Corners::InOrder(Hexahedron),
        13 | 26 | 31 | 32 | 73 => Corners::InOrder(Wedge),
        14 | 27 | 37 | 74 => Corners::InOrder(Pyramid),
        _ => return None,
    })
}

pub(super) fn parse(content: &[u8], memory: u64) -> Result<RawMesh, Fault> {
    let file = File::new(content, memory)?;
    let mut mesh = RawMesh::default();
    let mut groups = BTreeMap::new();
    for piece in file.pieces() {
        read_piece(&file, piece, &mut mesh, &mut groups)?;
    }
    mesh.groups = groups
        .into_iter()
        .map(|((array, number), members)| NamedList {
            name: format!("{array} {number}"),
            members,
        })
        .collect();
    Ok(mesh)
}

/// Cells of each group, by name of the data and value.
type Groups = BTreeMap<(String, i64), Vec<u32>>;

fn read_piece(
    file: &File<'_>,
    piece: Range<usize>,
    mesh: &mut RawMesh,
    groups: &mut Groups,
) -> Result<(), Fault> {
    let points = file.array_in(piece.clone(), "Points", None)?.real();
    if !points.len().is_multiple_of(3) {
        return Err(Fault::of_file(format!(
            "the points have {} coordinates; each point needs three",
            points.len()
        )));
    }
    let before = mesh.nodes.len() as i64;
    mesh.nodes.extend_from_slice(points.as_chunks::<3>().0);
    let unstructured = file.has("UnstructuredGrid");
    let section = if unstructured { "Cells" } else { "Polys" };
    if !unstructured && !file.has("PolyData") {
        return Err(Fault::of_file(
            "the file contains neither an UnstructuredGrid nor PolyData",
        ));
    }
    let array = |name| file.array_in(piece.clone(), section, Some(name));
    let connectivity = array("connectivity")?.whole("connectivity")?;
    let offsets = array("offsets")?.whole("offsets")?;
    let types = match unstructured {
        true => Some(array("types")?.whole("types")?),
        false => None,
    };
    if let Some(types) = types.as_ref().filter(|types| types.len() != offsets.len()) {
        return Err(Fault::of_file(format!(
            "{} cell types are given for {} cells",
            types.len(),
            offsets.len()
        )));
    }
    let mut begin = 0;
    // First cell of the mesh for each cell of the file.
    let mut places = vec![mesh.cells.len() as u32];
    for (cell, &end) in offsets.iter().enumerate() {
        let range = usize::try_from(end)
            .ok()
            .and_then(|end| connectivity.get(begin..end));
        let Some(corners) = range else {
            return Err(Fault::of_file(format!(
                "the corners of cell {cell} end at {end}; allowed: {begin} to {}",
                connectivity.len()
            )));
        };
        begin += corners.len();
        let number = types.as_ref().map_or(7, |types| types[cell]);
        match cell_type(number) {
            Some(form) => add_cell(mesh, cell, form, corners, before)?,
            None => {
                *mesh
                    .left_out
                    .entry(format!("VTK type {number}"))
                    .or_default() += 1
            }
        }
        places.push(mesh.cells.len() as u32);
    }
    for (name, components) in file.columns_in(piece.clone(), "CellData") {
        let lower = name.to_lowercase();
        if components != 1 || !GROUPING.iter().any(|word| lower.contains(word)) {
            continue;
        }
        let Numbers::Whole(numbers) = file.array_in(piece.clone(), "CellData", Some(&name))? else {
            continue;
        };
        if numbers.len() == offsets.len() {
            for (number, range) in numbers.into_iter().zip(places.windows(2)) {
                let group = groups
                    .entry((name.clone().into_owned(), number))
                    .or_default();
                group.extend(range[0]..range[1]);
            }
        }
    }
    Ok(())
}

fn add_cell(
    mesh: &mut RawMesh,
    cell: usize,
    form: Corners,
    corners: &[i64],
    before: i64,
) -> Result<(), Fault> {
    let least = match form {
        Corners::InOrder(kind) | Corners::ByRows(kind) => kind.corners().min(3),
        Corners::Polygon => 3,
    };
    if corners.len() < least {
        return Err(Fault::of_file(format!(
            "cell {cell} has {} corner(s); at least {least} are required",
            corners.len()
        )));
    }
    let mut nodes = corners
        .iter()
        .map(|&number| {
            let node = number.checked_add(before).filter(|_| number >= 0);
            node.and_then(vertex_number)
                .ok_or_else(|| Fault::of_file(no_vertex(number)))
        })
        .collect::<Result<Vec<u32>, Fault>>()?;
    let kind = match form {
        Corners::Polygon => {
            mesh.polygon(&nodes);
            return Ok(());
        }
        Corners::ByRows(kind) => {
            for (a, b) in [(2, 3), (6, 7)] {
                if b < nodes.len() {
                    nodes.swap(a, b);
                }
            }
            kind
        }
        Corners::InOrder(kind) => kind,
    };
    if nodes.len() < kind.corners() {
        return Err(Fault::of_file(format!(
            "cell {cell} ({kind}) has {} corners; expected {}",
            nodes.len(),
            kind.corners()
        )));
    }
    mesh.cells.push(kind, &nodes);
    Ok(())
}
