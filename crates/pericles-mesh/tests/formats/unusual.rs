//! Unusual but valid files, and messages about what cannot be read.

use super::{points, read, set};
use pericles_mesh::SetKind;

/// A bar of two bricks from x = 0 to 2.
const BAR: &str = "*PART, NAME=Bar
*NODE
1, 0., 0., 0.
2, 1., 0., 0.
3, 2., 0., 0.
4, 0., 1., 0.
5, 1., 1., 0.
6, 2., 1., 0.
7, 0., 0., 1.
8, 1., 0., 1.
9, 2., 0., 1.
10, 0., 1., 1.
11, 1., 1., 1.
12, 2., 1., 1.
*ELEMENT, TYPE=C3D8, ELSET=body
1, 1, 2, 5, 4, 7, 8, 11, 10
2, 2, 3, 6, 5, 8, 9, 12, 11
*NSET, NSET=inpart
1, 4, 7, 10
*END PART
";

/// Two instances, the second one 10 beside the first, and sets of the assembly.
fn assembly(sets: &str) -> String {
    format!(
        "{BAR}*ASSEMBLY, NAME=A
*INSTANCE, NAME=Bar-1, PART=Bar
*END INSTANCE
*INSTANCE, NAME=Bar.2, PART=Bar
10., 0., 0.
*END INSTANCE
{sets}*END ASSEMBLY
"
    )
}

#[test]
fn sets_of_an_assembly_name_elements_nodes_and_sets_of_instances() {
    let sets = "*ELSET, ELSET=cross
Bar-1.1, bar.2.2
*ELSET, ELSET=both
cross, Bar-1.body
*NSET, NSET=corners
Bar-1.1, Bar.2.12
*SURFACE, TYPE=ELEMENT, NAME=ends
Bar-1.1, S6
Bar.2.2, S4
";
    let (_, points) = points("inp", assembly(sets).as_bytes());
    assert_eq!(points.len(), 4);
    assert_eq!(set(&points, "cross"), (SetKind::Elements, vec![0, 3]));
    assert_eq!(set(&points, "both"), (SetKind::Elements, vec![0, 1, 3]));
    assert_eq!(set(&points, "corners"), (SetKind::Nodes, vec![0, 3]));
    let ends = points.set("ends").unwrap();
    assert_eq!(ends.points, [0, 3]);
    assert!((ends.area.unwrap() - 2.0).abs() < 1e-14);
}

#[test]
fn names_that_are_not_defined_are_rejected() {
    for (sets, name) in [
        ("*ELSET, ELSET=a\ngone\n", "GONE"),
        ("*ELSET, ELSET=a\nBar-3.1\n", "BAR-3.1"),
        ("*ELSET, ELSET=a\nBar-1.gone\n", "BAR-1.GONE"),
        ("*NSET, NSET=a\nbody\n", "BODY"),
        ("*NSET, NSET=a, ELSET=gone\n", "GONE"),
        ("*SURFACE, NAME=s\ngone, S1\n", "GONE"),
        ("*SURFACE, NAME=s, TYPE=NODE\ngone\n", "GONE"),
    ] {
        let fault = read("inp", assembly(sets).as_bytes()).unwrap_err();
        let answer = fault.to_string();
        assert!(
            answer.contains(&format!("refers to {name}, which is not defined")),
            "{sets}: {answer}"
        );
    }
    // Sets of elements that are left out are defined, but empty.
    let sets =
        "*ELEMENT, TYPE=SPRINGA, ELSET=springs\n1, 1, 2\n*ELSET, ELSET=a\nsprings, Bar-1.1\n";
    let (_, points) = points("inp", assembly(sets).as_bytes());
    assert_eq!(set(&points, "a").1, [0]);
}

