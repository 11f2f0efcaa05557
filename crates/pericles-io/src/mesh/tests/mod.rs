//! The same tetrahedron in every format; truncated and corrupted files, and huge counts.

use super::*;
use crate::{VtkField, VtuFile};
use proptest::prelude::*;

mod files;

use files::{T, X, files, stl};

fn read(ending: &str, content: &[u8]) -> Result<Surface, MeshError> {
    let path = Path::new("surface").with_extension(ending);
    parse_surface(&path, content, u64::MAX)
}

#[test]
fn every_format_gives_the_same_surface() {
    let sorted = |surface: &Surface| {
        let mut triangles: Vec<_> = surface
            .triangles()
            .iter()
            .map(|t| t.map(|v| surface.positions()[v as usize].map(f64::to_bits)))
            .collect();
        triangles.sort_unstable();
        triangles
    };
    let given = Surface::new(X.to_vec(), T.to_vec()).unwrap();
    for (number, (ending, content)) in files().iter().enumerate() {
        let surface =
            read(ending, content).unwrap_or_else(|error| panic!("{ending} {number}: {error}"));
        assert_eq!(surface.len(), 4, "{ending} {number}");
        assert_eq!(sorted(&surface), sorted(&given), "{ending} {number}");
        surface.checked(Default::default()).unwrap();
    }
}

#[test]
fn polygons_are_split_into_triangle_fans() {
    let cube = "OFF\n8 6 12\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4 255 0 0\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";
    let (cube, report) = read("off", cube.as_bytes())
        .unwrap()
        .checked(Default::default())
        .unwrap();
    assert_eq!((cube.triangles().len(), report.volume), (12, 1.0));
}

#[test]
fn a_truncated_file_is_rejected() {
    for (number, (ending, content)) in files().iter().enumerate() {
        for length in 0..content.len() {
            match read(ending, &content[..length]) {
                // Formats without counts may end at any line: then triangles are missing, and the surface is
                // open.
                Ok(surface) => {
                    let whole = surface.triangles().len() == 4 && surface.positions().len() == 4;
                    let rest = content.len() - length;
                    assert!(
                        !whole || rest < 60 || surface.checked(Default::default()).is_err(),
                        "{ending} {number}: {length}"
                    );
                }
                Err(error) => assert!(!error.to_string().is_empty()),
            }
        }
    }
}

