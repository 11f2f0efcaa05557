//! Gmsh 2.2 and 4.1, as text or binary: the sections `$Nodes` and `$Elements`. Triangles and quadrilaterals of any order are taken with their corners; lines,
//! points and solids are left out.

use std::collections::HashMap;

use super::Mesh;
use super::bytes::{Bytes, Scalar};
use super::error::Fault;
use super::words::Words;

/// Nodes of each type of element, from type 1 on (Gmsh reference manual, MSH file format).
const NODES: [usize; 31] = [
    2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6,
    20, 35, 56,
];

/// How many nodes an element of this type has; none of a type that is not known.
fn nodes_of(kind: i64) -> Option<usize> {
    NODES.get(usize::try_from(kind - 1).ok()?).copied()
}

/// How many of its nodes are corners of a face: 3 of a triangle, 4 of a quadrilateral, none of other elements.
fn corners_of(kind: i64) -> usize {
    match kind {
        2 | 9 | 20..=25 => 3,
        3 | 10 | 16 => 4,
        _ => 0,
    }
}

/// Numbers of a text or of bytes; both forms have the same numbers in the same order, but for elements of version 2.
enum Numbers<'a> {
    Text(Words<'a>),
    Binary(Bytes<'a>),
}

impl Numbers<'_> {
    fn int(&mut self) -> Result<i64, Fault> {
        match self {
            Self::Text(words) => words.number("a whole number"),
            Self::Binary(bytes) => bytes.integer(Scalar::I32),
        }
    }

    fn tag(&mut self, version: Version) -> Result<i64, Fault> {
        match (self, version) {
            (Self::Binary(bytes), Version::Four) => bytes.integer(Scalar::U64),
            (numbers, _) => numbers.int(),
        }
    }

    fn real(&mut self) -> Result<f64, Fault> {
        match self {
            Self::Text(words) => words.number("a coordinate"),
            Self::Binary(bytes) => bytes.real(Scalar::F64),
        }
    }

    fn point(&mut self) -> Result<[f64; 3], Fault> {
        Ok([self.real()?, self.real()?, self.real()?])
    }

    /// A number of things that take so many numbers each.
    fn count(&mut self, version: Version, what: &str, numbers_each: usize) -> Result<usize, Fault> {
        match self {
            Self::Text(words) => words.count(what, numbers_each),
            Self::Binary(bytes) => {
                let count = match version {
                    Version::Two => bytes.integer(Scalar::I32)?,
                    Version::Four => bytes.integer(Scalar::U64)?,
                };
                let count = u64::try_from(count)
                    .map_err(|_| bytes.fault(format!("{count} {what} are announced")))?;
                // The smallest numbers have four bytes.
                bytes.room(count, 4 * numbers_each, what)
            }
        }
    }

    fn fault(&self, reason: String) -> Fault {
        match self {
            Self::Text(words) => words.fault(reason),
            Self::Binary(bytes) => bytes.fault(reason),
        }
    }

    fn position(&self) -> usize {
        match self {
            Self::Text(words) => words.position(),
            Self::Binary(bytes) => bytes.position(),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    Two,
    Four,
}

#[derive(Debug, Clone, Copy)]
struct Format {
    version: Version,
    /// Byte order, if the file is binary.
    binary: Option<bool>,
}

pub(super) fn parse(content: &[u8]) -> Result<Mesh, Fault> {
    let mut words = Words::new(content, None);
    let mut format = None;
    let mut nodes = HashMap::new();
    let mut mesh = Mesh::default();
    while let Some(word) = words.next() {
        let Some(section) = word.strip_prefix('$') else {
            return Err(words.fault(format!(
                "{word:?} where a section such as $Nodes should begin"
            )));
        };
        let reader = format.map(|format: Format| {
            let numbers = match format.binary {
                None => {
                    let mut inside = Words::new(content, None);
                    inside.skip_to(words.position());
                    Numbers::Text(inside)
                }
                // Binary data begin after the line's end; what version 2 writes as text before them is read there.
                Some(little) => Numbers::Binary(Bytes::new(
                    content,
                    line_end(content, words.position()),
                    little,
                )),
            };
            (numbers, format)
        });
        match (section, reader) {
            ("MeshFormat", _) => format = Some(mesh_format(&mut words, content)?),
            ("Nodes" | "Elements", None) => {
                return Err(words.fault(format!("${section} before $MeshFormat")));
            }
            ("Nodes", Some((mut numbers, format))) => {
                read_nodes(&mut numbers, format, content, &mut nodes, &mut mesh)?;
                words.skip_to(numbers.position());
            }
            ("Elements", Some((mut numbers, format))) => {
                read_elements(&mut numbers, format, content, &nodes, &mut mesh)?;
                words.skip_to(numbers.position());
            }
            _ => {}
        }
        let end = format!("$End{section}");
        let rest = &content[words.position()..];
        match rest
            .windows(end.len())
            .position(|window| window == end.as_bytes())
        {
            Some(place) => words.skip_to(words.position() + place + end.len()),
            None => return Err(words.fault(format!("the file ends where {end} should follow"))),
        }
    }
    if format.is_none() {
        return Err(Fault::of_file("there is no section $MeshFormat"));
    }
    Ok(mesh)
}

/// The place after the end of a line.
fn line_end(content: &[u8], position: usize) -> usize {
    let rest = &content[position.min(content.len())..];
    position
        + rest
            .iter()
            .position(|&byte| byte == b'\n')
            .map_or(rest.len(), |at| at + 1)
}

fn mesh_format(words: &mut Words<'_>, content: &[u8]) -> Result<Format, Fault> {
    let version = match words.word("a version")? {
        "2" | "2.1" | "2.2" => Version::Two,
        "4.1" => Version::Four,
        other => return Err(words.fault(format!("version {other}; allowed: 2.2 and 4.1"))),
    };
    let binary = match words.word("0 or 1")? {
        "0" => None,
        "1" => {
            words.word("the size of numbers")?;
            let start = line_end(content, words.position());
            let one = content.get(start..start + 4);
            match one {
                Some([1, 0, 0, 0]) => Some(true),
                Some([0, 0, 0, 1]) => Some(false),
                _ => return Err(words.fault("the number one that tells the byte order is missing")),
            }
        }
        other => return Err(words.fault(format!("{other:?} for text or binary; allowed: 0 and 1"))),
    };
    Ok(Format { version, binary })
}

/// The number of nodes or elements of version 2, which is text in binary files too.
fn count_of_two(
    numbers: &mut Numbers<'_>,
    content: &[u8],
    what: &str,
    numbers_each: usize,
) -> Result<usize, Fault> {
    if let Numbers::Binary(bytes) = numbers {
        let mut words = Words::new(content, None);
        words.skip_to(bytes.position());
        let count: u64 = words.number(&format!("a number of {what}"))?;
        bytes.take(line_end(content, words.position()).min(content.len()) - bytes.position())?;
        return bytes.room(count, 4 * numbers_each, what);
    }
    numbers.count(Version::Two, what, numbers_each)
}

fn read_nodes(
    numbers: &mut Numbers<'_>,
    format: Format,
    content: &[u8],
    nodes: &mut HashMap<i64, u32>,
    mesh: &mut Mesh,
) -> Result<(), Fault> {
    let mut add = |numbers: &Numbers<'_>, tag: i64, point: [f64; 3]| {
        if nodes.insert(tag, mesh.positions.len() as u32).is_some() {
            return Err(numbers.fault(format!("node {tag} is there twice")));
        }
        mesh.positions.push(point);
        Ok(())
    };
    if format.version == Version::Two {
        for _ in 0..count_of_two(numbers, content, "nodes", 4)? {
            let tag = numbers.int()?;
            let point = numbers.point()?;
            add(numbers, tag, point)?;
        }
        return Ok(());
    }
    let blocks = numbers.count(Version::Four, "blocks of nodes", 4)?;
    for _ in 0..3 {
        numbers.tag(Version::Four)?;
    }
    for _ in 0..blocks {
        let dimension = numbers.int()?;
        numbers.int()?;
        let parametric = numbers.int()? != 0;
        let extra = if parametric { dimension.clamp(0, 3) } else { 0 };
        let count = numbers.count(Version::Four, "nodes", 4)?;
        let tags = (0..count)
            .map(|_| numbers.tag(Version::Four))
            .collect::<Result<Vec<i64>, Fault>>()?;
        for tag in tags {
            let point = numbers.point()?;
            for _ in 0..extra {
                numbers.real()?;
            }
            add(numbers, tag, point)?;
        }
    }
    Ok(())
}

fn read_elements(
    numbers: &mut Numbers<'_>,
    format: Format,
    content: &[u8],
    nodes: &HashMap<i64, u32>,
    mesh: &mut Mesh,
) -> Result<(), Fault> {
    if format.version == Version::Four {
        let blocks = numbers.count(Version::Four, "blocks of elements", 4)?;
        for _ in 0..3 {
            numbers.tag(Version::Four)?;
        }
        for _ in 0..blocks {
            numbers.int()?;
            numbers.int()?;
            let kind = numbers.int()?;
            let count = numbers.count(Version::Four, "elements", 2)?;
            for _ in 0..count {
                numbers.tag(Version::Four)?;
                element(numbers, format.version, kind, nodes, mesh)?;
            }
        }
        return Ok(());
    }
    let mut left = count_of_two(numbers, content, "elements", 3)?;
    while left > 0 {
        // As text every element has its own head; in binary files several of one type follow a common one.
        let (kind, count, tags) = match numbers {
            Numbers::Text(_) => {
                numbers.int()?;
                (numbers.int()?, 1, numbers.int()?)
            }
            Numbers::Binary(_) => {
                let (kind, count, tags) = (numbers.int()?, numbers.int()?, numbers.int()?);
                let count = usize::try_from(count)
                    .ok()
                    .filter(|&count| (1..=left).contains(&count));
                let count = count.ok_or_else(|| {
                    numbers.fault(format!("a block of more elements than the {left} left"))
                })?;
                (kind, count, tags)
            }
        };
        for _ in 0..count {
            if matches!(numbers, Numbers::Binary(_)) {
                numbers.int()?;
            }
            for _ in 0..tags {
                numbers.int()?;
            }
            element(numbers, format.version, kind, nodes, mesh)?;
        }
        left -= count;
    }
    Ok(())
}

fn element(
    numbers: &mut Numbers<'_>,
    version: Version,
    kind: i64,
    nodes: &HashMap<i64, u32>,
    mesh: &mut Mesh,
) -> Result<(), Fault> {
    let Some(count) = nodes_of(kind) else {
        return Err(numbers.fault(format!(
            "elements of type {kind} are not known; allowed: 1 to 31"
        )));
    };
    let wanted = corners_of(kind);
    let mut polygon = Vec::with_capacity(wanted);
    for place in 0..count {
        let tag = numbers.tag(version)?;
        if place < wanted {
            match nodes.get(&tag) {
                Some(&vertex) => polygon.push(vertex),
                None => {
                    return Err(numbers.fault(format!(
                        "an element has the node {tag}, which is not among the nodes"
                    )));
                }
            }
        }
    }
    if wanted > 0 {
        mesh.polygon(&polygon);
    }
    Ok(())
}
