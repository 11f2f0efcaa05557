//! Mesh readers: one mesh in all formats, format-specific features, and damaged files.

mod cdf;
mod files;
mod unusual;

use std::path::Path;

use pericles_mesh::{CellKind, Fault, Format, MeshPoints, Place, PointOptions, RawMesh, SetKind};
use proptest::prelude::*;

fn alone(name: &str) -> Result<Vec<u8>, String> {
    Err(format!("{name} does not exist"))
}

fn read(ending: &str, content: &[u8]) -> Result<RawMesh, Fault> {
    let format = Format::of(&Path::new("mesh").with_extension(ending)).unwrap();
    format.parse(content, 1 << 26, &alone)
}

fn points(ending: &str, content: &[u8]) -> (RawMesh, MeshPoints) {
    let mesh = read(ending, content).unwrap_or_else(|fault| panic!("{ending}: {fault}"));
    let points = mesh.points(&PointOptions::default()).unwrap();
    (mesh, points)
}

fn set(points: &MeshPoints, name: &str) -> (SetKind, Vec<u32>) {
    let found = points.set(name).unwrap_or_else(|| {
        let names: Vec<&str> = points.sets.iter().map(|set| set.name.as_str()).collect();
        panic!("no set {name:?} among {names:?}")
    });
    (found.kind, found.points.clone())
}

#[test]
fn every_format_gives_the_same_points_and_sets() {
    for (number, (ending, content)) in files::all().iter().enumerate() {
        let (_, points) = points(ending, content);
        assert_eq!(points.len(), 2, "{ending} {number}");
        assert_eq!(points.dimension, 3);
        for (volume, expected) in points.volumes.iter().zip([1.0, 0.5]) {
            assert!((volume - expected).abs() < 1e-14);
        }
        let centroids = [[0.5; 3], [4.0 / 3.0, 1.0 / 3.0, 0.5]];
        for (x, expected) in points.positions.iter().zip(centroids) {
            assert!((0..3).all(|c| (x[c] - expected[c]).abs() < 1e-14), "{x:?}");
        }
        if *ending == "vtu" {
            assert_eq!(set(&points, "Material 1"), (SetKind::Elements, vec![0]));
            assert_eq!(set(&points, "Material 2"), (SetKind::Elements, vec![1]));
            assert_eq!(points.sets.len(), 2);
            continue;
        }
        assert_eq!(
            set(&points, "left part"),
            (SetKind::Elements, vec![0]),
            "{ending} {number}"
        );
        assert_eq!(set(&points, "right"), (SetKind::Elements, vec![1]));
        assert_eq!(set(&points, "tip"), (SetKind::Nodes, vec![1]));
        assert_eq!(set(&points, "x0"), (SetKind::Faces, vec![0]));
        assert_eq!(points.set("x0").unwrap().area, Some(1.0));
        let all = match *ending {
            "exo" => "elemset_3",
            "inp" => "ALL",
            // The name of the set of all points of a deck.
            _ => "all (elements)",
        };
        assert_eq!(set(&points, all), (SetKind::Elements, vec![0, 1]));
    }
}

#[test]
fn byte_order_marks_and_windows_line_endings_are_ignored() {
    let text = String::from_utf8(files::abaqus()).unwrap();
    let windows = format!("\u{feff}{}", text.replace('\n', "\r\n"));
    let (plain, other) = (
        read("inp", text.as_bytes()),
        read("inp", windows.as_bytes()),
    );
    let (plain, other) = (plain.unwrap(), other.unwrap());
    assert_eq!(plain.nodes, other.nodes);
    let sets = |mesh: &RawMesh| mesh.points(&PointOptions::default()).unwrap().sets;
    assert_eq!(sets(&plain), sets(&other));
}

#[test]
fn gmsh_2_elements_listed_in_two_groups_are_merged() {
    let (mesh, _) = points("msh", &files::gmsh_2(false));
    assert_eq!(
        mesh.cells.counts(),
        [
            (CellKind::Point, 1),
            (CellKind::Quadrilateral, 1),
            (CellKind::Wedge, 1),
            (CellKind::Hexahedron, 1)
        ]
    );
    let numbers: Vec<u64> = (0..4).map(|cell| mesh.cells.number(cell)).collect();
    assert_eq!(numbers, [1, 2, 3, 4]);
}

