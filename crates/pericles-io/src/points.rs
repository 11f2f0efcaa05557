//! Reading of points from text: one line `x y z block volume` per point.
//!
//! | line | meaning |
//! |---|---|
//! | `# …`, `! …`, blank | ignored; `#` and `!` begin a comment anywhere in a line |
//! | `header: x y block_id volume`, `x, y, z, block, volume` | column names, in any order; optional, before the points |
//! | `0.5 0.0 0.0 1 1e-9`, `0.5, 0, 0, 1, 1e-9` | a point; numbers are separated by commas or blanks |
//!
//! Without a header the columns are `x y z block volume`, or, for bodies of lower dimension, also
//! `x y block volume` and `x block volume`. Numbers are returned as given. PeriLab and Peridigm write this
//! format.

use std::path::Path;

use pericles::space::ListedPoints;

use crate::TextError;
use crate::whole::read_whole;

/// Reads the points of a body of the given dimension. Further coordinates are not used; they must be equal
/// for all points.
///
/// # Errors
/// Returns an error if the file cannot be read, exceeds `memory` bytes or contains no points, and for the
/// first wrong line, with the allowed values.
pub fn read_points(
    path: impl AsRef<Path>,
    dimension: usize,
    memory: u64,
) -> Result<ListedPoints, TextError> {
    /// A point takes 44 bytes, up to twice that while the list grows; the shortest line has ten characters.
    const EXPANSION: u64 = 10;
    let path = path.as_ref();
    let bytes = read_whole(path, EXPANSION, memory)?;
    parse_points(path, &bytes, dimension)
}

/// Parses the content of a list of points; `name` is used in messages.
///
/// # Errors
/// As [`read_points`], except for errors of reading the file.
pub fn parse_points(
    name: impl AsRef<Path>,
    content: &[u8],
    dimension: usize,
) -> Result<ListedPoints, TextError> {
    parse(content, dimension).map_err(|wrong| match (mesh_format(name.as_ref(), content), wrong) {
        (Some(format), _) => TextError::whole(
            name,
            format!(
                "this is a mesh ({format}), not a list of points; write one line `x y z block volume` for each element, with its centre in m and its volume in m³ \
                 (the Python package meshio reads most meshes), or use shape = \"mesh\" or shape = \"surface\""
            ),
        ),
        (None, Some(Wrong { line, reason })) => TextError::line(name, line, reason),
        (None, None) => TextError::whole(
            name,
            "no points; write one line `x y z block volume` for each point",
        ),
    })
}

/// Recognises a mesh format by the beginning of the content or the file extension.
fn mesh_format(name: &Path, content: &[u8]) -> Option<&'static str> {
    const BEGINNINGS: [(&[u8], &str); 7] = [
        (b"$MeshFormat", "Gmsh"),
        (b"*heading", "Abaqus"),
        (b"*node", "Abaqus"),
        (b"solid", "STL"),
        (b"<?xml", "VTK"),
        (b"<vtkfile", "VTK"),
        (b"# vtk", "VTK"),
    ];
    const ENDINGS: [(&str, &str); 12] = [
        ("msh", "Gmsh"),
        ("inp", "Abaqus"),
        ("stl", "STL"),
        ("vtu", "VTK"),
        ("vtp", "VTK"),
        ("vtk", "VTK"),
        ("obj", "Wavefront"),
        ("ply", "PLY"),
        ("off", "OFF"),
        ("bdf", "Nastran"),
        ("exo", "Exodus"),
        ("g", "Exodus"),
    ];
    let start = content.trim_ascii_start();
    let begins = |word: &[u8]| {
        let start = start.get(..word.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(word))
    };
    let ending = name.extension()?.to_str()?.to_ascii_lowercase();
    let by_content = BEGINNINGS.iter().find(|(word, _)| begins(word));
    let by_content = by_content.map(|(_, format)| *format);
    let by_name = ENDINGS.iter().find(|(word, _)| *word == ending);
    by_content.or(by_name.map(|(_, format)| *format))
}

