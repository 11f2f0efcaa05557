//! A small mesh in all formats: a cube and an adjacent wedge, with sets.

use super::cdf::{self, Values, variable};

/// A cube of side 1 and, at x = 1 to 2, half of a second one.
pub const NODES: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
    [2.0, 0.0, 0.0],
    [2.0, 0.0, 1.0],
];
pub const CUBE: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
pub const WEDGE: [u32; 6] = [1, 8, 2, 5, 9, 6];
/// The face x = 0 of the cube.
pub const FACE: [u32; 4] = [0, 4, 7, 3];

/// Numbers increased by `first`.
fn numbers(corners: &[u32], first: u32, separator: &str) -> String {
    let words: Vec<String> = corners.iter().map(|c| (c + first).to_string()).collect();
    words.join(separator)
}

fn coordinates(node: usize, separator: &str) -> String {
    let [x, y, z] = NODES[node];
    format!("{x}{separator}{y}{separator}{z}")
}

fn ints(numbers: &[i32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn sizes(numbers: &[u64]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn reals(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn plus(corners: &[u32]) -> Vec<i32> {
    corners.iter().map(|&c| c as i32 + 1).collect()
}

/// Groups: "left part" (1), "right" (2), "all" (3) of solids, "x0" (1) of faces, "tip" (1) of points. An
/// element of two groups is listed twice.
pub fn gmsh_2(binary: bool) -> Vec<u8> {
    let mut file = format!("$MeshFormat\n2.2 {} 8\n", u8::from(binary)).into_bytes();
    if binary {
        file.extend(ints(&[1]));
        file.push(b'\n');
    }
    file.extend(b"$EndMeshFormat\n$PhysicalNames\n5\n0 1 \"tip\"\n2 1 \"x0\"\n3 1 \"left part\"\n3 2 \"right\"\n3 3 \"all\"\n$EndPhysicalNames\n$Nodes\n10\n");
    for (k, x) in NODES.iter().enumerate() {
        match binary {
            true => {
                file.extend(ints(&[k as i32 + 1]));
                file.extend(reals(x));
            }
            false => file.extend(format!("{} {}\n", k + 1, coordinates(k, " ")).bytes()),
        }
    }
    file.extend(b"$EndNodes\n$Elements\n6\n");
    // Type, number, group, nodes; the repeated cube and wedge belong to the group "all".
    let elements: [(i32, i32, i32, &[u32]); 6] = [
        (15, 1, 1, &[9]),
        (3, 2, 1, &FACE),
        (5, 3, 1, &CUBE),
        (6, 4, -2, &WEDGE),
        (5, 5, 3, &CUBE),
        (6, 6, 3, &WEDGE),
    ];
    for (kind, number, group, nodes) in elements {
        match binary {
            true => {
                file.extend(ints(&[kind, 1, 2, number, group, 7]));
                file.extend(ints(&plus(nodes)));
            }
            false => {
                let nodes = numbers(nodes, 1, " ");
                file.extend(format!("{number} {kind} 2 {group} 7 {nodes}\n").bytes());
            }
        }
    }
    file.extend(b"$EndElements\n");
    file
}

pub fn gmsh_4(binary: bool) -> Vec<u8> {
    let mut file = format!("$MeshFormat\n4.1 {} 8\n", u8::from(binary)).into_bytes();
    if binary {
        file.extend(ints(&[1]));
        file.push(b'\n');
    }
    file.extend(b"$EndMeshFormat\n$PhysicalNames\n5\n0 1 \"tip\"\n2 1 \"x0\"\n3 1 \"left part\"\n3 2 \"right\"\n3 3 \"all\"\n$EndPhysicalNames\n$Entities\n");
    // Tags need not be dense: nodes are 101 to 110.
    let tags: Vec<u64> = (101..111).collect();
    let tag = |corners: &[u32]| -> Vec<u64> { corners.iter().map(|&c| tags[c as usize]).collect() };
    if binary {
        file.extend(sizes(&[1, 0, 1, 2]));
        file.extend(ints(&[4]));
        file.extend(reals(&NODES[9]));
        file.extend(sizes(&[1]));
        file.extend(ints(&[1]));
        for (entity, groups, boundaries) in [
            (8, vec![-1], vec![5]),
            (1, vec![1, 3], vec![]),
            (2, vec![-2, 3], vec![8]),
        ] {
            file.extend(ints(&[entity]));
            file.extend(reals(&[0.0; 6]));
            for list in [groups, boundaries] {
                file.extend(sizes(&[list.len() as u64]));
                file.extend(ints(&list));
            }
        }
        file.extend(b"\n$EndEntities\n$Nodes\n");
        file.extend(sizes(&[1, 10, 101, 110]));
        file.extend(ints(&[3, 1, 0]));
        file.extend(sizes(&[10]));
        file.extend(sizes(&tags));
        NODES.iter().for_each(|x| file.extend(reals(x)));
        file.extend(b"\n$EndNodes\n$Elements\n");
        file.extend(sizes(&[4, 4, 1, 4]));
        let blocks: [(i32, i32, i32, u64, &[u32]); 4] = [
            (0, 4, 15, 1, &[9]),
            (2, 8, 3, 2, &FACE),
            (3, 1, 5, 3, &CUBE),
            (3, 2, 6, 4, &WEDGE),
        ];
        for (dimension, entity, kind, number, nodes) in blocks {
            file.extend(ints(&[dimension, entity, kind]));
            file.extend(sizes(&[1, number]));
            file.extend(sizes(&tag(nodes)));
        }
        file.extend(b"\n$EndElements\n");
        return file;
    }
    file.extend(b"1 0 1 2\n4 2 0 1 1 1\n8 0 0 0 0 1 1 1 -1 1 5\n1 0 0 0 1 1 1 2 1 3 0\n2 1 0 0 2 1 1 2 -2 3 1 8\n$EndEntities\n$Nodes\n1 10 101 110\n3 1 0 10\n");
    tags.iter()
        .for_each(|tag| file.extend(format!("{tag}\n").bytes()));
    (0..10).for_each(|k| file.extend(format!("{}\n", coordinates(k, " ")).bytes()));
    file.extend(b"$EndNodes\n$Elements\n4 4 1 4\n");
    for (head, number, nodes) in [
        ("0 4 15 1", 1, &[9][..]),
        ("2 8 3 1", 2, &FACE),
        ("3 1 5 1", 3, &CUBE),
        ("3 2 6 1", 4, &WEDGE),
    ] {
        let nodes = numbers(nodes, 101, " ");
        file.extend(format!("{head}\n{number} {nodes}\n").bytes());
    }
    file.extend(b"$EndElements\n");
    file
}

/// A file without parts.
pub fn abaqus() -> Vec<u8> {
    let mut file = "*HEADING\nA cube and a wedge, not data\n** a comment\n*Node\n".to_owned();
    for k in 0..10 {
        file += &format!("{}, {}\n", k + 1, coordinates(k, ", "));
    }
    let cube = numbers(&CUBE, 1, ", ");
    // The second line of the cube follows a comma; the wedge has second-order nodes after its corners.
    let (begin, end) = cube.split_at(12);
    file += &format!(
        "*ELEMENT, TYPE=C3D8R, ELSET=\"left part\"\n3, {begin}\n{end}\n*element, type=c3d6,\nelset=right\n"
    );
    file += &format!(
        "4, {}, 1, 1, 1, 1, 1, 1, 1, 1, 1,\n1, 1, 1\n",
        numbers(&WEDGE, 1, ", ")
    );
    file += "*ELSET, ELSET=ALL, GENERATE\n1, 1000000000000, 1\n*NSET, NSET=tip\n10\n*NSET, NSET=right, GENERATE\n2, 3, 1\n";
    file += "*SURFACE, NAME=x0, TYPE=ELEMENT\n\"left part\", S6\n*ELSET, ELSET=both\nright, \"left part\"\n*SURFACE, NAME=free\nALL,\n*STEP\n*NODE\n1, 5, 5, 5\n";
    file.into_bytes()
}

pub fn exodus(version: u8) -> Vec<u8> {
    let axis = |c: usize| Values::Double(NODES.iter().map(|x| x[c]).collect());
    let texts = |words: &[&str]| {
        let mut bytes = Vec::new();
        for word in words {
            let end = bytes.len() + 16;
            bytes.extend(word.as_bytes());
            bytes.resize(end, 0);
        }
        Values::Text(bytes)
    };
    let mut cube = variable("connect1", &[3, 4], Values::Int(plus(&CUBE)));
    cube.attribute = Some(("elem_type", "HEX8".into()));
    let mut wedge = variable("connect3", &[3, 5], Values::Int(plus(&WEDGE)));
    wedge.attribute = Some(("elem_type", "wedge".into()));
    let dimensions = [
        ("time_step", 0),
        ("num_dim", 3),
        ("num_nodes", 10),
        ("one", 1),
        ("eight", 8),
        ("six", 6),
        ("num_el_blk", 3),
        ("len_name", 16),
        ("num_node_sets", 1),
        ("num_side_sets", 1),
        ("num_elem_sets", 1),
        ("two", 2),
    ];
    // The second block is empty and has no variable; the element set has no name.
    let variables = [
        variable("coordx", &[2], axis(0)),
        variable("coordy", &[2], axis(1)),
        variable("coordz", &[2], axis(2)),
        variable("eb_prop1", &[6], Values::Int(vec![10, 20, 30])),
        variable(
            "eb_names",
            &[6, 7],
            texts(&["left part", "nothing", "right"]),
        ),
        cube,
        wedge,
        variable("ns_prop1", &[8], Values::Int(vec![1])),
        variable("ns_names", &[8, 7], texts(&["tip"])),
        variable("node_ns1", &[3], Values::Int(vec![10])),
        variable("ss_names", &[9, 7], texts(&["x0"])),
        variable("elem_ss1", &[3], Values::Int(vec![1])),
        variable("side_ss1", &[3], Values::Int(vec![4])),
        variable("els_prop1", &[10], Values::Int(vec![3])),
        variable("elem_els1", &[11], Values::Int(vec![1, 2])),
    ];
    cdf::file(version, &dimensions, &variables)
}

/// Cells as hexahedron or voxel and wedge, in one or two pieces.
pub fn vtu(voxel: bool, pieces: bool) -> Vec<u8> {
    let cube = match voxel {
        // x runs fastest, then y, then z.
        true => [0, 1, 3, 2, 4, 5, 7, 6],
        false => CUBE,
    };
    let kind = if voxel { 11 } else { 12 };
    let nodes: Vec<String> = (0..10).map(|k| coordinates(k, " ")).collect();
    let piece = |cells: &[(&[u32], u32, u32)]| {
        let mut end = 0;
        let (mut connectivity, mut offsets, mut types, mut blocks) =
            (vec![], vec![], vec![], vec![]);
        for (nodes, kind, block) in cells {
            end += nodes.len();
            connectivity.push(numbers(nodes, 0, " "));
            offsets.push(end.to_string());
            types.push(kind.to_string());
            blocks.push(block.to_string());
        }
        let array = |kind: &str, name: &str, words: &[String]| {
            format!(
                "<DataArray type='{kind}' Name='{name}' format='ascii'>{}</DataArray>\n",
                words.join(" ")
            )
        };
        format!(
            "<Piece NumberOfPoints='10' NumberOfCells='{}'>\n<Points>\n<DataArray type='Float64' NumberOfComponents='3' format='ascii'>\n{}\n</DataArray>\n</Points>\n<Cells>\n{}{}{}</Cells>\n<CellData>\n{}{}</CellData>\n</Piece>\n",
            cells.len(),
            nodes.join("\n"),
            array("Int64", "connectivity", &connectivity),
            array("Int64", "offsets", &offsets),
            array("UInt8", "types", &types),
            array("Int32", "Material", &blocks),
            array("Int32", "Other", &blocks),
        )
    };
    let (left, right) = ((&cube[..], kind, 1), (&WEDGE[..], 13, 2));
    let all = match pieces {
        true => piece(&[left]) + &piece(&[right]),
        false => piece(&[left, right]),
    };
    format!("<?xml version='1.0'?>\n<VTKFile type='UnstructuredGrid'>\n<UnstructuredGrid>\n{all}</UnstructuredGrid>\n</VTKFile>\n").into_bytes()
}

/// All files, with their extensions.
pub fn all() -> Vec<(&'static str, Vec<u8>)> {
    let mut files = vec![("inp", abaqus())];
    for flag in [false, true] {
        files.push(("msh", gmsh_2(flag)));
        files.push(("msh", gmsh_4(flag)));
        files.push(("vtu", vtu(flag, false)));
        files.push(("vtu", vtu(flag, true)));
    }
    files.extend([1, 2, 5].map(|version| ("exo", exodus(version))));
    files
}
