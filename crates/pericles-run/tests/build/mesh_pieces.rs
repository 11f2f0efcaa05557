//! Meshes as further pieces of a body, and sets of meshes with special names or places.

use pericles_deck::Deck;
use pericles_mesh::{CellKind, Cells, FaceSet, NamedList, RawMesh};

use super::mesh::{block, built, cube, rejected};

/// A block on a lattice, and beside it a mesh of 8 × 3 × 2 mm rotated about z by a quarter turn.
const TWO: &str = r#"
[body]
shape = "block"
size = ["3 mm", "3 mm", "2 mm"]
spacing = "1 mm"
[[body.piece]]
name = "bar"
shape = "mesh"
file = "block.msh"
unit = "mm"
origin = ["20 mm", 0, 0]
rotation = { angle = 1.5707963267948966, axis = [0, 0, 1], centre = ["20 mm", 0, 0] }
[material]
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon = "3 mm"
[contact]
[sets]
grip = { near_faces = { faces = "bar/left", depth = "2.1 mm" } }
[[load]]
set = "bar/right"
pressure = "1 MPa"
[[load]]
set = "bar/left"
traction = [0, "2 MPa", 0]
[time]
end = "1 us"
"#;

#[test]
fn sets_and_faces_of_a_mesh_piece_are_those_of_the_file_turned_with_it() {
    let body = built(TWO, &block([8, 3, 2], false));
    assert_eq!(body.cloud.len(), 18 + 48);
    let size = |wanted: &str| {
        let found = body.sets.iter().find(|(name, _)| name == wanted);
        found.map(|(_, points)| points.len())
    };
    for (name, points) in [
        ("main", 18),
        ("bar", 48),
        ("bar/left half", 24),
        ("bar/right", 6),
        ("grip", 12),
        ("left half", 0),
    ] {
        assert_eq!(size(name).unwrap_or(0), points, "{name}");
    }
    // The face "right" has the normal +y after the rotation; a pressure acts against it. Both areas are 3 × 2 mm².
    let [pressure, traction] = [&body.loads[0], &body.loads[1]];
    for (found, expected) in [
        (pressure.force, [0.0, -6.0, 0.0]),
        (traction.force, [0.0, 12.0, 0.0]),
    ] {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }
    // The centroid of the loaded points is half a cell inside the upper end of the bar.
    let (_, right) = body
        .sets
        .iter()
        .find(|(name, _)| name == "bar/right")
        .unwrap();
    for &i in right {
        assert!((body.cloud.point(i as usize)[1] - 7.5e-3).abs() < 1e-12);
    }
}

#[test]
fn pieces_have_blocks_of_their_own_in_result_files() {
    let blocks = |text: &str| {
        let model = Deck::parse(text, "deck.toml", &[]).unwrap().model;
        let body = built(text, &block([8, 3, 2], false));
        let result = pericles_run::result_body(&model, &body.cloud, &body.sets, &body.meshes);
        let blocks = result.blocks.into_iter();
        blocks
            .map(|block| (block.name, block.points.len()))
            .collect::<Vec<_>>()
    };
    let named = |names: &[(&str, usize)]| {
        let names = names.iter();
        names
            .map(|(name, points)| (String::from(*name), *points))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        blocks(TWO),
        named(&[("main", 18), ("bar/left half", 24), ("bar/right half", 24)])
    );
    // The mesh first: its groups have the names of the file.
    let swapped = r#"
[body]
shape = "mesh"
file = "block.msh"
unit = "mm"
[[body.piece]]
name = "ball"
shape = "ball"
radius = "2 mm"
centre = ["4.3 mm", "1.2 mm", "9 mm"]
spacing = "1 mm"
[material]
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon = "3 mm"
[contact]
[time]
end = "1 us"
"#;
    let found = blocks(swapped);
    let ball = found[2].1;
    assert_eq!(
        found,
        named(&[("left half", 24), ("right half", 24), ("ball", ball)])
    );
    assert!(ball > 20);
}

#[test]
fn a_pressure_on_faces_inside_the_body_is_rejected() {
    let mut mesh = block([8, 3, 2], false);
    // The quadrilaterals between the halves: x = 4 mm, two of six; node numbers of `block`.
    let node = |j: u32, k: u32| (k * 4 + j) * 9 + 4;
    let mut faces = Cells::default();
    for j in 0..2 {
        let corners = [node(j, 0), node(j + 1, 0), node(j + 1, 1), node(j, 1)];
        faces.push(CellKind::Quadrilateral, &corners);
    }
    mesh.face_sets.push(FaceSet {
        name: "middle".into(),
        faces,
    });
    let text = TWO.replace("bar/right", "bar/middle");
    let answer = rejected(&text, &mesh);
    assert!(
        answer.contains("2 face(s) of the set `bar/middle` lie between two elements of the body"),
        "{answer}"
    );
    // A traction has a direction of its own.
    let text = TWO.replace("bar/left\"\ntraction", "bar/middle\"\ntraction");
    let body = built(&text, &mesh);
    assert!((body.loads[1].force[1] / 4.0 - 1.0).abs() < 1e-12);
}

