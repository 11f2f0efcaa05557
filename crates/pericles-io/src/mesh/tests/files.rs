//! Files of a tetrahedron in all formats.

pub(super) const X: [[f64; 3]; 4] = [
    [1.0, 1.0, 1.0],
    [1.0, -1.0, -1.0],
    [-1.0, 1.0, -1.0],
    [-1.0, -1.0, 1.0],
];
pub(super) const T: [[u32; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];

fn coordinates(separator: &str) -> String {
    X.map(|x| format!("{} {} {}", x[0], x[1], x[2]))
        .join(separator)
}

fn corners(first: u32, lead: &str) -> String {
    T.map(|t| format!("{lead}{} {} {}\n", t[0] + first, t[1] + first, t[2] + first))
        .concat()
}

fn le<const N: usize>(numbers: impl IntoIterator<Item = [u8; N]>) -> Vec<u8> {
    numbers.into_iter().flatten().collect()
}

fn ply(form: &str, big: bool) -> Vec<u8> {
    let mut file = format!(
        "ply\nformat {form} 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty double y\nproperty float z\nproperty uchar red\n\
         element face 4\nproperty list uchar int vertex_indices\nelement other 1\nproperty list uchar short s\nend_header\n"
    )
    .into_bytes();
    let order = |mut bytes: Vec<u8>| {
        if big {
            bytes.reverse();
        }
        bytes
    };
    for x in X {
        if form == "ascii" {
            file.extend(format!("{} {} {} 7\n", x[0], x[1], x[2]).bytes());
            continue;
        }
        file.extend(order((x[0] as f32).to_le_bytes().to_vec()));
        file.extend(order(x[1].to_le_bytes().to_vec()));
        file.extend(order((x[2] as f32).to_le_bytes().to_vec()));
        file.push(7);
    }
    for t in T {
        if form == "ascii" {
            file.extend(format!("3 {} {} {}\n", t[0], t[1], t[2]).bytes());
            continue;
        }
        file.push(3);
        t.iter()
            .for_each(|v| file.extend(order(v.to_le_bytes().to_vec())));
    }
    file.extend(if form == "ascii" {
        b"2 4 5\n".to_vec()
    } else {
        vec![2, 0, 4, 0, 5]
    });
    file
}

pub(super) fn stl(binary: bool) -> Vec<u8> {
    if !binary {
        let facet = |t: [u32; 3]| {
            let corners = t.map(|v| {
                format!(
                    "vertex {} {} {}\n",
                    X[v as usize][0], X[v as usize][1], X[v as usize][2]
                )
            });
            format!(
                "facet normal 0 0 1\nouter loop\n{}endloop\nendfacet\n",
                corners.concat()
            )
        };
        return format!("solid vertex\n{}endsolid vertex\n", T.map(facet).concat()).into_bytes();
    }
    // A header that looks like text.
    let mut file = b"solid".to_vec();
    file.resize(80, b' ');
    file.extend(4u32.to_le_bytes());
    for t in T {
        file.extend([0; 12]);
        t.iter()
            .for_each(|&v| file.extend(le(X[v as usize].map(|x| (x as f32).to_le_bytes()))));
        file.extend([0; 2]);
    }
    file
}

fn gmsh(version: &str, binary: bool) -> Vec<u8> {
    let mut file = format!("$MeshFormat\n{version} {} 8\n", u8::from(binary)).into_bytes();
    if binary {
        file.extend(1u32.to_le_bytes());
        file.push(b'\n');
    }
    file.extend(b"$EndMeshFormat\n$PhysicalNames\n1\n2 1 \"$Nodes\"\n$EndPhysicalNames\n$Nodes\n");
    // Node 9 belongs to no triangle; tags start at 10.
    let tags = [10i32, 9, 11, 12, 13];
    let place = |k: usize| {
        if k == 1 {
            [0.0; 3]
        } else {
            X[k.saturating_sub(1)]
        }
    };
    match (version, binary) {
        ("2.2", false) => {
            file.extend(b"5\n");
            for (k, tag) in tags.iter().enumerate() {
                let x = place(k);
                file.extend(format!("{tag} {} {} {}\n", x[0], x[1], x[2]).bytes());
            }
            file.extend(b"$EndNodes\n$Elements\n5\n1 15 2 0 1 9\n");
            T.iter().for_each(|t| {
                file.extend(
                    format!("2 2 2 0 1 {} {} {}\n", t[0] + 10, t[1] + 10, t[2] + 10).bytes(),
                )
            });
        }
        ("2.2", true) => {
            file.extend(b"5\n");
            for (k, tag) in tags.iter().enumerate() {
                file.extend(tag.to_le_bytes());
                file.extend(le(place(k).map(f64::to_le_bytes)));
            }
            file.extend(b"\n$EndNodes\n$Elements\n5\n");
            file.extend(le([15i32, 1, 2, 1, 0, 1, 9, 2, 4, 0].map(i32::to_le_bytes)));
            T.iter().for_each(|t| {
                file.extend(le(
                    [1, t[0] + 10, t[1] + 10, t[2] + 10].map(u32::to_le_bytes)
                ))
            });
            file.push(b'\n');
        }
        (_, false) => {
            file.extend(b"1 5 9 13\n2 1 0 5\n10\n9\n11\n12\n13\n");
            (0..5).for_each(|k| {
                file.extend(format!("{} {} {}\n", place(k)[0], place(k)[1], place(k)[2]).bytes())
            });
            file.extend(b"$EndNodes\n$Elements\n2 5 1 5\n0 1 15 1\n1 9\n2 1 2 4\n");
            T.iter().for_each(|t| {
                file.extend(format!("7 {} {} {}\n", t[0] + 10, t[1] + 10, t[2] + 10).bytes())
            });
        }
        (_, true) => {
            let size = |numbers: &[u64]| le(numbers.iter().map(|n| n.to_le_bytes()));
            let int = |numbers: [i32; 3]| le(numbers.map(i32::to_le_bytes));
            file.extend(size(&[1, 5, 9, 13]));
            file.extend(int([2, 1, 0]));
            file.extend(size(&[5, 10, 9, 11, 12, 13]));
            (0..5).for_each(|k| file.extend(le(place(k).map(f64::to_le_bytes))));
            file.extend(b"\n$EndNodes\n$Elements\n");
            file.extend(size(&[2, 5, 1, 5]));
            file.extend(int([0, 1, 15]));
            file.extend(size(&[1, 1, 9]));
            file.extend(int([2, 1, 2]));
            file.extend(size(&[4]));
            T.iter().for_each(|t| {
                file.extend(size(
                    &[7, t[0].into(), t[1].into(), t[2].into()]
                        .map(|n: u64| if n == 7 { n } else { n + 10 }),
                ))
            });
            file.push(b'\n');
        }
    }
    file.extend(b"$EndElements\n");
    file
}

fn base64(data: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for group in data.chunks(3) {
        let bits = group
            .iter()
            .fold(0u32, |bits, &byte| bits << 8 | u32::from(byte))
            << (8 * (3 - group.len()));
        for k in 0..4 {
            text.push(if k > group.len() {
                '='
            } else {
                char::from(DIGITS[(bits >> (18 - 6 * k) & 63) as usize])
            });
        }
    }
    text
}

#[derive(Clone, Copy, PartialEq)]
enum Form {
    Ascii,
    Base64,
    Packed,
    Raw,
}

fn vtk(poly: bool, form: Form) -> Vec<u8> {
    let mut appended = Vec::new();
    let mut array = |kind: &str, name: &str, text: String, data: Vec<u8>| match form {
        Form::Ascii => format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">\n{text}\n</DataArray>\n"
        ),
        Form::Base64 => {
            let head = (data.len() as u32).to_le_bytes();
            let whole = base64(&[&head[..], &data].concat());
            format!(
                "<DataArray type=\"{kind}\" Name=\"{name}\" format=\"binary\">\n  {whole}\n</DataArray>\n"
            )
        }
        Form::Packed => {
            let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
            std::io::Write::write_all(&mut zlib, &data).unwrap();
            let packed = zlib.finish().unwrap();
            let table = le([1, data.len() as u32, 0, packed.len() as u32].map(u32::to_le_bytes));
            let whole = base64(&table) + &base64(&packed);
            format!(
                "<DataArray type=\"{kind}\" Name=\"{name}\" format=\"binary\">{whole}</DataArray>\n"
            )
        }
        Form::Raw => {
            let offset = appended.len();
            appended.extend((data.len() as u32).to_le_bytes());
            appended.extend(&data);
            format!(
                "<DataArray type='{kind}' Name='{name}' format='appended' offset='{offset}'/>\n"
            )
        }
    };
    let real = le(X.iter().flatten().map(|x| x.to_le_bytes()));
    let points = array("Float64", "Points", coordinates("\n"), real);
    // In an unstructured grid a single point comes first.
    let lead: &[i32] = if poly { &[] } else { &[4] };
    let connectivity: Vec<i32> = lead
        .iter()
        .copied()
        .chain(T.iter().flatten().map(|&v| v as i32))
        .collect();
    let offsets: Vec<i32> = (0..lead.len())
        .map(|_| 1)
        .chain((1..=4).map(|k| 3 * k + lead.len() as i32))
        .collect();
    let words = |numbers: &[i32]| {
        numbers
            .iter()
            .map(i32::to_string)
            .collect::<Vec<_>>()
            .join(" ")
    };
    let int = |numbers: &[i32]| le(numbers.iter().map(|n| n.to_le_bytes()));
    let cells = array(
        "Int32",
        "connectivity",
        words(&connectivity),
        int(&connectivity),
    ) + &array("Int32", "offsets", words(&offsets), int(&offsets));
    let kind = if poly { "PolyData" } else { "UnstructuredGrid" };
    let cells = if poly {
        format!("<Polys>\n{cells}</Polys>")
    } else {
        format!(
            "<Cells>\n{cells}{}</Cells>",
            array("UInt8", "types", "1 5 5 5 5".into(), vec![1, 5, 5, 5, 5])
        )
    };
    let compressor = if form == Form::Packed {
        " compressor=\"vtkZLibDataCompressor\""
    } else {
        ""
    };
    let mut file = format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\"{compressor}>\n<{kind}>\n\
         <Piece>\n<PointData>\n</PointData>\n<Points>\n{points}</Points>\n{cells}\n</Piece>\n</{kind}>\n"
    )
    .into_bytes();
    if form == Form::Raw {
        file.extend(b"<AppendedData encoding=\"raw\">\n_");
        file.extend(appended);
        file.extend(b"\n</AppendedData>\n");
    }
    file.extend(b"</VTKFile>\n");
    file
}