/// An error in a line.
#[derive(Debug, PartialEq)]
struct Wrong {
    line: usize,
    reason: String,
}

/// Meaning of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Column {
    Coordinate(usize),
    Block,
    Volume,
}

impl Column {
    fn named(name: &str) -> Option<Self> {
        Some(match name.to_lowercase().as_str() {
            "x" => Self::Coordinate(0),
            "y" => Self::Coordinate(1),
            "z" => Self::Coordinate(2),
            "block" | "block_id" | "blockid" => Self::Block,
            "volume" | "vol" => Self::Volume,
            _ => return None,
        })
    }

    fn name(self) -> &'static str {
        match self {
            Self::Coordinate(c) => ["x", "y", "z"][c],
            Self::Block => "block",
            Self::Volume => "volume",
        }
    }
}

/// Parses the points of a text; `Err(None)` if there are none.
fn parse(bytes: &[u8], dimension: usize) -> Result<ListedPoints, Option<Wrong>> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let mut points = ListedPoints::default();
    let mut lines = Vec::new();
    let mut columns: Option<Vec<Column>> = None;
    for (k, text) in bytes.split(|&byte| byte == b'\n').enumerate() {
        let wrong = |reason: String| {
            Some(Wrong {
                line: k + 1,
                reason,
            })
        };
        let text =
            std::str::from_utf8(text).map_err(|_| wrong("the line is not UTF-8 text".into()))?;
        let words = words(text);
        if words.is_empty() {
            continue;
        }
        if is_header(&words) {
            if columns.is_some() {
                return Err(wrong(format!(
                    "`{}` is not a number; column names are allowed only before the first point",
                    words[0]
                )));
            }
            columns = Some(header(&words, dimension).map_err(wrong)?);
            continue;
        }
        let columns = match &columns {
            Some(columns) => columns,
            None => columns.insert(columns_of(words.len(), dimension).map_err(wrong)?),
        };
        read_point(&words, columns, &mut points).map_err(wrong)?;
        lines.push(k + 1);
    }
    if lines.is_empty() {
        return Err(None);
    }
    check_flat(&points, dimension, &lines)?;
    match points.first_twins() {
        None => Ok(points),
        Some((first, second)) => Err(Some(Wrong {
            line: lines[second],
            reason: format!(
                "this point coincides with the point in line {}; remove one of them",
                lines[first]
            ),
        })),
    }
}

/// Splits a line into words, without its comment.
pub(crate) fn words(text: &str) -> Vec<&str> {
    let text = text.split(['#', '!']).next().unwrap_or("");
    text.split(|c: char| c == ',' || c.is_whitespace())
        .filter(|word| !word.is_empty())
        .collect()
}

/// Returns whether a line begins with a name. `nan` and `inf` count as numbers.
fn is_header(words: &[&str]) -> bool {
    let first = words[0];
    first.starts_with(|c: char| c.is_alphabetic() || c == '_') && first.parse::<f64>().is_err()
}

fn header(words: &[&str], dimension: usize) -> Result<Vec<Column>, String> {
    let allowed = "allowed: x, y, z, block (block_id) and volume, once each";
    let names = match words {
        [first, names @ ..] if first.eq_ignore_ascii_case("header:") => names,
        names => names,
    };
    let mut columns = Vec::new();
    for name in names {
        let column =
            Column::named(name).ok_or_else(|| format!("unknown column `{name}`; {allowed}"))?;
        if columns.contains(&column) {
            return Err(format!("the column `{name}` is named twice; {allowed}"));
        }
        columns.push(column);
    }
    let coordinates = (0..dimension).map(Column::Coordinate);
    let needed = coordinates.chain([Column::Block, Column::Volume]);
    match needed.into_iter().find(|column| !columns.contains(column)) {
        None => Ok(columns),
        Some(missing) => Err(format!(
            "the column `{}` is missing; a body of dimension {dimension} needs it; {allowed}",
            missing.name()
        )),
    }
}

