//! Bodies from meshes, closed surfaces and outlines, and random points.

use std::path::Path;

use pericles::operator::PointSubset;
use pericles::space::PointCloud;
use pericles_deck::{Deck, DeckError};
use pericles_mesh::{CellKind, Cells, FaceSet, NamedList, RawMesh};
use pericles_run::{FileError, Resources};

use crate::common::{Build, Built};

/// Returns a box of nx × ny × nz cubes of 1 mm, in mm, optionally cut into six tetrahedra each, with the groups "left
/// half" and "right half" and the faces at both ends along x.
pub(super) fn block(counts: [usize; 3], tetrahedra: bool) -> RawMesh {
    let [nx, ny, nz] = counts;
    let node = |i: usize, j: usize, k: usize| ((k * (ny + 1) + j) * (nx + 1) + i) as u32;
    let mut mesh = RawMesh::default();
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                mesh.nodes.push([i, j, k].map(|x| x as f64));
            }
        }
    }
    let mut halves = [Vec::new(), Vec::new()];
    let (mut left, mut right) = (Cells::default(), Cells::default());
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let c = [
                    node(i, j, k),
                    node(i + 1, j, k),
                    node(i + 1, j + 1, k),
                    node(i, j + 1, k),
                    node(i, j, k + 1),
                    node(i + 1, j, k + 1),
                    node(i + 1, j + 1, k + 1),
                    node(i, j + 1, k + 1),
                ];
                let begin = mesh.cells.len() as u32;
                if tetrahedra {
                    // All share the diagonal from corner 0 to corner 6.
                    for [a, b] in [[1, 2], [2, 3], [3, 7], [7, 4], [4, 5], [5, 1]] {
                        let corners = [c[0], c[a], c[b], c[6]];
                        mesh.cells.push(CellKind::Tetrahedron, &corners);
                    }
                } else {
                    mesh.cells.push(CellKind::Hexahedron, &c);
                }
                halves[usize::from(2 * i >= nx)].extend(begin..mesh.cells.len() as u32);
                let face = |set: &mut Cells, q: [usize; 4]| {
                    if tetrahedra {
                        // The diagonals of the cut.
                        set.push(CellKind::Triangle, &[c[q[0]], c[q[1]], c[q[2]]]);
                        set.push(CellKind::Triangle, &[c[q[0]], c[q[2]], c[q[3]]]);
                    } else {
                        set.push(CellKind::Quadrilateral, &q.map(|corner| c[corner]));
                    }
                };
                if i == 0 {
                    face(&mut left, [0, 3, 7, 4]);
                }
                if i + 1 == nx {
                    face(&mut right, [6, 2, 1, 5]);
                }
            }
        }
    }
    let [left_half, right_half] = halves;
    mesh.groups = vec![
        NamedList {
            name: "left half".into(),
            members: left_half,
        },
        NamedList {
            name: "right half".into(),
            members: right_half,
        },
    ];
    mesh.face_sets = vec![
        FaceSet {
            name: "left".into(),
            faces: left,
        },
        FaceSet {
            name: "right".into(),
            faces: right,
        },
    ];
    mesh
}

/// Returns the triangulated surface of a cube of 8 mm, in mm.
pub(super) fn cube() -> RawMesh {
    let mut mesh = RawMesh::default();
    for k in 0..8 {
        mesh.nodes
            .push([k & 1, k >> 1 & 1, k >> 2].map(|x| 8.0 * f64::from(x)));
    }
    for q in [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ] {
        mesh.cells.push(CellKind::Triangle, &[q[0], q[1], q[2]]);
        mesh.cells.push(CellKind::Triangle, &[q[0], q[2], q[3]]);
    }
    mesh
}

fn built_of(
    text: &str,
    read: impl Fn(&Path) -> Result<RawMesh, FileError> + Sync,
) -> Result<Built, DeckError> {
    let deck = Deck::parse(text, "deck.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    deck.build_with(Resources {
        read_mesh: &|path, _| read(path),
        ..Resources::default()
    })
}