#[test]
fn huge_counts_and_wrong_words_are_rejected_with_their_location() {
    let text =
        |ending: &str, content: &str| read(ending, content.as_bytes()).unwrap_err().to_string();
    for (ending, content, parts) in [
        (
            "off",
            "OFF\n4000000000 4 6\n0 0 0\n",
            vec![":2: 4000000000 vertices are declared", "hold"],
        ),
        (
            "off",
            "OFF\n1 18446744073709551615 0\n0 0 0\n",
            vec![":2: ", "faces are declared"],
        ),
        (
            "off",
            "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000 0 1 2\n",
            vec![":6: 2000 corners"],
        ),
        (
            "off",
            "OFF\n3 1 0\n0 0 0\n1 x 0\n",
            vec![":4: \"x\" is not a coordinate"],
        ),
        ("off", "FOO", vec![":1: ", "\"FOO\""]),
        (
            "obj",
            "v 0 0 0\nf 1 2 0\n",
            vec![":2: \"0\" is not a valid corner", "from 1"],
        ),
        (
            "obj",
            "v 0 0 0\nv 1 0 0\nf 1 2\n",
            vec![":3: the face has 2 corner(s)", "at least 3"],
        ),
        (
            "obj",
            "v 0 0 0\nf 1 2 3\n",
            vec!["triangle 0 refers to vertex 1", "vertices 0 to 0 only"],
        ),
        ("obj", "hello", vec!["no triangles"]),
        (
            "ply",
            "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\nend_header\n",
            vec!["99999999999 elements \"vertex\""],
        ),
        (
            "ply",
            "ply\nformat binary 1.0\n",
            vec![":2: unknown format \"binary\"; allowed: ascii"],
        ),
        (
            "ply",
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n",
            vec![":4: unknown type \"half\"; allowed: char"],
        ),
        ("stl", "solid a\nfacet\n", vec!["expected endsolid"]),
        (
            "stl",
            "short",
            vec!["byte 0", "80 more byte(s) expected, 5 left"],
        ),
        (
            "msh",
            "$MeshFormat\n3.0 0 8\n$EndMeshFormat\n",
            vec![":2: unsupported version 3.0; allowed: 2.2 and 4.1"],
        ),
        (
            "msh",
            "$Nodes\n1\n",
            vec![":1: $Nodes appears before $MeshFormat"],
        ),
        (
            "msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n777777777\n",
            vec![":5: 777777777 nodes are declared"],
        ),
        (
            "msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Elements\n1\n1 2 0 1 2 3\n$EndElements",
            vec![":6: an element refers to node 1"],
        ),
        (
            "vtu",
            "<VTKFile><UnstructuredGrid></UnstructuredGrid></VTKFile>",
            vec!["the array Points is missing"],
        ),
        ("vtp", "</VTKFile>", vec!["the element VTKFile is missing"]),
        ("vtp", "nothing", vec!["expected </VTKFile>"]),
        ("stp", "", vec!["allowed file extensions: .obj, .ply"]),
    ] {
        let message = text(ending, content);
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    let mut many = stl(true);
    many[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let message = read("stl", &many).unwrap_err().to_string();
    assert!(
        message.contains("4294967295 triangles are declared") && message.contains("hold at most 4"),
        "{message}"
    );
    assert!(matches!(
        read_surface("no/such/file.obj", u64::MAX),
        Err(MeshError::Io(crate::IoError::NotFound { .. }))
    ));
}

#[test]
fn written_points_are_read_back() {
    // More than one compressed block, 64-bit headers; the cells are single points, so that no triangle is found.
    let n = 3000;
    let x: Vec<f64> = (0..3 * n).map(|k| (0.37 * k as f64).sin()).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.vtu");
    let field: Vec<f64> = x[..n].to_vec();
    VtuFile::new(3, &x)
        .field(VtkField::scalar("Points", &field))
        .write(&path)
        .unwrap();
    let alone = |_: &str| Err(String::new());
    let content = std::fs::read(path).unwrap();
    let mesh = Format::Vtk.parse(&content, u64::MAX, &alone).unwrap();
    assert!(mesh.triangles().is_empty());
    let expected: Vec<[f64; 3]> = (0..n).map(|i| [x[i], x[n + i], x[2 * n + i]]).collect();
    assert_eq!(mesh.nodes, expected);
}

#[test]
fn a_written_surface_is_read_back() {
    let sphere = Surface::icosphere(3, 0.7).unwrap();
    let x = sphere.positions();
    let positions: Vec<f64> = (0..3).flat_map(|c| x.iter().map(move |x| x[c])).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sphere.vtu");
    VtuFile::new(3, &positions)
        .triangles(sphere.triangles())
        .field(VtkField::scalar("Height", &positions[2 * x.len()..]))
        .write(&path)
        .unwrap();
    let read = read_surface(&path, u64::MAX).unwrap();
    assert_eq!(read.positions(), x);
    assert_eq!(read.triangles(), sphere.triangles());
}

#[test]
fn meshes_are_read_with_included_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bar.inp");
    std::fs::write(
        &path,
        "*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=C3D4, ELSET=all\n1, 1, 2, 3, 4\n",
    )
    .unwrap();
    let message = read_mesh(&path, u64::MAX).unwrap_err().to_string();
    assert!(
        message.contains("bar.inp:1: ") && message.contains("nodes.inp does not exist"),
        "{message}"
    );
    let nodes = folder.path().join("nodes.inp");
    std::fs::write(&nodes, "*NODE\n1, 0\n2, 1\n3, 0, 1\n4, 0, 0, 1\n").unwrap();
    let mesh = read_mesh(&path, u64::MAX).unwrap();
    assert_eq!(
        (mesh.nodes.len(), mesh.cells.len(), mesh.groups.len()),
        (4, 1, 1)
    );
    // An error in an included file names that file.
    std::fs::write(&nodes, "*NODE\n1, zero\n").unwrap();
    let message = read_mesh(&path, u64::MAX).unwrap_err().to_string();
    assert!(
        message.contains("nodes.inp:2: \"zero\" is not a number"),
        "{message}"
    );
    let message = parse_mesh("bar.stp", b"", u64::MAX)
        .unwrap_err()
        .to_string();
    assert_eq!(
        message,
        "bar.stp: unknown mesh format; allowed file extensions: .obj, .ply, .stl, .off, .msh, .vtu, .vtp, .inp, .e, .exo, .ex2, .g, .gen"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]
    #[test]
    fn corrupted_files_never_cause_a_panic(file in 0usize..20, changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
                                 cut in any::<prop::sample::Index>()) {
        let files = files();
        let (ending, content) = &files[file % files.len()];
        let mut content = content.clone();
        for (place, byte) in changes {
            let place = place.index(content.len());
            content[place] = byte;
        }
        for length in [content.len(), cut.index(content.len() + 1)] {
            if let Ok(surface) = read(ending, &content[..length]) {
                let _ = surface.checked(Default::default());
            }
        }
    }
}