/// Returns the columns of a line without a header.
fn columns_of(count: usize, dimension: usize) -> Result<Vec<Column>, String> {
    let coordinates = match count {
        5 => 3,
        _ if count == dimension + 2 => dimension,
        _ => {
            let own = match dimension {
                1 => "`x block volume` or ",
                2 => "`x y block volume` or ",
                _ => "",
            };
            return Err(format!(
                "{count} numbers; allowed: {own}`x y z block volume`, or a header line that names the columns"
            ));
        }
    };
    let coordinates = (0..coordinates).map(Column::Coordinate);
    Ok(coordinates.chain([Column::Block, Column::Volume]).collect())
}

fn read_point(words: &[&str], columns: &[Column], points: &mut ListedPoints) -> Result<(), String> {
    if words.len() != columns.len() {
        let names: Vec<&str> = columns.iter().map(|column| column.name()).collect();
        return Err(format!(
            "{} numbers, expected {}: {}",
            words.len(),
            columns.len(),
            names.join(" ")
        ));
    }
    let mut place = [0.0; 3];
    for (word, column) in words.iter().zip(columns) {
        let reject = |allowed: &str| {
            Err(format!(
                "the {} is `{word}`; allowed: {allowed}",
                column.name()
            ))
        };
        let number = word.parse().unwrap_or(f64::NAN);
        match *column {
            Column::Coordinate(c) if number.is_finite() => place[c] = number,
            Column::Coordinate(_) => return reject("a finite number"),
            // Many tools write all columns as reals.
            Column::Block
                if number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number) =>
            {
                points.blocks.push(number as u32);
            }
            Column::Block => return reject("a whole number, 0 or greater"),
            Column::Volume if number > 0.0 && number.is_finite() => points.volumes.push(number),
            Column::Volume => return reject("a positive number"),
        }
    }
    points.positions.push(place);
    Ok(())
}

