//! Generated decks over kinds of bodies, pieces, sets, fields and output formats: a deck that `check` accepts runs, and
//! its results can be exported.

use std::fs;
use std::path::Path;

use crate::common::{run, succeed, text};
use crate::view::Page;

/// A mesh of 4 × 2 unit squares, in mm, with the groups "A" and "B" of one half each, the edge "left" and a group with a
/// long name.
fn squares() -> String {
    let mut text = String::from(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n1 1 \"left\"\n2 2 \"A\"\n2 3 \"B\"\n\
         2 4 \"a group with a name of more than 32 characters\"\n$EndPhysicalNames\n$Nodes\n15\n",
    );
    for j in 0..3 {
        for i in 0..5 {
            text += &format!("{} {i} {j} 0\n", 5 * j + i + 1);
        }
    }
    text += "$EndNodes\n$Elements\n18\n1 1 2 1 1 1 6\n2 1 2 1 1 6 11\n";
    let mut number = 3;
    for j in 0..2 {
        for i in 0..4 {
            let a = 5 * j + i + 1;
            for group in [if i < 2 { 2 } else { 3 }, 4] {
                text += &format!("{number} 3 2 {group} 1 {a} {} {} {}\n", a + 1, a + 6, a + 5);
                number += 1;
            }
        }
    }
    text + "$EndElements\n"
}

/// A closed box of 4 × 3 × 2 mm as twelve triangles.
fn closed_box() -> String {
    let corner = |k: usize| [4 * (k & 1), 3 * (k >> 1 & 1), 2 * (k >> 2)];
    let mut text = String::from("solid box\n");
    for q in [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ] {
        for triangle in [[q[0], q[1], q[2]], [q[0], q[2], q[3]]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in triangle.map(corner) {
                text += &format!("vertex {x} {y} {z}\n");
            }
            text += "endloop\nendfacet\n";
        }
    }
    text + "endsolid box\n"
}

/// A list of 4 × 3 points with two blocks, 1 mm apart, from a place in mm.
fn points(from: [f64; 2]) -> String {
    let mut text = String::from("x y block volume\n");
    for j in 0..3 {
        for i in 0..4 {
            let [x, y] = [from[0] + f64::from(i), from[1] + f64::from(j)];
            text += &format!("{}e-3 {}e-3 {} 1e-9\n", x, y, i / 2 + 1);
        }
    }
    text
}

const PLANE: &str = "plane = \"stress\"\nthickness = \"1 mm\"\n";

/// Kinds of bodies, each with its dimension (0 for surfaces) and the keys of `[body]`.
fn bodies() -> Vec<(&'static str, usize, String)> {
    let plate = format!("shape = \"plate\"\nsize = [\"5 mm\", \"3 mm\"]\n{PLANE}");
    let mesh = format!("shape = \"mesh\"\nfile = \"m.msh\"\nunit = \"mm\"\ndimension = 2\n{PLANE}");
    let list =
        format!("shape = \"points\"\nfile = \"p.txt\"\ndimension = 2\nspacing = \"1 mm\"\n{PLANE}");
    let bar = "shape = \"bar\"\nlength = \"9 mm\"\nspacing = \"1 mm\"\n";
    vec![
        ("bar", 1, bar.into()),
        ("gauss", 1, format!("{bar}quadrature = \"gauss\"\n")),
        ("plate", 2, format!("{plate}spacing = \"1 mm\"\n")),
        (
            "rectangular",
            2,
            format!("{plate}spacing = [\"1 mm\", \"0.5 mm\"]\n"),
        ),
        (
            "random",
            2,
            format!("{plate}spacing = \"1 mm\"\npositions = \"blue-noise\"\n"),
        ),
        (
            "refined",
            2,
            format!(
                "{plate}spacing = \"1 mm\"\nrefine = [{{ ratio = 2, box = {{ min = [0, 0], max = [\"2 mm\", \"3 mm\"] }} }}]\n"
            ),
        ),
        (
            "disc",
            2,
            format!("shape = \"disc\"\nradius = \"3 mm\"\nspacing = \"1 mm\"\n{PLANE}"),
        ),
        ("points", 2, list),
        ("mesh", 2, mesh),
        (
            "block",
            3,
            "shape = \"block\"\nsize = [\"4 mm\", \"3 mm\", \"3 mm\"]\nspacing = \"1 mm\"\n".into(),
        ),
        (
            "ball",
            3,
            "shape = \"ball\"\nradius = \"2.5 mm\"\nspacing = \"1 mm\"\n".into(),
        ),
        (
            "solid",
            3,
            "shape = \"solid\"\nfile = \"box.stl\"\nunit = \"mm\"\nspacing = \"1 mm\"\n".into(),
        ),
        (
            "surface",
            0,
            "shape = \"icosphere\"\nradius = \"4 mm\"\nlevel = 2\n".into(),
        ),
    ]
}