pub(super) fn built(text: &str, mesh: &RawMesh) -> Built {
    built_of(text, |_| Ok(mesh.clone())).unwrap_or_else(|error| panic!("{error}"))
}

pub(super) fn rejected(text: &str, mesh: &RawMesh) -> String {
    match built_of(text, |_| Ok(mesh.clone())) {
        Ok(_) => panic!("an error is expected:\n{text}"),
        Err(error) => error.to_string(),
    }
}

const MESH: &str = r#"
[body]
shape = "mesh"
file = "block.msh"
unit = "mm"
[material]
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon = "3 mm"
[sets]
grip = { near_faces = { faces = "left", depth = "2.1 mm" } }
far = { where = "x > 0.007" }
[[load]]
set = "right"
pressure = "-1 MPa"
[[load]]
set = "left"
traction = ["-1 MPa", 0, 0]
[[load]]
set = "grip"
traction = ["2 MPa", 0, 0]
[time]
end = "1 us"
"#;

#[test]
fn elements_become_points_and_mesh_sets_become_sets() {
    let mesh = block([8, 3, 2], false);
    let body = built(MESH, &mesh);
    let close = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} {b}");
    assert_eq!(body.cloud.len(), 48);
    close(body.cloud.spacing(), 1e-3);
    let sizes: Vec<(&str, usize)> = body
        .sets
        .iter()
        .map(|(name, points)| (name.as_str(), points.len()))
        .collect();
    assert_eq!(
        sizes,
        [
            ("all", 48),
            ("left half", 24),
            ("right half", 24),
            ("left", 6),
            ("right", 6),
            ("grip", 12),
            ("far", 6)
        ]
    );
    // User numbers are the element numbers.
    for i in 0..48 {
        let [x, y, z] = body
            .cloud
            .point(i)
            .map(|x| (x * 1e3 - 0.5).round() as usize);
        assert_eq!(body.cloud.user_number(i), (z * 3 + y) * 8 + x);
        assert_eq!(body.cloud.block(i), if x < 4 { 1 } else { 2 });
    }
    // Areas are known, and a pressure acts against the outward normal; compared as forces.
    for (report, force) in body.loads.iter().zip([6.0, -6.0, 12.0]) {
        close(report.area.unwrap(), 6e-6);
        close(report.force[0], force);
        assert!(report.force[1].abs() + report.force[2].abs() < 1e-12);
    }
}

#[test]
fn a_mesh_of_cubes_has_the_forces_of_the_grid() {
    let mesh = block([8, 3, 2], false);
    let text = MESH.split("[sets]").next().unwrap().to_owned() + "[time]\nend = \"1 us\"\n";
    let grid = text.replace(
        "shape = \"mesh\"\nfile = \"block.msh\"\nunit = \"mm\"",
        "shape = \"block\"\nsize = [\"8 mm\", \"3 mm\", \"2 mm\"]\nspacing = \"1 mm\"",
    );
    let (ours, theirs) = (built(&text, &mesh), super::build(&grid));
    compare_forces(&ours, &theirs);
}

/// Compares the forces of two assemblies of equal points, under one displacement.
pub(super) fn compare_forces(ours: &Built, theirs: &Built) {
    let n = theirs.cloud.len();
    assert_eq!(ours.cloud.len(), n);
    let forces = |body: &Built| {
        let dimension = body.cloud.dimension();
        let place = |i: usize| body.cloud.point(i).map(|x| 1e3 * x);
        let along = |c: usize| {
            (0..n).map(move |i| {
                let [x, y, z] = place(i);
                1e-6 * [x * x - y, 0.5 * y * x, z + 0.1 * x * y][c]
            })
        };
        let u: Vec<f64> = (0..dimension).flat_map(along).collect();
        let mut force = vec![0.0; dimension * n];
        let operator = body.system.operator();
        operator.add_force(0.0, &u, PointSubset::All, &mut force);
        force
    };
    let (a, b) = (forces(ours), forces(theirs));
    let scale = b.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
    assert!(scale > 0.0);
    for i in 0..n {
        let twin = theirs.cloud.nearest(ours.cloud.point(i));
        for c in 0..ours.cloud.dimension() {
            let difference = a[c * n + i] - b[c * n + twin];
            assert!(
                difference.abs() < 1e-10 * scale,
                "{i}: {difference} {scale}"
            );
        }
    }
}