#[test]
fn abaqus_node_and_element_sets_may_share_a_name() {
    let (_, points) = points("inp", &files::abaqus());
    // The element set keeps the name; nodes 2 and 3 belong to both elements.
    assert_eq!(set(&points, "right (nodes)"), (SetKind::Nodes, vec![0, 1]));
    assert_eq!(set(&points, "both"), (SetKind::Elements, vec![0, 1]));
    // Free faces: five squares of the cube, two triangles, a square and a rectangle of the wedge.
    let free = points.set("free").unwrap();
    assert!((free.area.unwrap() - (5.0 + 2.0 * 0.5 + 1.0 + 2f64.sqrt())).abs() < 1e-14);
}

const PART: &str = "*PART, NAME=Bar\n*NODE\n1, 0, 0, 0\n2, 2, 0, 0\n3, 2, 1, 0\n4, 0, 1, 0\n5, 0, 0, 1\n6, 2, 0, 1\n7, 2, 1, 1\n8, 0, 1, 1\n\
    *ELEMENT, TYPE=C3D8, ELSET=Solid\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*NSET, NSET=End\n1, 4, 5, 8\n*END PART\n";

#[test]
fn instances_are_translated_then_rotated_and_prefix_their_sets() {
    // The second instance is translated by 3 along x, then rotated by 90° about the axis x = 3, y = 0.
    let file = format!(
        "{PART}*ASSEMBLY, NAME=A\n*INSTANCE, NAME=One, PART=Bar\n*END INSTANCE\n*INSTANCE, NAME=Two, PART=bar\n3., 0., 0.\n3., 0., 0., 3., 0., 1., 90.\n*END INSTANCE\n\
         *ELSET, ELSET=Picked, INSTANCE=Two, INTERNAL\n1\n*ELSET, ELSET=Mine, INSTANCE=Two\n1\n*SURFACE, NAME=Top\nPicked, S2\n*NSET, NSET=Ends\nOne.End, Two.End\n*END ASSEMBLY\n"
    );
    let (mesh, points) = points("inp", file.as_bytes());
    assert_eq!(points.len(), 2);
    let [a, b] = [points.positions[0], points.positions[1]];
    assert!(
        (0..3).all(|c| (a[c] - [1.0, 0.5, 0.5][c]).abs() < 1e-14),
        "{a:?}"
    );
    assert!(
        (0..3).all(|c| (b[c] - [2.5, 1.0, 0.5][c]).abs() < 1e-14),
        "{b:?}"
    );
    assert_eq!(set(&points, "One.Solid"), (SetKind::Elements, vec![0]));
    assert_eq!(set(&points, "Two.Solid"), (SetKind::Elements, vec![1]));
    assert_eq!(set(&points, "Two.End"), (SetKind::Nodes, vec![1]));
    assert_eq!(set(&points, "Ends"), (SetKind::Nodes, vec![0, 1]));
    assert_eq!(set(&points, "Mine"), (SetKind::Elements, vec![1]));
    assert_eq!(set(&points, "Top"), (SetKind::Faces, vec![1]));
    assert!((points.set("Top").unwrap().area.unwrap() - 2.0).abs() < 1e-14);
    assert!(points.set("Picked").is_none());
    assert_eq!(mesh.cells.number(1), 2);
}

#[test]
fn a_mesh_may_be_defined_within_its_instance() {
    let inside = PART
        .replace("*PART, NAME=Bar\n", "")
        .replace("*END PART\n", "");
    let file = format!(
        "*PART, NAME=Bar\n*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=One, PART=Bar\n0, 0, 5\n{inside}*END INSTANCE\n*END ASSEMBLY\n"
    );
    let (_, points) = points("inp", file.as_bytes());
    assert_eq!(points.positions[0][2], 5.5);
    // One instance only: no prefix.
    assert_eq!(set(&points, "Solid"), (SetKind::Elements, vec![0]));
}

#[test]
fn parts_without_instances_and_included_files_are_read() {
    let (_, parts) = points("inp", PART.as_bytes());
    assert_eq!(parts.len(), 1);
    let include = |name: &str| match name {
        "part.inp" => Ok(PART.as_bytes().to_vec()),
        "loop.inp" => Ok(b"*INCLUDE, INPUT=loop.inp\n".to_vec()),
        "bad.inp" => Ok(b"*NODE\n1, x\n".to_vec()),
        _ => Err(format!("{name} does not exist")),
    };
    let parse = |content: &str| Format::Abaqus.parse(content.as_bytes(), u64::MAX, &include);
    let mesh = parse("*include, input=part.inp\n").unwrap();
    assert_eq!(mesh.cells.len(), 1);
    let fault = parse("\n*INCLUDE, INPUT=gone.inp\n").unwrap_err();
    assert_eq!(
        (fault.place, fault.reason.as_str()),
        (Place::Line(2), "gone.inp does not exist")
    );
    let fault = parse("*INCLUDE, INPUT=bad.inp\n").unwrap_err();
    assert_eq!(
        (fault.included.as_deref(), fault.place),
        (Some("bad.inp"), Place::Line(2))
    );
    let fault = parse("*INCLUDE, INPUT=loop.inp\n").unwrap_err();
    assert!(fault.reason.contains("at most 8 nested files"), "{fault}");
}

