//! Element types and their faces.

use crate::cell::CellKind;

/// Properties of an element type.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ElementType {
    pub(super) kind: CellKind,
    /// Number of nodes.
    pub(super) nodes: usize,
}

/// Name prefixes of solids, plane elements and shells, trusses and beams.
const SOLIDS: [&str; 8] = ["C3D", "AC3D", "DC3D", "COH3D", "CSS", "SC", "EC3D", "DCC3D"];
const PLANE: [&str; 16] = [
    "CPS", "CPE", "CPEG", "CAX", "CGAX", "AC2D", "ACAX", "DC2D", "DCAX", "M3D", "R3D", "SFM3D",
    "STRI", "DS", "S", "R2D",
];
const TRUSSES: [&str; 4] = ["T2D", "T3D", "RB2D", "RB3D"];
/// The number after these prefixes is the interpolation order: 1 and 3 have two nodes, 2 has three.
const BEAMS: [&str; 5] = ["B2", "B3", "PIPE2", "PIPE3", "SAX"];

/// Returns the type with this name; `None` for unsupported types. A name consists of a prefix, the number of
/// nodes and letters: C3D8R.
pub(super) fn element_type(name: &str) -> Option<ElementType> {
    let name = name.to_ascii_uppercase();
    // The number of nodes follows the longest matching prefix.
    let number_after = |beginnings: &[&str]| {
        let fits = beginnings.iter().filter_map(|b| name.strip_prefix(b));
        let rest = fits.min_by_key(|rest| rest.len())?;
        let end = rest.find(|c: char| !c.is_ascii_digit());
        rest[..end.unwrap_or(rest.len())].parse::<usize>().ok()
    };
    let solid = |nodes| match nodes {
        4 | 10 => Some(CellKind::Tetrahedron),
        5 | 13 => Some(CellKind::Pyramid),
        6 | 15 | 18 => Some(CellKind::Wedge),
        8 | 20 | 21 | 27 => Some(CellKind::Hexahedron),
        _ => None,
    };
    let plane = |nodes| match nodes {
        3 | 6 | 65 => Some(CellKind::Triangle),
        4 | 8 | 9 => Some(CellKind::Quadrilateral),
        _ => None,
    };
    if let Some(nodes) = number_after(&SOLIDS) {
        let kind = solid(nodes)?;
        return Some(ElementType { kind, nodes });
    }
    let kind = CellKind::Line;
    if let Some(nodes @ (2 | 3)) = number_after(&TRUSSES) {
        return Some(ElementType { kind, nodes });
    }
    if let Some(order) = number_after(&BEAMS) {
        let nodes = if order % 10 == 2 { 3 } else { 2 };
        return Some(ElementType { kind, nodes });
    }
    let nodes = number_after(&PLANE)?;
    let kind = plane(nodes)?;
    // STRI65 has six nodes and five degrees of freedom each.
    let nodes = if nodes == 65 { 6 } else { nodes };
    Some(ElementType { kind, nodes })
}

/// Returns the index among the sides of the cell type of an Abaqus face, numbered from 1.
pub(super) fn facet_of(kind: CellKind, face: usize) -> Option<usize> {
    let order: &[usize] = match kind {
        CellKind::Hexahedron => &[4, 5, 0, 1, 2, 3],
        CellKind::Tetrahedron => &[3, 0, 1, 2],
        CellKind::Wedge => &[3, 4, 0, 1, 2],
        CellKind::Pyramid => &[4, 0, 1, 2, 3],
        CellKind::Quadrilateral => &[0, 1, 2, 3],
        CellKind::Triangle => &[0, 1, 2],
        CellKind::Line | CellKind::Point => &[],
    };
    order.get(face.checked_sub(1)?).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_are_recognised_by_prefix_and_number_of_nodes() {
        for (name, kind, nodes) in [
            ("C3D8R", CellKind::Hexahedron, 8),
            ("c3d10m", CellKind::Tetrahedron, 10),
            ("C3D4", CellKind::Tetrahedron, 4),
            ("C3D20RH", CellKind::Hexahedron, 20),
            ("C3D15", CellKind::Wedge, 15),
            ("C3D5", CellKind::Pyramid, 5),
            ("SC8R", CellKind::Hexahedron, 8),
            ("SC6R", CellKind::Wedge, 6),
            ("COH3D8", CellKind::Hexahedron, 8),
            ("CPS3", CellKind::Triangle, 3),
            ("CPE4R", CellKind::Quadrilateral, 4),
            ("CPS6M", CellKind::Triangle, 6),
            ("CAX8", CellKind::Quadrilateral, 8),
            ("S4R", CellKind::Quadrilateral, 4),
            ("S3", CellKind::Triangle, 3),
            ("STRI65", CellKind::Triangle, 6),
            ("M3D4", CellKind::Quadrilateral, 4),
            ("T3D2", CellKind::Line, 2),
            ("T3D3", CellKind::Line, 3),
            ("B31", CellKind::Line, 2),
            ("B32", CellKind::Line, 3),
        ] {
            let found = element_type(name);
            assert_eq!(found, Some(ElementType { kind, nodes }), "{name}");
        }
        for name in ["SPRINGA", "MASS", "CONN3D2", "C3D7", "", "C3D"] {
            assert_eq!(element_type(name), None, "{name}");
        }
    }

    #[test]
    fn faces_have_the_corners_of_the_manual() {
        // Corners of S1, S2, … (Abaqus Analysis User's Guide, three-dimensional solid element library).
        let manual: [(CellKind, &[&str]); 3] = [
            (
                CellKind::Hexahedron,
                &["1234", "5876", "1562", "2673", "3784", "4851"],
            ),
            (CellKind::Tetrahedron, &["123", "142", "243", "341"]),
            (CellKind::Wedge, &["123", "465", "1452", "2563", "3641"]),
        ];
        for (kind, faces) in manual {
            for (number, corners) in (1..).zip(faces) {
                let facet = facet_of(kind, number).unwrap();
                let mut ours: Vec<usize> = kind.facets()[facet].1.iter().map(|c| c + 1).collect();
                ours.sort_unstable();
                let mut theirs: Vec<usize> = corners
                    .chars()
                    .map(|c| c.to_digit(10).unwrap() as usize)
                    .collect();
                theirs.sort_unstable();
                assert_eq!(ours, theirs, "{kind} S{number}");
            }
        }
    }
}