#[test]
fn pressures_on_tetrahedra_have_the_resultant_of_their_faces() {
    let mesh = block([6, 3, 3], true);
    let body = built(&MESH.replace("x > 0.007", "x > 0.005"), &mesh);
    assert_eq!(body.cloud.len(), 324);
    let volume: f64 = body.cloud.volumes().iter().sum();
    assert!((volume / 54e-9 - 1.0).abs() < 1e-12);
    for (report, force) in body.loads.iter().zip([9.0, -9.0, 18.0]) {
        assert!((report.force[0] / force - 1.0).abs() < 1e-12, "{report:?}");
        assert!(report.force[1].abs() + report.force[2].abs() < 1e-12);
    }
}

#[test]
fn a_material_can_be_assigned_to_a_mesh_group() {
    let part = "[materials.soft]\ndensity = 1200\nyoungs_modulus = \"3 GPa\"\n[[assign]]\nset = \"right half\"\nmaterial = \"soft\"\n[sets]";
    let body = built(&MESH.replacen("[sets]", part, 1), &block([8, 3, 2], false));
    assert_eq!(body.other_materials.len(), 1);
}

#[test]
fn invalid_meshes_are_reported_at_their_key() {
    let mesh = block([8, 3, 2], false);
    let with = |from: &str, to: &str| {
        assert!(MESH.contains(from), "{from}");
        MESH.replacen(from, to, 1)
    };
    let says = |text: &str, mesh: &RawMesh, parts: &[&str]| {
        let error = rejected(text, mesh);
        for part in parts {
            assert!(error.contains(part), "{part}:\n{error}");
        }
    };
    says(
        &with("set = \"right\"", "set = \"rigth\""),
        &mesh,
        &[
            "deck.toml:14:7",
            "unknown set `rigth`",
            "did you mean `right`?",
            "\"right\"",
            "\"left half\"",
        ],
    );
    says(
        &with("faces = \"left\"", "faces = \"left half\""),
        &mesh,
        &[
            "deck.toml:11:",
            "unknown face set `left half`",
            "\"left\" and \"right\"",
        ],
    );
    says(
        &with("far =", "left ="),
        &mesh,
        &[
            "deck.toml:12:",
            "`left` cannot be used",
            "has a set of this name",
        ],
    );
    says(
        &with("unit = \"mm\"", "unit = \"mm\"\nblocks = \"steel\""),
        &mesh,
        &[
            "deck.toml:6:10",
            "unknown block `steel`",
            "\"left half\" and \"right half\"",
        ],
    );
    let plane = with(
        "unit = \"mm\"",
        "unit = \"mm\"\ndimension = 2\nplane = \"stress\"",
    );
    let plane = plane.split("[sets]").next().unwrap().to_owned() + "[time]\nend = 1e-6\n";
    says(
        &plane,
        &mesh,
        &[
            "deck.toml:6:13",
            "the mesh have dimension 3",
            "set dimension = 3",
        ],
    );
    says(
        &with("unit = \"mm\"", "unit = \"mm\"\nspacing = \"1 m\"")
            .replace("horizon = \"3 mm\"", "horizon = \"3 m\""),
        &mesh,
        &[
            "deck.toml:6:11",
            "mean element size is 1.00 mm",
            "correct `unit`",
        ],
    );
    says(
        &with("set = \"right\"", "set = \"far\""),
        &mesh,
        &[
            "deck.toml:15:",
            "`far` has no face",
            "face set of a mesh, or a `layer`",
        ],
    );
    says(
        &with("set = \"left\"\ntraction", "set = \"far\"\ntraction"),
        &mesh,
        &["is unknown", "neither a face set of the mesh"],
    );
    let folded = {
        let mut mesh = mesh.clone();
        // A corner of the last element pulled through the opposite face.
        let last = mesh.nodes.len() - 1;
        mesh.nodes[last] = [6.2, 2.2, 0.3];
        mesh
    };
    says(
        MESH,
        &folded,
        &["deck.toml:4:8", "block.msh: element 48 (hex) is folded"],
    );
    let flat = {
        let mut mesh = mesh.clone();
        mesh.nodes.iter_mut().for_each(|x| x[2] = 0.0);
        mesh
    };
    says(
        MESH,
        &flat,
        &[
            "deck.toml:4:8",
            "48 element(s) have zero volume, the first is element 1",
        ],
    );
    says(
        MESH,
        &cube(),
        &["deck.toml:4:8", "z from 0 to 8", "plane of constant z"],
    );
    let error = built_of(MESH, |path| {
        Err(format!("{}: not there", path.display()).into())
    });
    let error = error.map(|_| ()).unwrap_err().to_string();
    assert!(
        error.contains("deck.toml:4:8: block.msh: not there"),
        "{error}"
    );
}