/// Rejects coordinates beyond the dimension of the body that differ between points.
fn check_flat(
    points: &ListedPoints,
    dimension: usize,
    lines: &[usize],
) -> Result<(), Option<Wrong>> {
    let first = points.positions[0];
    for (place, &line) in points.positions.iter().zip(lines) {
        for c in dimension..3 {
            if place[c] != first[c] {
                let axis = ["x", "y", "z"][c];
                return Err(Some(Wrong {
                    line,
                    reason: format!(
                        "{axis} is {} here and {} in line {}; all points of a body of dimension {dimension} must have the same {axis}",
                        place[c], first[c], lines[0]
                    ),
                }));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, dimension: usize) -> ListedPoints {
        parse(text.as_bytes(), dimension).unwrap_or_else(|wrong| panic!("{wrong:?}"))
    }

    fn rejection(text: &str, dimension: usize) -> (usize, String) {
        match parse(text.as_bytes(), dimension) {
            Err(Some(Wrong { line, reason })) => (line, reason),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn files_of_peridigm_and_perilab_give_the_same_points() {
        let peridigm = "# x y z block volume\n0.5 0.0 0.25 1 1.0e-3\n1.5 0.0 0.25 2 2.0e-3\n";
        let points = read(peridigm, 3);
        assert_eq!(points.positions, [[0.5, 0.0, 0.25], [1.5, 0.0, 0.25]]);
        assert_eq!(
            (&points.blocks[..], &points.volumes[..]),
            (&[1, 2][..], &[1e-3, 2e-3][..])
        );
        let perilab = "header: x y block_id volume\n0.5 0.0 1 1.0e-3\n1.5 0.0 2 2.0e-3";
        let commas =
            "\u{feff}y, x, volume, block\r\n0,0.5,1e-3,1.0 ! first\r\n\r\n0,1.5,2e-3,2\r\n";
        let plane = read(perilab, 2);
        assert_eq!(plane, read(commas, 2));
        assert_eq!(plane, read("0.5 0 1 1e-3\n1.5\t0\t2\t2e-3", 2));
        // A third coordinate with equal values does not add a dimension.
        let flat = read(peridigm, 2);
        assert_eq!(
            flat.cloud(2, 1.0).unwrap().positions(),
            plane.cloud(2, 1.0).unwrap().positions()
        );
        // It is kept for use in warnings.
        assert_eq!(flat.positions[0][2], 0.25);
    }

    #[test]
    fn errors_are_reported_with_their_line() {
        let cases = [
            (
                "0 0 0 1 1\n1 0 0 1",
                3,
                2,
                "4 numbers, expected 5: x y z block volume",
            ),
            ("0 0 0\n", 3, 1, "3 numbers; allowed: `x y z block volume`"),
            ("0 0 0\n", 2, 1, "`x y block volume`"),
            (
                "\n0 0 zero 1 1",
                3,
                2,
                "the z is `zero`; allowed: a finite number",
            ),
            ("nan 0 0 1 1", 3, 1, "the x is `nan`"),
            (
                "0 0 0 1.5 1",
                3,
                1,
                "the block is `1.5`; allowed: a whole number",
            ),
            ("0 0 0 -1 1", 3, 1, "the block is `-1`"),
            (
                "0 0 0 1 -2e-9",
                3,
                1,
                "the volume is `-2e-9`; allowed: a positive number",
            ),
            ("0 0 0 1 0", 3, 1, "the volume is `0`"),
            (
                "x y z mass volume\n",
                3,
                1,
                "unknown column `mass`; allowed: x, y, z, block",
            ),
            ("x y z block x\n", 3, 1, "`x` is named twice"),
            (
                "x y block volume\n0 0 1 1",
                3,
                1,
                "the column `z` is missing",
            ),
            (
                "0 0 0 1 1\nx y z block volume\n",
                3,
                2,
                "column names are allowed only before the first point",
            ),
            ("0 0 1 1 1\n1 0 2 1 1", 2, 2, "z is 2 here and 1 in line 1"),
            (
                "0 0 0 1 1\n1 0 0 1 1\n# a comment\n0 -0.0 0 1 1",
                3,
                4,
                "coincides with the point in line 1",
            ),
        ];
        for (text, dimension, line, says) in cases {
            let (found, reason) = rejection(text, dimension);
            assert!(
                found == line && reason.contains(says),
                "{text:?}: {found}: {reason}"
            );
        }
        assert_eq!(parse(b"# nothing\n\n", 3), Err(None));
        assert!(parse(b"\xff\xfe\x00", 3).is_err());
    }

    #[test]
    fn meshes_are_recognised() {
        for (name, content, format) in [
            ("a.msh", "$MeshFormat\n4.1 0 8\n", "Gmsh"),
            (
                "plate.inp",
                "*Heading\n** by hand\n*Node\n1, 0, 0, 0\n",
                "Abaqus",
            ),
            ("a.STL", "\0\0binary", "STL"),
            ("a.txt", "solid part\nfacet normal 0 0 1\n", "STL"),
            ("a.vtu", "<?xml version=\"1.0\"?>", "VTK"),
        ] {
            let error = parse_points(name, content.as_bytes(), 3).unwrap_err();
            let message = error.to_string();
            let says = format!("{name}: this is a mesh ({format}), not a list of points");
            assert!(message.starts_with(&says), "{message}");
        }
        // A list of points may have any file extension.
        assert!(parse_points("a.inp", b"0 0 0 1 1\n", 3).is_ok());
    }

    #[test]
    fn messages_name_the_file() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("cloud.txt");
        let missing = read_points(&path, 3, u64::MAX).unwrap_err().to_string();
        assert!(missing.contains("cloud.txt"), "{missing}");
        std::fs::write(&path, "0 0 0 1 one\n").unwrap();
        let wrong = read_points(&path, 3, u64::MAX).unwrap_err().to_string();
        assert!(
            wrong.contains("cloud.txt:1: the volume is `one`"),
            "{wrong}"
        );
        std::fs::write(&path, "").unwrap();
        assert!(
            read_points(&path, 3, u64::MAX)
                .unwrap_err()
                .to_string()
                .contains("no points")
        );
    }
}
