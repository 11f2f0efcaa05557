//! Volumes and centroids of elements: exact values, an independent formula, and space-filling meshes.

use pericles_mesh::element::{Measure, facet_measure, is_folded, measure};
use pericles_mesh::{CellKind, PointOptions, Problem, RawMesh, SetKind};
use proptest::prelude::*;

type Point = [f64; 3];

/// Elements with exact volume and centroid. Solids: integrals of the trilinear map, computed by hand; plane
/// elements: the shoelace formula.
fn references() -> Vec<(CellKind, Vec<Point>, f64, Point)> {
    vec![
        (
            CellKind::Tetrahedron,
            vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]],
            1.0,
            [0.25, 0.5, 0.75],
        ),
        (
            CellKind::Pyramid,
            vec![
                [0.0; 3],
                [2.0, 0.0, 0.0],
                [2.0, 2.0, 0.5],
                [0.0, 2.0, 0.0],
                [0.5, 1.0, 2.0],
            ],
            31.0 / 12.0,
            [7.0 / 8.0, 125.0 / 124.0, 443.0 / 744.0],
        ),
        (
            CellKind::Wedge,
            vec![
                [0.0; 3],
                [1.0, 0.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [1.5, 0.0, 1.0],
                [0.0, 1.0, 2.0],
            ],
            5.0 / 6.0,
            [19.0 / 48.0, 3.0 / 8.0, 11.0 / 15.0],
        ),
        (
            CellKind::Hexahedron,
            vec![
                [0.0; 3],
                [1.0, 0.0, 0.0],
                [1.0, 1.0, 0.0],
                [0.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [1.0, 0.0, 1.0],
                [1.5, 1.25, 1.75],
                [0.0, 1.0, 1.0],
            ],
            11.0 / 8.0,
            [20.0 / 33.0, 19.0 / 33.0, 7.0 / 11.0],
        ),
        (
            CellKind::Quadrilateral,
            vec![[0.0; 3], [2.0, 0.0, 0.0], [3.0, 2.0, 0.0], [0.0, 1.0, 0.0]],
            3.5,
            [29.0 / 21.0, 17.0 / 21.0, 0.0],
        ),
        (
            CellKind::Triangle,
            vec![[0.0; 3], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            1.0,
            [2.0 / 3.0, 1.0 / 3.0, 0.0],
        ),
    ]
}

fn assert_measure(kind: CellKind, corners: &[Point], volume: f64, centroid: Point) {
    let found = measure(kind, corners).unwrap();
    assert!((found.volume - volume).abs() < 1e-14, "{kind}: {found:?}");
    for c in 0..3 {
        let error = (found.centroid[c] - centroid[c]).abs();
        assert!(error < 1e-14, "{kind}: {found:?}");
    }
}

#[test]
fn volumes_and_centroids_of_reference_elements_are_exact() {
    for (kind, corners, volume, centroid) in references() {
        assert_measure(kind, &corners, volume, centroid);
        assert!(!is_folded(kind, &corners), "{kind}");
        // Rotated about a space diagonal: x, y, z to y, z, x. Plane elements stay in their plane.
        if kind.dimension() == 3 {
            let turned: Vec<Point> = corners.iter().map(|x| [x[1], x[2], x[0]]).collect();
            let [a, b, c] = centroid;
            assert_measure(kind, &turned, volume, [b, c, a]);
        }
        // A mirror image has a negative volume and the mirrored centroid.
        let mirrored: Vec<Point> = corners.iter().map(|x| [-x[0], x[1], x[2]]).collect();
        assert_measure(
            kind,
            &mirrored,
            -volume,
            [-centroid[0], centroid[1], centroid[2]],
        );
        assert!(!is_folded(kind, &mirrored), "{kind}");
    }
}

#[test]
fn volumes_do_not_depend_on_the_first_corner_of_the_bottom() {
    for (kind, corners, volume, centroid) in references() {
        let bottom = match kind {
            CellKind::Hexahedron | CellKind::Pyramid | CellKind::Quadrilateral => 4,
            _ => 3,
        };
        let turned = |k: usize| match (kind, k / bottom) {
            (CellKind::Pyramid | CellKind::Tetrahedron, 1) => k,
            (_, layer) => layer * bottom + (k + 1) % bottom,
        };
        let corners: Vec<Point> = (0..corners.len()).map(|k| corners[turned(k)]).collect();
        assert_measure(kind, &corners, volume, centroid);
    }
}

/// V = Σ x_a · (x_b × x_c) / 6 over the faces, where a quadrilateral is the mean of its two triangulations
/// (equal to the volume under a bilinear face).
fn volume_by_faces(kind: CellKind, corners: &[Point]) -> f64 {
    let six = |a: usize, b: usize, c: usize| {
        let [a, b, c] = [corners[a], corners[b], corners[c]];
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let faces = kind.facets().iter().map(|(_, face)| match **face {
        [a, b, c] => six(a, b, c),
        [a, b, c, d] => 0.5 * (six(a, b, c) + six(a, c, d) + six(a, b, d) + six(b, c, d)),
        _ => unreachable!(),
    });
    faces.sum::<f64>() / 6.0
}

proptest! {
    #[test]
    fn volumes_of_elements_with_nonplanar_faces_agree_with_the_face_formula(shift in prop::collection::vec(-0.3f64..0.3, 24), which in 0usize..4) {
        let (kind, mut corners, ..) = references().swap_remove(which);
        for (k, corner) in corners.iter_mut().enumerate() {
            for c in 0..3 {
                corner[c] += shift[3 * k + c];
            }
        }
        let Measure { volume, .. } = measure(kind, &corners).unwrap();
        prop_assert!((volume - volume_by_faces(kind, &corners)).abs() < 1e-14, "{} {}", volume, volume_by_faces(kind, &corners));
    }
}

#[test]
fn folded_elements_are_detected_and_flat_or_collapsed_ones_are_accepted() {
    let (_, cube, ..) = references().swap_remove(3);
    let mut folded = cube.clone();
    // The corner opposite to 0 is moved through the centre: the triple products at its neighbours change sign.
    folded[6] = [-0.5, -0.5, -0.5];
    assert!(is_folded(CellKind::Hexahedron, &folded));
    // A hexahedron collapsed to a wedge: two pairs of corners coincide.
    let mut collapsed = cube.clone();
    collapsed[6] = [1.0, 1.0, 1.0];
    collapsed[3] = collapsed[2];
    collapsed[7] = collapsed[6];
    assert!(!is_folded(CellKind::Hexahedron, &collapsed));
    let bow = [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert!(is_folded(CellKind::Quadrilateral, &bow));
    let flat = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert!(!is_folded(CellKind::Quadrilateral, &flat));
}

#[test]
fn areas_of_faces_in_space_are_exact() {
    let turn = |[x, y, z]: Point| [0.6 * x - 0.8 * z, y, 0.8 * x + 0.6 * z];
    let square = [[0.0; 3], [2.0, 0.0, 0.0], [2.0, 3.0, 0.0], [0.0, 3.0, 0.0]].map(turn);
    assert!((facet_measure(CellKind::Quadrilateral, &square) - 6.0).abs() < 1e-14);
    assert!((facet_measure(CellKind::Triangle, &square) - 3.0).abs() < 1e-14);
    assert!((facet_measure(CellKind::Line, &square) - 2.0).abs() < 1e-14);
}

/// Corners of a hexahedron split into six tetrahedra along the diagonal from 0 to 6.
const TETS: [[usize; 4]; 6] = [
    [0, 1, 2, 6],
    [0, 2, 3, 6],
    [0, 3, 7, 6],
    [0, 7, 4, 6],
    [0, 4, 5, 6],
    [0, 5, 1, 6],
];

/// A box of n³ hexahedra of side 1/n, or of their tetrahedra; interior nodes are displaced by a smooth map
/// that keeps the faces of the box.
fn boxes(n: usize, of_tets: bool) -> RawMesh {
    let mut mesh = RawMesh::default();
    let at = |i: usize, j: usize, k: usize| ((k * (n + 1) + j) * (n + 1) + i) as u32;
    for k in 0..=n {
        for j in 0..=n {
            for i in 0..=n {
                let x = [i, j, k].map(|i| i as f64 / n as f64);
                let bump: f64 = x.iter().map(|x| x * (1.0 - x)).product();
                mesh.nodes
                    .push([x[0] + bump, x[1] - 0.5 * bump, x[2] + 0.3 * bump]);
            }
        }
    }
    for k in 0..n {
        for j in 0..n {
            for i in 0..n {
                let corners = [
                    (0, 0, 0),
                    (1, 0, 0),
                    (1, 1, 0),
                    (0, 1, 0),
                    (0, 0, 1),
                    (1, 0, 1),
                    (1, 1, 1),
                    (0, 1, 1),
                ]
                .map(|(a, b, c)| at(i + a, j + b, k + c));
                if of_tets {
                    for tet in TETS {
                        mesh.cells
                            .push(CellKind::Tetrahedron, &tet.map(|c| corners[c]));
                    }
                } else {
                    mesh.cells.push(CellKind::Hexahedron, &corners);
                }
            }
        }
    }
    let mut faces = pericles_mesh::Cells::default();
    for k in 0..n {
        for j in 0..n {
            let [a, b, c, d] = [
                at(0, j, k),
                at(0, j + 1, k),
                at(0, j + 1, k + 1),
                at(0, j, k + 1),
            ];
            if of_tets {
                faces.push(CellKind::Triangle, &[a, b, c]);
                faces.push(CellKind::Triangle, &[a, c, d]);
            } else {
                faces.push(CellKind::Quadrilateral, &[a, b, c, d]);
            }
        }
    }
    let name = "left".to_owned();
    mesh.face_sets.push(pericles_mesh::FaceSet { name, faces });
    mesh
}

#[test]
fn element_volumes_add_up_to_the_volume_of_a_box() {
    for of_tets in [false, true] {
        let n = 5;
        let mesh = boxes(n, of_tets);
        let unit = 1e-3;
        let options = PointOptions {
            unit,
            ..Default::default()
        };
        let points = mesh.points(&options).unwrap();
        let volume: f64 = points.volumes.iter().sum();
        assert!((volume / unit.powi(3) - 1.0).abs() < 1e-13, "{volume}");
        // The first moment of the volume equals the moment of the cube.
        for c in 0..3 {
            let moment: f64 = points
                .volumes
                .iter()
                .zip(&points.positions)
                .map(|(v, x)| v * x[c])
                .sum();
            assert!((moment / (0.5 * unit.powi(4)) - 1.0).abs() < 1e-13);
        }
        let left = points.set("left").unwrap();
        assert_eq!(left.kind, SetKind::Faces);
        assert!((left.area.unwrap() / (unit * unit) - 1.0).abs() < 1e-13);
        // Two of the six tetrahedra of a hexahedron own a triangle of the face x = 0: [0, 3, 7, 6] and [0, 7,
        // 4, 6] share its diagonal.
        let owners = if of_tets { 2 * n * n } else { n * n };
        assert_eq!(left.points.len(), owners);
        assert!(points.warnings.is_empty(), "{:?}", points.warnings);
        // A layer of two hexahedra: all points with x below its thickness, because the face is the whole side
        // of the box.
        let depth = 0.4 * unit;
        let near = points.near_faces(&mesh, unit, "left", depth).unwrap();
        let expected = (0u32..)
            .zip(&points.positions)
            .filter(|(_, x)| x[0] <= depth);
        assert_eq!(near, expected.map(|(point, _)| point).collect::<Vec<u32>>());
        assert!(near.len() > left.points.len());
        assert_eq!(points.near_faces(&mesh, unit, "right", depth), None);
    }
}

#[test]
fn invalid_meshes_are_rejected_with_clear_messages() {
    let (_, cube, ..) = references().swap_remove(3);
    let corners: Vec<u32> = (0..8).collect();
    let rejected = |nodes: Vec<Point>, kind: CellKind, corners: &[u32]| {
        let mut mesh = RawMesh {
            nodes,
            ..Default::default()
        };
        mesh.cells.push_numbered(812, kind, corners);
        mesh.points(&PointOptions::default()).unwrap_err()
    };
    let mut folded = cube.clone();
    folded[6] = [-0.5, -0.5, -0.5];
    let problem = rejected(folded, CellKind::Hexahedron, &corners);
    assert!(
        problem
            .to_string()
            .starts_with("element 812 (hex) is folded (inverted at some of its corners): its corners are (0, 0, 0) (1, 0, 0)"),
        "{problem}"
    );
    let flat = cube.iter().map(|x| [x[0], x[1], 0.0]).collect();
    let problem = rejected(flat, CellKind::Hexahedron, &corners);
    assert_eq!(
        problem,
        Problem::NoVolume {
            first: 812,
            count: 1
        }
    );
    assert_eq!(
        problem.to_string(),
        "1 element(s) have zero volume, the first is element 812"
    );
    let problem = rejected(cube.clone(), CellKind::Quadrilateral, &[0, 1, 6, 7]);
    assert!(matches!(problem, Problem::NotPlane { .. }), "{problem}");
    assert!(
        problem
            .to_string()
            .contains("z from 0 to 1.75; a plane mesh must lie in a plane of constant z"),
        "{problem}"
    );
    let problem = rejected(cube.clone(), CellKind::Line, &[0, 1]);
    assert!(
        problem.to_string().contains("the mesh has 1 line only"),
        "{problem}"
    );
    let problem = rejected(cube.clone(), CellKind::Tetrahedron, &[0, 1, 2, 8]);
    assert!(
        problem
            .to_string()
            .contains("element 812 (tet) refers to node 8; nodes are numbered 0 to 7"),
        "{problem}"
    );
    let mut infinite = cube.clone();
    infinite[2][1] = f64::INFINITY;
    let problem = rejected(infinite, CellKind::Hexahedron, &corners);
    assert!(problem.to_string().contains("node 2"), "{problem}");
    let empty = RawMesh::default()
        .points(&PointOptions::default())
        .unwrap_err();
    assert!(empty.to_string().contains("Mesh.SaveAll"), "{empty}");
    // A cube of 1 mm and one of 100 km.
    for (unit, warned) in [(1.0, false), (1e-4, true), (1e5, true)] {
        let mut mesh = RawMesh {
            nodes: cube.clone(),
            ..Default::default()
        };
        mesh.cells.push(CellKind::Hexahedron, &corners);
        let options = PointOptions {
            unit,
            ..Default::default()
        };
        let points = mesh.points(&options).unwrap();
        assert_eq!(!points.warnings.is_empty(), warned, "{unit}");
        if let [warning] = &points.warnings[..] {
            // The largest side of the bounding box of the centroids plus one element: the cube root of 11/8.
            let words = warning.to_string();
            let side = if unit < 1.0 {
                "1.112e-4 m"
            } else {
                "1.112e5 m"
            };
            assert!(words.contains(side), "{words}");
            assert!(words.contains("check the unit of the file"), "{words}");
        }
        assert!(points.check_sizes(3.0 * unit).is_empty());
        let problems = points.check_sizes(2.0 * unit);
        assert!(
            matches!(&problems[..], [Problem::Coarse { .. }]),
            "{problems:?}"
        );
    }
    let mut mesh = boxes(2, false);
    mesh.groups.push(pericles_mesh::NamedList {
        name: "steel".into(),
        members: vec![0, 1],
    });
    let options = |block: &str| PointOptions {
        blocks: Some(vec![block.into()]),
        ..Default::default()
    };
    assert_eq!(mesh.points(&options("steel")).unwrap().len(), 2);
    let problem = mesh.points(&options("glue")).unwrap_err();
    assert_eq!(
        problem.to_string(),
        "the mesh has no block \"glue\"; available: steel"
    );
}

#[test]
fn implausible_element_sizes_are_reported_with_both_positions() {
    // A cube of side 1 and one of side 0.1, disconnected.
    let mut mesh = RawMesh::default();
    for (place, side) in [(0.0, 1.0), (2.0, 0.1)] {
        let first = mesh.nodes.len() as u32;
        for [x, y, z] in [
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 1.0],
            [1.0, 1.0, 1.0],
            [0.0, 1.0, 1.0],
        ] {
            mesh.nodes.push([place + side * x, side * y, side * z]);
        }
        let corners: Vec<u32> = (first..first + 8).collect();
        mesh.cells.push(CellKind::Hexahedron, &corners);
    }
    let points = mesh.points(&PointOptions::default()).unwrap();
    let words: Vec<String> = points
        .check_sizes(1.5)
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(words.len(), 2, "{words:?}");
    assert!(words[0].starts_with("the horizon of 1.5 m spans fewer than 2 elements"));
    assert!(words[1].contains("a ratio above 8 : 1"));
    for words in &words {
        assert!(
            words.contains("from 0.1 m at (2.05, 0.05, 0.05) to 1 m at (0.5, 0.5, 0.5)"),
            "{words}"
        );
    }
    assert_eq!(points.check_sizes(2.0).len(), 1);
    mesh.nodes[8..].iter_mut().for_each(|x| {
        *x = [2.0 + 5.0 * (x[0] - 2.0), 5.0 * x[1], 5.0 * x[2]];
    });
    let points = mesh.points(&PointOptions::default()).unwrap();
    assert!(points.check_sizes(2.0).is_empty());
}