#[test]
fn unusual_meshes_lead_to_warnings() {
    let warnings = |text: &str, mesh: &RawMesh| {
        let body = built(text, mesh);
        let lines: Vec<String> = body.warnings.iter().map(|warning| warning.line()).collect();
        lines.join("\n")
    };
    let mesh = block([8, 3, 2], false);
    assert_eq!(warnings(MESH, &mesh), "");
    let coarse = warnings(&MESH.replace("\"3 mm\"", "\"1.5 mm\""), &mesh);
    // All elements are equal: the first one is smallest and largest.
    for part in [
        "deck.toml:4:8",
        "the horizon of 0.0015 m spans fewer than 2 elements",
        "sizes range from 0.001 m at (5e-4, 5e-4, 5e-4) to 0.001 m at (",
        "refine the mesh",
    ] {
        assert!(coarse.contains(part), "{part}: {coarse}");
    }
    let graded = {
        // The last layer of elements is a tenth as thick along all axes: 0.1 mm next to 1 mm.
        let mut mesh = mesh.clone();
        let first = mesh.nodes.len() as u32;
        for k in 0..8 {
            let corner = [k & 1, k >> 1 & 1, k >> 2];
            mesh.nodes.push(corner.map(|x| 20.0 + 0.1 * f64::from(x)));
        }
        let corners = [0, 1, 3, 2, 4, 5, 7, 6].map(|k| first + k);
        mesh.cells.push(CellKind::Hexahedron, &corners);
        warnings(MESH, &mesh)
    };
    for part in [
        "deck.toml:4:8",
        "sizes range from 1e-4 m at (0.02005, 0.02005, 0.02005) to 0.001 m at (",
        "a ratio above 8 : 1",
    ] {
        assert!(graded.contains(part), "{part}: {graded}");
    }
    let metres = MESH
        .replace("unit = \"mm\"", "unit = \"um\"")
        .replace("\"3 mm\"", "\"3 um\"")
        .replace("2.1 mm", "2.1 um")
        .replace("0.007", "0.000007");
    let tiny = warnings(&metres, &mesh);
    assert!(tiny.contains("check the unit of the file"), "{tiny}");
    // 8 m, in kilometres: accepted in metres, a warning beyond 100 m.
    let huge = MESH
        .replace("unit = \"mm\"", "unit = \"km\"")
        .replace("\"3 mm\"", "\"3 km\"")
        .replace("2.1 mm", "2.1 km")
        .replace("0.007", "7000");
    let huge = warnings(&huge, &mesh);
    assert!(
        huge.contains("the largest side of the mesh is 8000 m; check the unit of the file"),
        "{huge}"
    );
}

pub(super) const SOLID: &str = r#"
[body]
shape = "solid"
file = "cube.stl"
unit = "mm"
spacing = "1 mm"
[material]
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon_ratio = 3
[time]
end = "1 us"
"#;