/// Further pieces of plane bodies: none, and one of each kind that stores its points in another way.
fn pieces() -> Vec<(&'static str, String)> {
    let head = "[[body.piece]]\nname = \"second\"\n";
    let moved = "origin = [0, \"20 mm\"]\n";
    vec![
        ("alone", String::new()),
        (
            "disc",
            format!(
                "{head}shape = \"disc\"\nradius = \"2 mm\"\ncentre = [\"2.2 mm\", \"20.3 mm\"]\nspacing = \"1 mm\"\n{PLANE}"
            ),
        ),
        (
            "mesh",
            format!(
                "{head}shape = \"mesh\"\nfile = \"m.msh\"\nunit = \"mm\"\ndimension = 2\n{moved}rotation = {{ angle = 0.3 }}\n{PLANE}"
            ),
        ),
        (
            "points",
            format!(
                "{head}shape = \"points\"\nfile = \"p.txt\"\ndimension = 2\nspacing = \"1 mm\"\n{moved}{PLANE}"
            ),
        ),
    ]
}

/// A deck without output, with names of sets that formats and files store differently.
fn deck(dimension: usize, body: &str, piece: &str) -> String {
    let rest = match dimension {
        0 => "horizon = \"3 mm\"\nmodel = \"power\"\nalpha = 0.3\np = 2\n",
        _ => "youngs_modulus = \"72 GPa\"\nhorizon = \"3 mm\"\ncritical_stretch = 0.1\n",
    };
    let contact = if piece.is_empty() { "" } else { "[contact]\n" };
    let velocity = ["[0, 0, 1]", "[1]", "[1, 0]", "[1, 0, 0]"][dimension];
    format!(
        "[body]\n{body}{piece}[material]\ndensity = 2440\n{rest}{contact}\
         [sets]\n\"Größe/1 <&>\" = {{ where = \"x > 0.001\" }}\n\
         \"a set with a name of more than 32 characters\" = {{ where = \"x > 0.001\" }}\n\
         [[initial]]\nvelocity = {velocity}\n[time]\nend = 2e-9\ndt = 1e-9\n"
    )
}

const FIELDS: [&str; 26] = [
    "Displacement",
    "Velocity",
    "Force_Density",
    "External_Force_Density",
    "Reaction_Density",
    "Contact_Force_Density",
    "Damage",
    "Stress",
    "Strain",
    "Equivalent_Stress",
    "Von_Mises_Stress",
    "Principal_Stress",
    "Dilatation",
    "Plastic_Strain",
    "Yield_Flag",
    "Point_Id",
    "Fragment_Id",
    "Strain_Energy_Density",
    "Kinetic_Energy_Density",
    "Volume",
    "Temperature",
    "Heat_Flux",
    "Radius",
    "Material_Id",
    "Piece_Id",
    "Set_Größe/1 <&>",
];