#[test]
fn names_that_a_deck_or_an_exodus_file_cannot_keep_lead_to_warnings() {
    let mut mesh = block([8, 3, 2], false);
    let warnings = |mesh: &_, output: &str| {
        let text = format!("{TWO}[output]\nfields = {{ format = {output} }}\n");
        let body = built(&text, mesh);
        let lines: Vec<String> = body.warnings.iter().map(|warning| warning.line()).collect();
        (lines.join("\n"), body)
    };
    let both = "[\"exodus\", \"vtkhdf\"]";
    let (quiet, _) = warnings(&mesh, both);
    assert!(
        !quiet.contains("shortened") && !quiet.contains("all"),
        "{quiet}"
    );
    mesh.groups.push(NamedList {
        name: "all".into(),
        members: vec![0, 1],
    });
    let long = "x".repeat(29);
    mesh.groups.push(NamedList {
        name: long.clone(),
        members: vec![0, 1],
    });
    let (told, body) = warnings(&mesh, both);
    assert!(
        told.contains("the set \"all\" of the mesh is available as \"all (elements)\""),
        "{told}"
    );
    // With the name of the piece the other name has 33 characters.
    assert!(
        told.contains(&format!(
            "the name `bar/{long}` is shortened to `bar/{}`",
            &long[..28]
        )),
        "{told}"
    );
    let set = |name: &str| {
        body.sets
            .iter()
            .find(|(own, _)| own == name)
            .map(|(_, set)| set.len())
    };
    assert_eq!(set("all"), Some(66));
    assert_eq!(set("bar/all (elements)"), Some(2));
    assert!(!warnings(&mesh, "\"vtkhdf\"").0.contains("shortened"));
}

#[test]
fn a_reversed_triangle_of_a_solid_is_named_and_does_not_change_it() {
    let solid = |open: bool| {
        format!(
            r#"
[body]
shape = "solid"
file = "cube.stl"
unit = "mm"
spacing = "1 mm"
open = {open}
[material]
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon_ratio = 3
[time]
end = "1 us"
"#
        )
    };
    for reversed in [0, 7] {
        let mut mesh = cube();
        let mut cells = Cells::default();
        for (k, (kind, corners)) in cube().cells.iter().enumerate() {
            let [a, b, c] = [corners[0], corners[1], corners[2]];
            match k == reversed {
                true => cells.push(kind, &[a, c, b]),
                false => cells.push(kind, &[a, b, c]),
            }
        }
        mesh.cells = cells;
        for open in [false, true] {
            let body = built(&solid(open), &mesh);
            assert_eq!(body.cloud.len(), 512, "{reversed} {open}");
            let lines: Vec<String> = body.warnings.iter().map(|w| w.line()).collect();
            let told = format!("triangle {} with the corners", reversed + 1);
            assert!(lines.iter().any(|line| line.contains(&told)), "{lines:?}");
        }
    }
    let quiet = built(&solid(false), &cube());
    assert!(!quiet.warnings.iter().any(|w| w.line().contains("triangle")));
}

#[test]
fn impactors_from_files_that_repeat_corners_are_closed() {
    let deck = r#"
[body]
shape = "block"
size = ["10 mm", "10 mm", "4 mm"]
spacing = "1 mm"
[material]
density = 2000
youngs_modulus = "70 GPa"
horizon_ratio = 3
[[impactor]]
name = "tool"
shape = "surface"
file = "cube.stl"
unit = "mm"
centre = ["5 mm", "5 mm", "20 mm"]
velocity = [0, 0, "-10 m/s"]
density = 7800
[time]
end = "1 us"
"#;
    // Each triangle with three vertices of its own, as in STL.
    let shared = cube();
    let mut mesh = RawMesh::default();
    for (kind, corners) in shared.cells.iter() {
        let first = mesh.nodes.len() as u32;
        mesh.nodes
            .extend(corners.iter().map(|&c| shared.nodes[c as usize]));
        mesh.cells.push(kind, &[first, first + 1, first + 2]);
    }
    let frequency = |mesh: &RawMesh| built(deck, mesh).contact_frequency.unwrap();
    assert_eq!(frequency(&mesh), frequency(&shared));
}