#[test]
fn a_filled_cube_equals_the_block_on_the_same_lattice() {
    let ours = built(SOLID, &cube());
    let block = SOLID.replace(
        "shape = \"solid\"\nfile = \"cube.stl\"\nunit = \"mm\"",
        "shape = \"block\"\nsize = [\"8 mm\", \"8 mm\", \"8 mm\"]",
    );
    let theirs = super::build(&block);
    assert_eq!(ours.form, theirs.form);
    assert!(ours.cloud.lattice().is_some());
    compare_forces(&ours, &theirs);
    // Partial cells of a cube that the lattice divides are whole, also with an open surface.
    let partial = built(
        &SOLID.replace("unit =", "cells = \"partial\"\nunit ="),
        &cube(),
    );
    assert_eq!(partial.cloud.len(), 512);
    let both = SOLID.replace("unit =", "cells = \"partial\"\nopen = true\nunit =");
    let both = built(&both, &cube());
    assert_eq!(both.cloud.len(), 512);
    let whole = |volume: &f64| (volume / 1e-9 - 1.0).abs() < 1e-12;
    assert!(both.cloud.volumes().iter().all(whole));
    let open = built(&SOLID.replace("unit =", "open = true\nunit ="), &cube());
    assert_eq!(open.cloud.len(), 512);
}

#[test]
fn holes_are_removed_from_a_filled_surface() {
    let hole =
        "hole = [{ cylinder = { centre = [\"4 mm\", \"4 mm\", 0], radius = \"2 mm\" } }]\nunit =";
    let body = built(&SOLID.replace("unit =", hole), &cube());
    // 12 cells per layer have their centres within 2 mm of the axis.
    assert_eq!(body.cloud.len(), 512 - 8 * 12);
}

#[test]
fn open_surfaces_are_rejected_with_advice() {
    let mut open = cube();
    open.cells = Cells::default();
    for (kind, corners) in cube().cells.iter().skip(2) {
        open.cells.push(kind, corners);
    }
    let error = rejected(SOLID, &open);
    for part in [
        "deck.toml:4:8",
        "cube.stl: the surface is open",
        "open = true",
    ] {
        assert!(error.contains(part), "{error}");
    }
    let coarse = SOLID.replace("\"1 mm\"", "\"3 mm\"");
    let warned = built(&coarse, &cube());
    let lines: Vec<String> = warned.warnings.iter().map(|w| w.line()).collect();
    assert!(
        lines
            .iter()
            .any(|line| line.contains("of the volume that the boundary encloses")),
        "{lines:?}"
    );
}

#[test]
fn outlines_are_filled() {
    let outline = SOLID.replace(
        "shape = \"solid\"\nfile = \"cube.stl\"\nunit = \"mm\"",
        "shape = \"outline\"\nplane = \"stress\"\nthickness = \"2 mm\"\npolygons = [[[0, 0], [\"8 mm\", 0], [\"8 mm\", \"4 mm\"], [0, \"4 mm\"]], [[\"2 mm\", \"1 mm\"], [\"4 mm\", \"1 mm\"], [\"4 mm\", \"3 mm\"], [\"2 mm\", \"3 mm\"]]]",
    );
    let ours = super::build(&outline);
    assert_eq!((ours.cloud.len(), ours.cloud.volumes()[0]), (28, 2e-9));
    let plate = SOLID.replace(
        "shape = \"solid\"\nfile = \"cube.stl\"\nunit = \"mm\"",
        "shape = \"plate\"\nplane = \"stress\"\nthickness = \"2 mm\"\nsize = [\"8 mm\", \"4 mm\"]\nhole = [{ box = { min = [\"2 mm\", \"1 mm\"], max = [\"4 mm\", \"3 mm\"] } }]",
    );
    compare_forces(&ours, &super::build(&plate));
    // Partial volumes: 8.5 mm in 9 cells of 1 mm, of which the outer ones are three quarters.
    let partial = outline
        .replace("\"8 mm\"", "\"8.5 mm\"")
        .replace("plane =", "cells = \"partial\"\nplane =");
    let partial = super::build(&partial);
    let volume: f64 = partial.cloud.volumes().iter().sum();
    let exact = (8.5 * 4.0 - 2.0 * 2.0) * 2e-9;
    assert!((volume / exact - 1.0).abs() < 1e-12, "{volume} {exact}");
    let first = partial.cloud.nearest([0.25e-3, 0.5e-3, 0.0]);
    assert!((partial.cloud.volumes()[first] / 1.5e-9 - 1.0).abs() < 1e-12);
    assert!(partial.cloud.lattice().is_none());
    // The same from a file.
    let file = SOLID.replace(
        "shape = \"solid\"\nfile = \"cube.stl\"",
        "shape = \"outline\"\nplane = \"stress\"\nthickness = \"2 mm\"\nfile = \"frame.txt\"",
    );
    let deck = Deck::parse(&file, "deck.toml", &[]).unwrap();
    let square =
        |x: f64, y: f64, w: f64, h: f64| vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h]];
    let read = deck.build_with(Resources {
        read_outline: &|_, _| Ok(vec![square(0.0, 0.0, 8.0, 4.0), square(2.0, 1.0, 2.0, 2.0)]),
        ..Resources::default()
    });
    assert_eq!(
        read.unwrap_or_else(|error| panic!("{error}")).cloud.len(),
        28
    );
}