#[test]
fn exodus_spheres_have_given_volumes() {
    use cdf::{Values, variable};
    let dimensions = [
        ("time_step", 0),
        ("num_dim", 3),
        ("num_nodes", 2),
        ("num_el_blk", 1),
        ("one", 1),
        ("two", 2),
    ];
    let mut connect = variable("connect1", &[2, 4], Values::Int(vec![2, 1]));
    connect.attribute = Some(("elem_type", "SPHERE".into()));
    let file = cdf::file(
        2,
        &dimensions,
        &[
            variable(
                "coord",
                &[1, 2],
                Values::Double(vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]),
            ),
            variable("eb_prop1", &[3], Values::Int(vec![7])),
            connect,
            variable("attrib1", &[2, 5], Values::Double(vec![0.1, 8.0, 0.2, 1.0])),
        ],
    );
    let (_, points) = points("g", &file);
    assert_eq!(points.volumes, [8.0, 1.0]);
    assert_eq!(points.positions, [[1.0, 3.0, 5.0], [0.0, 2.0, 4.0]]);
    assert_eq!(points.sizes, [2.0, 1.0]);
    assert_eq!(set(&points, "block_7"), (SetKind::Elements, vec![0, 1]));
}

#[test]
fn second_order_elements_are_reduced_to_their_corners() {
    // A quadratic tetrahedron of VTK and of Gmsh, whose mid-side nodes are ordered differently.
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let middle = |a: usize, b: usize| [0, 1, 2].map(|c| 0.5 * (corners[a][c] + corners[b][c]));
    let ends = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)];
    let all: Vec<[f64; 3]> = corners
        .into_iter()
        .chain(ends.map(|(a, b)| middle(a, b)))
        .collect();
    let words: Vec<String> = all
        .iter()
        .map(|x| format!("{} {} {}", x[0], x[1], x[2]))
        .collect();
    let nodes: Vec<String> = (1..)
        .zip(&words)
        .map(|(k, w)| format!("{k} {w}\n"))
        .collect();
    let msh = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n{}$EndNodes\n$Elements\n1\n1 11 0 1 2 3 4 5 6 7 8 10 9\n$EndElements\n",
        nodes.concat()
    );
    let vtu = format!(
        "<VTKFile><UnstructuredGrid><Points><DataArray type='Float32' format='ascii'>{}</DataArray></Points><Cells><DataArray type='Int32' Name='connectivity' format='ascii'>0 1 2 3 4 5 6 7 8 9</DataArray><DataArray type='Int32' Name='offsets' format='ascii'>10</DataArray><DataArray type='Int32' Name='types' format='ascii'>24</DataArray></Cells></UnstructuredGrid></VTKFile>",
        words.join(" ")
    );
    for (ending, content) in [("msh", msh), ("vtu", vtu)] {
        let (_, points) = points(ending, content.as_bytes());
        assert!((points.volumes[0] - 1.0 / 6.0).abs() < 1e-15, "{ending}");
    }
}

#[test]
fn surfaces_are_read_as_triangles_and_quadrilaterals() {
    let off = "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 2 0\n4 0 1 2 3\n5 0 1 2 4 3\n";
    let mesh = read("off", off.as_bytes()).unwrap();
    assert_eq!(
        mesh.cells.counts(),
        [(CellKind::Triangle, 3), (CellKind::Quadrilateral, 1)]
    );
    assert_eq!(
        mesh.triangles(),
        [[0, 1, 2], [0, 2, 3], [0, 1, 2], [0, 2, 4], [0, 4, 3]]
    );
}

