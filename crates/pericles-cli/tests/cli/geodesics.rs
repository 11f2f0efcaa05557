//! `pericles geodesics`: shapes and files, table, JSON, invalid input.

use std::fs;

use crate::common::{fail, succeed, text};
use serde_json::Value;

const TETRAHEDRON: &str =
    "v 1 1 1\nv 1 -1 -1\nv -1 1 -1\nv -1 -1 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 2 4 3\n";

#[test]
fn methods_are_compared_on_a_sphere() {
    let place = tempfile::tempdir().unwrap();
    let line = "geodesics icosphere(3) --horizon 0.5 --methods exact,edge,steiner(2) --json";
    let output = succeed(place.path(), &format!("{line} -"));
    let results: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
    assert_eq!(
        (&results["vertices"], &results["genus"]),
        (&642.into(), &0.into())
    );
    assert_eq!(results["cautions"].as_array().unwrap().len(), 0);
    let [exact, edge, steiner] = &results["methods"].as_array().unwrap()[..] else {
        panic!("{results}");
    };
    assert_eq!(
        (&exact["directed_bonds"], &edge["directed_bonds"]),
        (&23580.into(), &22740.into())
    );
    assert_eq!(
        (&exact["max_error"], &steiner["method"]),
        (&0.0.into(), &"steiner(2)".into())
    );
    assert!(
        (0.22..0.24).contains(&edge["max_error"].as_f64().unwrap()),
        "{edge}"
    );
    let output = succeed(place.path(), &format!("{line} results.json"));
    let table = text(&output.stdout);
    for part in [
        "642 vertices, 1 920 edges",
        "closed, genus 0",
        "3.19 median edge lengths",
        "edge ",
        "22 740",
    ] {
        assert!(table.contains(part), "{part}: {table}");
    }
    assert!(place.path().join("results.json").exists());
}

#[test]
fn files_are_read_and_invalid_ones_are_rejected() {
    let place = tempfile::tempdir().unwrap();
    let write = |name: &str, content: &str| fs::write(place.path().join(name), content).unwrap();
    write("good.obj", TETRAHEDRON);
    write(
        "open.obj",
        TETRAHEDRON.trim_end().rsplit_once('\n').unwrap().0,
    );
    write("word.obj", &TETRAHEDRON.replace("-1 -1 1", "-1 one 1"));
    write("flipped.obj", &TETRAHEDRON.replace("f 2 4 3", "f 2 3 4"));
    let output = text(&succeed(place.path(), "geodesics good.obj --horizon 3").stdout);
    assert!(
        output.contains("4 vertices") && output.contains("warning:"),
        "{output}"
    );
    succeed(place.path(), "geodesics flipped.obj --horizon 3 --flip");
    succeed(place.path(), "geodesics open.obj --horizon 3 --open");
    for (line, status, parts) in [
        (
            "open.obj --horizon 3",
            3,
            &["open.obj: the surface is open: 3 edge(s)"][..],
        ),
        (
            "word.obj --horizon 3",
            3,
            &["word.obj:4: \"one\" is not a coordinate"],
        ),
        (
            "flipped.obj --horizon 3",
            3,
            &["3 edge(s) run in the same direction"],
        ),
        (
            "good.obj --horizon 1",
            3,
            &["the horizon 1 m reaches no neighbour"],
        ),
        ("gone.obj --horizon 1", 3, &["gone.obj does not exist"]),
        (
            "good.xyz --horizon 1",
            3,
            &["allowed file extensions: .obj, .ply, .stl, .off, .msh, .vtu, .vtp"],
        ),
        (
            "icosphere(99) --horizon 1",
            3,
            &["the level of the icosphere is 99; allowed: 0 to 10"],
        ),
        (
            "cube(3) --horizon 1",
            2,
            &[
                "cube(3)",
                "torus(MAJOR,MINOR,MAJOR_SEGMENTS,MINOR_SEGMENTS)",
            ],
        ),
        (
            "icosphere(2) --horizon 1 --methods heat",
            2,
            &["edge-diagonals, steiner(1)"],
        ),
        (
            "icosphere(2) --horizon=-1",
            2,
            &["expected a positive length"],
        ),
    ] {
        let (found, message) = fail(place.path(), &format!("geodesics {line}"));
        assert_eq!(found, status, "{line}: {message}");
        for part in parts {
            assert!(message.contains(part), "{line}: {message}");
        }
    }
}

#[test]
fn the_distance_of_two_vertices_is_the_length_of_the_shortest_path() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("tetrahedron.obj"), TETRAHEDRON).unwrap();
    let line =
        "geodesics tetrahedron.obj --horizon 3 --methods exact,edge --between 0,3 --between 2,2";
    let output = succeed(place.path(), &format!("{line} --json -"));
    let results: Value = serde_json::from_str(&text(&output.stdout)).unwrap();
    let found: Vec<(u64, f64)> = results["between"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| {
            (
                row["vertices"][1].as_u64().unwrap(),
                row["distance"].as_f64().unwrap(),
            )
        })
        .collect();
    let edge = 8f64.sqrt();
    for ((vertex, distance), (right, exact)) in
        found.iter().zip([(3, edge), (3, edge), (2, 0.0), (2, 0.0)])
    {
        assert_eq!(*vertex, right);
        assert!((distance - exact).abs() < 1e-12, "{found:?}");
    }
    let said = text(&succeed(place.path(), line).stdout);
    assert!(
        said.contains("vertices 0 and 3, exact: 2.82843 m"),
        "{said}"
    );
    // Beyond the horizon.
    let line = "geodesics icosphere(3) --horizon 0.5 --methods exact,edge --between 0,3 --json -";
    let results: Value = serde_json::from_str(&text(&succeed(place.path(), line).stdout)).unwrap();
    let [exact, edge] = [0, 1].map(|k| results["between"][k]["distance"].as_f64().unwrap());
    assert!((0.5..std::f64::consts::PI).contains(&exact), "{exact}");
    assert!(
        exact <= edge * (1.0 + 1e-12) && edge < 1.3 * exact,
        "{exact} {edge}"
    );
    let (status, message) = fail(
        place.path(),
        "geodesics icosphere(1) --horizon 1 --between 0,42",
    );
    assert_eq!(status, 2, "{message}");
    assert!(
        message.contains("no vertex 42; its 42 vertices are numbered 0 to 41"),
        "{message}"
    );
}