#[test]
fn random_positions_fill_any_shape_and_depend_on_the_seed() {
    let disc = |positions: &str| {
        let text = SOLID.replace(
            "shape = \"solid\"\nfile = \"cube.stl\"\nunit = \"mm\"",
            &format!("shape = \"disc\"\nplane = \"stress\"\nthickness = \"2 mm\"\nradius = \"12 mm\"\n{positions}"),
        );
        super::build(&text)
    };
    let area = std::f64::consts::PI * 12e-3 * 12e-3;
    let total = |cloud: &PointCloud| cloud.volumes().iter().sum::<f64>() / (2e-3 * area);
    let places = |body: &Built| -> Vec<[f64; 3]> {
        (0..body.cloud.len()).map(|i| body.cloud.point(i)).collect()
    };
    for kind in ["jittered", "blue-noise"] {
        let first = disc(&format!("positions = \"{kind}\"\nseed = 7"));
        assert!(
            (total(&first.cloud) - 1.0).abs() < 0.01,
            "{}",
            total(&first.cloud)
        );
        let inside = |x: &[f64; 3]| x[0].hypot(x[1]) <= 12e-3;
        assert!(places(&first).iter().all(inside));
        let again = disc(&format!("positions = \"{kind}\"\nseed = 7"));
        assert_eq!(places(&first), places(&again));
        let other = disc(&format!("positions = \"{kind}\"\nseed = 8"));
        assert_ne!(places(&first), places(&other));
        // Also in a filled surface.
        let solid = SOLID.replace("unit =", &format!("positions = \"{kind}\"\nunit ="));
        let solid = built(&solid, &cube());
        let volume: f64 = solid.cloud.volumes().iter().sum();
        assert!((volume / 512e-9 - 1.0).abs() < 0.02, "{kind}: {volume}");
        assert!(solid.cloud.lattice().is_none());
    }
}

#[test]
fn a_triangulated_crack_cuts_the_same_bonds_as_its_plane() {
    let cracked = |crack: &str| {
        let text = SOLID.replace("[time]", &format!("[[crack]]\n{crack}\n[time]"));
        built_of(&text, |path| {
            if path.ends_with("cube.stl") {
                return Ok(cube());
            }
            let mut crack = RawMesh {
                nodes: vec![
                    [-1.0, -1.0, 4.0],
                    [5.0, -1.0, 4.0],
                    [5.0, 9.0, 4.0],
                    [-1.0, 9.0, 4.0],
                ],
                ..RawMesh::default()
            };
            crack.cells.push(CellKind::Quadrilateral, &[0, 1, 2, 3]);
            Ok(crack)
        })
    };
    let file = cracked("file = \"crack.stl\"\nunit = \"mm\"").unwrap_or_else(|e| panic!("{e}"));
    let corners = "[[\"-1 mm\", \"-1 mm\", \"4 mm\"], [\"5 mm\", \"-1 mm\", \"4 mm\"], [\"5 mm\", \"9 mm\", \"4 mm\"], [\"-1 mm\", \"9 mm\", \"4 mm\"]]";
    let plane = cracked(&format!("polygon = {corners}")).unwrap_or_else(|e| panic!("{e}"));
    assert!(plane.precut_bonds > 1000);
    assert_eq!(file.precut_bonds, plane.precut_bonds);
}