#[test]
fn errors_report_their_location_and_what_is_allowed() {
    let fault = |ending: &str, content: &[u8]| read(ending, content).unwrap_err().to_string();
    for (ending, content, parts) in [
        (
            "inp",
            "*NODE\n1, 0, 0\n2, x, 0\n",
            vec![":3: \"x\" is not a number"],
        ),
        (
            "inp",
            "*NODE\n1, 0\n1, 1\n",
            vec![":3: node 1 is defined twice"],
        ),
        ("inp", "*ELEMENT\n", vec![":1: *ELEMENT has no TYPE"]),
        (
            "inp",
            "*NODE\n1, 0\n*ELEMENT, TYPE=T3D2\n5, 1, 9\n",
            vec![":4: element 5 refers to node 9"],
        ),
        (
            "inp",
            "*ELEMENT, TYPE=C3D4\n5, 1, 2, 3\n*STEP\n",
            vec![":3: element 5 (C3D4) has 3 nodes; expected 4"],
        ),
        (
            "inp",
            "*NODE, SYSTEM=C\n",
            vec![":1: the nodes are given in the coordinate system C; allowed: R"],
        ),
        (
            "inp",
            "*NGEN\n",
            vec![":1: *NGEN generates nodes", "write the complete mesh"],
        ),
        (
            "inp",
            "*ELSET, ELSET=A, GENERATE\n1, 5, 0\n",
            vec![":2: ", "a positive step"],
        ),
        (
            "inp",
            "*ELSET, ELSET=A\nA\n",
            vec!["the set \"A\" refers to itself"],
        ),
        (
            "inp",
            "*INSTANCE, NAME=I, PART=P\n",
            vec!["the instance \"I\" has no mesh, and its part is not defined"],
        ),
        (
            "inp",
            "*NODE\n1, 0\n*ELEMENT, TYPE=S3, ELSET=E\n1, 1, 1, 1\n*SURFACE, NAME=F\nE, S9\n",
            vec!["face S9 of element 1 (tri)", "3 faces"],
        ),
        ("exo", "nothing", vec!["byte 0", "CDF"]),
        ("exo", "\u{89}HDF", vec!["CDF"]),
        (
            "exo",
            "CDF\u{1}\0\0\0\0\0\0\0\u{a}\u{7f}\0\0\0",
            vec!["2130706432 dimensions are declared", "hold"],
        ),
        (
            "msh",
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n999999 0 0 0\n",
            vec![":5: 999999 entities are declared"],
        ),
        (
            "vtu",
            "<VTKFile><UnstructuredGrid><Points><DataArray type='Float32' format='ascii'>0 0 0</DataArray></Points><Cells><DataArray type='Int32' Name='connectivity' format='ascii'>0 0 0</DataArray><DataArray type='Int32' Name='offsets' format='ascii'>3</DataArray><DataArray type='Int32' Name='types' format='ascii'>12</DataArray></Cells></UnstructuredGrid></VTKFile>",
            vec!["cell 0 (hex) has 3 corners; expected 8"],
        ),
    ] {
        let message = fault(ending, content.as_bytes());
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    // An element refers to a node that does not exist.
    let mut wrong = files::exodus(2);
    let place = wrong
        .windows(4)
        .rposition(|w| w == 9i32.to_be_bytes())
        .unwrap();
    wrong[place + 3] = 99;
    assert!(fault("e", &wrong).contains("refers to node 99; nodes are numbered 1 to 10"));
}

/// Calls all functions that follow a reader; none may panic.
fn use_all(ending: &str, content: &[u8]) {
    if let Ok(mesh) = read(ending, content) {
        let _ = mesh.check();
        let _ = mesh.triangles();
        if let Ok(points) = mesh.points(&PointOptions::default()) {
            let _ = pericles_mesh::Summary::new(&mesh, &points, 1.0);
        }
        if let Ok(surface) = pericles_mesh::fill::TriangleSurface::of_mesh(&mesh, 1.0) {
            let _ = surface.bounds();
        }
    }
}

#[test]
fn every_truncated_file_is_read_or_rejected() {
    for (ending, content) in files::all() {
        for length in 0..content.len() {
            use_all(ending, &content[..length]);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]
    #[test]
    fn corrupted_files_never_cause_a_panic(file in 0usize..20, changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
                                 cut in any::<prop::sample::Index>()) {
        let files = files::all();
        let (ending, content) = &files[file % files.len()];
        let mut content = content.clone();
        for (place, byte) in changes {
            let place = place.index(content.len());
            content[place] = byte;
        }
        use_all(ending, &content);
        use_all(ending, &content[..cut.index(content.len() + 1)]);
    }
}