#[test]
fn instances_may_have_their_own_mesh() {
    let mesh = BAR.split_once('\n').unwrap().1.replace("*END PART\n", "");
    for head in [
        "*INSTANCE, NAME=I",
        "*INSTANCE, NAME=I, PART=Gone",
        "*PART, NAME=Empty\n*END PART\n*INSTANCE, NAME=I, PART=Empty",
    ] {
        let file = format!("{head}\n{mesh}*END INSTANCE\n");
        let (_, points) = points("inp", file.as_bytes());
        assert_eq!(points.len(), 2, "{head}");
        assert_eq!(set(&points, "body").1, [0, 1]);
    }
    // Nodes and elements that the instance defines again replace those of its part: node 3 at x = 4.
    let file = format!(
        "{BAR}*INSTANCE, NAME=I, PART=Bar\n*NODE\n3, 4., 0., 0.\n6, 4., 1., 0.\n9, 4., 0., 1.\n12, 4., 1., 1.\n\
         *ELEMENT, TYPE=C3D8\n2, 2, 3, 6, 5, 8, 9, 12, 11\n*END INSTANCE\n"
    );
    let (_, points) = points("inp", file.as_bytes());
    let volume: f64 = points.volumes.iter().sum();
    assert!((volume - 4.0).abs() < 1e-14, "{volume}");
    assert_eq!(set(&points, "body").1.len(), 2);
    let fault = read("inp", b"*INSTANCE, NAME=I, PART=Gone\n*END INSTANCE\n").unwrap_err();
    assert!(fault.to_string().contains("has no mesh"), "{fault}");
}

/// A tetrahedron as STL text.
fn stl(upper: bool, before: &str) -> String {
    let corners = ["0 0 0", "2 0 0", "0 2 0", "0 0 2"];
    let mut text = format!("{before}solid a b\n");
    for [a, b, c] in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
        text += "facet normal 0 0 0\nouter loop\n";
        for k in [a, b, c] {
            text += &format!("vertex {}\n", corners[k]);
        }
        text += "endloop\nendfacet\n";
    }
    text += "endsolid a b\n";
    match upper {
        true => text.to_uppercase(),
        false => text,
    }
}

#[test]
fn stl_text_is_recognised_in_any_case_and_after_blanks() {
    let plain = read("stl", stl(false, "").as_bytes()).unwrap();
    assert_eq!(plain.cells.len(), 4);
    for text in [
        stl(true, ""),
        stl(false, " \t\r\n"),
        stl(true, "\u{feff}  "),
        stl(false, "").replace("solid a b", "Solid Würfel"),
        stl(false, "").replace('\n', "\r\n"),
    ] {
        assert_eq!(read("stl", text.as_bytes()).unwrap(), plain, "{text}");
    }
    // A binary file whose header begins with the word, and contains text only in its first kilobyte.
    let mut binary = format!("{:<80}", "solid text of another program").into_bytes();
    binary.extend(1u32.to_le_bytes());
    for x in [0f32; 3]
        .iter()
        .chain(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0])
    {
        binary.extend(x.to_le_bytes());
    }
    binary.extend([0, 0]);
    assert_eq!(read("stl", &binary).unwrap().cells.len(), 1);
}

#[test]
fn files_without_elements_and_unsupported_sections_are_named() {
    for (ending, content, expected) in [
        (
            "stl",
            "solid a\nendsolid a\n",
            "the file contains no triangles",
        ),
        ("obj", "v 0 0 0\n", "the file contains no triangles"),
        (
            "inp",
            "*NODE\n1, 0., 0., 0.\n",
            "the file contains no elements",
        ),
        (
            "inp",
            "*SYSTEM\n1., 0., 0.\n*NODE\n1, 0., 0., 0.\n",
            "*SYSTEM gives the following nodes in a local coordinate system",
        ),
        (
            "msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$ParametricNodes\n1\n1 0 0 0 2 1 0 0\n$EndParametricNodes\n",
            "$ParametricNodes is not supported",
        ),
        (
            "vtp",
            "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"0\" NumberOfPolys=\"0\"><Points><DataArray \
             type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\"></DataArray></Points><Polys><DataArray type=\"Int64\" \
             Name=\"connectivity\" format=\"ascii\"></DataArray><DataArray type=\"Int64\" Name=\"offsets\" \
             format=\"ascii\"></DataArray></Polys></Piece></PolyData></VTKFile>",
            "the file contains no cells",
        ),
    ] {
        let fault = read(ending, content.as_bytes()).unwrap_err().to_string();
        assert!(fault.contains(expected), "{ending}: {fault}");
    }
}