#[test]
fn blocks_of_result_files_are_groups_or_materials() {
    let mesh = block([8, 3, 2], false);
    let material = "horizon = \"3 mm\"\n[materials.glue]\ndensity = 1200\nyoungs_modulus = \"3 GPa\"\n[[assign]]\nset = \"far\"\nmaterial = \"glue\"";
    let groups = MESH.replace("horizon = \"3 mm\"", material);
    let materials = groups.clone() + "[output]\nfields = { blocks = \"materials\" }\n";
    for (text, expected) in [
        (groups, [("left half", 24), ("right half", 24)]),
        (materials, [("default", 42), ("glue", 6)]),
    ] {
        let model = Deck::parse(&text, "deck.toml", &[]).unwrap().model;
        let body = built(&text, &mesh);
        let sets = &body.sets;
        let result = pericles_run::result_body(&model, &body.cloud, sets, &body.meshes);
        let found: Vec<(&str, usize)> = result
            .blocks
            .iter()
            .map(|block| (block.name.as_str(), block.points.len()))
            .collect();
        assert_eq!(found, expected);
        let mut all: Vec<u32> = result
            .blocks
            .iter()
            .flat_map(|b| b.points.clone())
            .collect();
        all.sort_unstable();
        assert_eq!(all, (0..48).collect::<Vec<u32>>());
    }
}

#[test]
fn unbalanced_loads_are_reported_with_their_magnitude() {
    let warnings = |text: &str, mesh: &RawMesh| {
        let body = built(text, mesh);
        let lines: Vec<String> = body.warnings.iter().map(|warning| warning.line()).collect();
        lines.join("\n")
    };
    // 8 × 3 × 2 mm of bricks, 1 MPa at both ends: in equilibrium, but unconstrained.
    let pulled = MESH
        .split("[[load]]\nset = \"grip\"")
        .next()
        .unwrap()
        .to_owned();
    let at_rest =
        pulled.clone() + "[time]\nscheme = \"adaptive-dynamic-relaxation\"\nload_steps = 2\n";
    let bricks = block([8, 3, 2], false);
    let loose = warnings(&at_rest, &bricks);
    assert!(
        loose.contains("48 of 48 points") && loose.contains("not connected to a support"),
        "{loose}"
    );
    // Tetrahedra: the centroids of those with a loaded face differ between the ends by a quarter of an edge along y
    // and z, so the moment is 6 N · 0.25 mm about each axis.
    let tetrahedra = block([8, 3, 2], true);
    let turned = warnings(&at_rest, &tetrahedra);
    assert!(
        turned.contains("the loads on 288 of 288 points")
            && turned.contains("have a net moment of 2.12 mN m that")
            && !turned.contains("a net force")
            && !turned.contains("not connected to a support"),
        "{turned}"
    );
    // A single load: 1 MPa on 3 × 2 mm², through the centre.
    let force = "a net force of 6.00 N that no support takes";
    let one = at_rest.replace("traction = [\"-1 MPa\", 0, 0]", "traction = [0, 0, 0]");
    let moved = warnings(&one, &bricks);
    assert!(moved.contains(force), "{moved}");
    // A constraint normal to the load does not balance it; one along it does.
    let held = |velocity: &str| {
        let held = format!("[[constraint]]\nset = \"left half\"\nvelocity = [{velocity}]\n[time]");
        warnings(&one.replace("[time]", &held), &bricks)
    };
    assert!(held("\"free\", 0, 0").contains(force));
    let quiet = held("0, \"free\", \"free\"");
    assert!(!quiet.contains("no support"), "{quiet}");
    assert!(!held("0, 0, 0").contains("no support"));
}