/// Runs a command and asserts that it does not end with an internal error; returns whether it succeeded.
fn holds(folder: &Path, arguments: &str, deck: &str) -> bool {
    let output = run(folder, arguments);
    let status = output.status.code();
    let err = text(&output.stderr);
    assert!(
        matches!(status, Some(0 | 3)),
        "{arguments}: {status:?}\n{err}\n{deck}"
    );
    status == Some(0)
}

#[test]
fn every_deck_that_check_accepts_runs_in_every_format_and_is_exported() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    fs::write(folder.join("m.msh"), squares()).unwrap();
    fs::write(folder.join("box.stl"), closed_box()).unwrap();
    fs::write(folder.join("p.txt"), points([0.5, 0.5])).unwrap();
    let (mut runs, mut rejected) = (0, 0);
    for (kind, dimension, body) in bodies() {
        let all = pieces();
        let pieces = if dimension == 2 { &all[..] } else { &all[..1] };
        // The fields that the body has; further pieces do not change them.
        let alone = deck(dimension, &body, "");
        let accepted = FIELDS.iter().filter(|field| {
            let fields = format!("fields = {{ count = 1, names = [\"{field}\"] }}");
            let deck = format!("{alone}[output]\n{fields}\n");
            fs::write(folder.join("a.toml"), &deck).unwrap();
            let is_accepted = holds(folder, "check a.toml", &deck);
            rejected += usize::from(!is_accepted);
            is_accepted
        });
        let mut names: Vec<String> = accepted.map(|field| format!("\"{field}\"")).collect();
        assert!(names.len() >= 5, "{kind}: {names:?}");
        names.push("\"Set_a set with a name of more than 32 characters\"".into());
        for (other, piece) in pieces {
            let plain = deck(dimension, &body, piece);
            fs::write(folder.join("a.toml"), &plain).unwrap();
            if !holds(folder, "check a.toml", &plain) {
                // Pieces of some kinds are rejected; bodies alone are not.
                let err = text(&run(folder, "check a.toml").stderr);
                assert_ne!(*other, "alone", "{plain}{err}");
                continue;
            }
            let has_mesh = kind == "mesh" || *other == "mesh";
            for format in [
                "\"vtu\"",
                "\"exodus\"",
                "\"vtkhdf\"",
                "[\"vtu\", \"exodus\", \"vtkhdf\"]",
            ] {
                for (cells, blocks) in [
                    ("\"auto\"", "groups"),
                    ("true", "materials"),
                    ("false", "groups"),
                ] {
                    let without = if cells == "\"auto\"" { 1 } else { 0 };
                    for names in &[names.join(", "), String::new()][..=without] {
                        let mesh_cells = if has_mesh { "cells = true, " } else { "" };
                        let deck = format!(
                            "{plain}[output]\ncells = {cells}\nfields = {{ count = 2, {mesh_cells}blocks = \"{blocks}\", format = {format}, names = [{names}] }}\n"
                        );
                        fs::write(folder.join("a.toml"), &deck).unwrap();
                        let _ = fs::remove_dir_all(folder.join("out"));
                        if !holds(folder, "run a.toml --out out --quiet", &deck) {
                            // A body without cells.
                            assert_eq!(cells, "true", "{deck}");
                            continue;
                        }
                        runs += 1;
                        if cells == "false" {
                            continue;
                        }
                        // Every format is exported to another one.
                        let to = ["exodus", "vtkhdf", "csv", "npz", "html"][runs % 5];
                        let _ = fs::remove_dir_all(folder.join("exported"));
                        let _ = fs::remove_file(folder.join("exported"));
                        succeed(folder, &format!("export out --to {to} --out exported"));
                        if to == "html" {
                            assert_eq!(Page::open(&folder.join("exported")).times(), 3, "{deck}");
                        }
                    }
                }
            }
        }
    }
    println!("{runs} runs, {rejected} fields rejected");
    assert!(runs > 300 && rejected > 0, "{runs} {rejected}");
}