pub(super) fn files() -> Vec<(&'static str, Vec<u8>)> {
    let mut files = vec![
        (
            "obj",
            format!(
                "# by hand\no thing\nv {}\nvn 0 0 1\n{}",
                coordinates("\nv "),
                corners(1, "f ")
            )
            .into_bytes(),
        ),
        (
            "obj",
            format!(
                "v {}\n{}",
                coordinates(" 0.5\nv "),
                corners(1, "f ")
                    .replace("1 2 3", "-4/1/1 -3//2 -2")
                    .replace('\n', "\r\n")
            )
            .into_bytes(),
        ),
        (
            "off",
            format!(
                "OFF # by hand\n4 4 6\n{}\n{}",
                coordinates("\n"),
                corners(0, "3 ")
            )
            .into_bytes(),
        ),
        ("ply", ply("ascii", false)),
        ("ply", ply("binary_little_endian", false)),
        ("ply", ply("binary_big_endian", true)),
        ("stl", stl(false)),
        ("stl", stl(true)),
    ];
    for version in ["2.2", "4.1"] {
        files.extend([false, true].map(|binary| ("msh", gmsh(version, binary))));
    }
    for form in [Form::Ascii, Form::Base64, Form::Packed, Form::Raw] {
        files.push(("vtp", vtk(true, form)));
        files.push(("vtu", vtk(false, form)));
    }
    files
}
