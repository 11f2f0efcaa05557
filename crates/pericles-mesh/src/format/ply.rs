//! PLY: a header that defines the elements and their properties, then the elements, as text or binary of
//! either byte order.

use crate::fault::Fault;
use crate::raw::RawMesh;
use crate::scan::Words;
use crate::scan::{Bytes, Scalar, no_vertex, vertex_number};

/// Maximum number of elements without properties, which take no space in the file.
const MOST_EMPTY: u64 = 1 << 20;

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

struct Property {
    name: String,
    /// Type of the list length, if it is a list.
    list: Option<Scalar>,
    scalar: Scalar,
}

enum Form {
    Text,
    Binary { little: bool },
}

/// Numbers in text or binary form.
enum Numbers<'a> {
    Text(Words<'a>),
    Binary(Bytes<'a>),
}

impl Numbers<'_> {
    fn real(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        match self {
            Self::Text(words) => words.number("a number"),
            Self::Binary(bytes) => bytes.real(scalar),
        }
    }

    fn integer(&mut self, scalar: Scalar) -> Result<i64, Fault> {
        match self {
            Self::Text(words) => words.number("a whole number"),
            Self::Binary(bytes) => bytes.integer(scalar),
        }
    }

    fn fault(&self, reason: String) -> Fault {
        match self {
            Self::Text(words) => words.fault(reason),
            Self::Binary(bytes) => bytes.fault(reason),
        }
    }

    /// Reads the entries of a list.
    fn list(&mut self, count: Scalar, entry: Scalar) -> Result<Vec<i64>, Fault> {
        let length = match self {
            Self::Text(words) => words.count("list entries", 1)?,
            Self::Binary(bytes) => {
                let length = bytes.integer(count)?;
                let length = u64::try_from(length)
                    .map_err(|_| bytes.fault(format!("the list length {length} is not valid")))?;
                bytes.room(length, entry.bytes(), "list entries")?
            }
        };
        (0..length).map(|_| self.integer(entry)).collect()
    }

    /// Skips a property that is not used.
    fn skip(&mut self, property: &Property) -> Result<(), Fault> {
        let Some(count) = property.list else {
            return self.real(property.scalar).map(|_| ());
        };
        let length = self.integer(count)?;
        for _ in 0..length {
            self.real(property.scalar)?;
        }
        Ok(())
    }
}

pub(crate) fn parse(content: &[u8]) -> Result<RawMesh, Fault> {
    let mut words = Words::new(content, None);
    if words.next() != Some("ply") {
        return Err(words.fault("the file does not begin with the word ply"));
    }
    let (form, elements) = header(&mut words)?;
    // Binary data begin directly after the end of the line.
    let data = (words.position() + 1).min(content.len());
    let mut numbers = match form {
        Form::Text => Numbers::Text(words),
        Form::Binary { little } => Numbers::Binary(Bytes::new(content, data, little)),
    };
    let mut mesh = RawMesh::default();
    for element in &elements {
        check_count(&numbers, element, content.len())?;
        for _ in 0..element.count {
            match element.name.as_str() {
                "vertex" => vertex(&mut numbers, element, &mut mesh)?,
                "face" => face(&mut numbers, element, &mut mesh)?,
                _ => element
                    .properties
                    .iter()
                    .try_for_each(|property| numbers.skip(property))?,
            }
        }
    }
    Ok(mesh)
}

/// Checks that the file is long enough for a count.
fn check_count(numbers: &Numbers<'_>, element: &Element, length: usize) -> Result<(), Fault> {
    let smallest = element
        .properties
        .iter()
        .map(|p| p.list.unwrap_or(p.scalar).bytes());
    let (left, each) = match numbers {
        Numbers::Text(words) => (length - words.position() + 1, 2 * element.properties.len()),
        Numbers::Binary(bytes) => (length - bytes.position(), smallest.sum()),
    };
    let room = left
        .checked_div(each)
        .map_or(MOST_EMPTY, |room| room as u64);
    if element.count > room {
        return Err(numbers.fault(format!(
            "{} elements \"{}\" are declared, but the remaining {left} bytes hold at most {room}",
            element.count, element.name
        )));
    }
    Ok(())
}

fn header(words: &mut Words<'_>) -> Result<(Form, Vec<Element>), Fault> {
    let mut form = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let key = words.word("end_header")?;
        match key {
            "format" => {
                form = Some(match words.word("a format")? {
                    "ascii" => Form::Text,
                    "binary_little_endian" => Form::Binary { little: true },
                    "binary_big_endian" => Form::Binary { little: false },
                    other => {
                        return Err(words.fault(format!(
                            "unknown format {other:?}; allowed: ascii, binary_little_endian, binary_big_endian"
                        )));
                    }
                });
            }
            "element" => elements.push(Element {
                name: words.word("a name")?.into(),
                count: words.number("a number of elements")?,
                properties: Vec::new(),
            }),
            "property" => {
                let property = property(words)?;
                match elements.last_mut() {
                    Some(element) => element.properties.push(property),
                    None => return Err(words.fault("a property is given before any element")),
                }
            }
            "end_header" => break,
            _ => {}
        }
        words.skip_line();
    }
    words.skip_line();
    match form {
        Some(form) => Ok((form, elements)),
        None => Err(words.fault("the header does not specify a format")),
    }
}

fn property(words: &mut Words<'_>) -> Result<Property, Fault> {
    let kind = words.word("a type")?;
    let (list, scalar) = if kind == "list" {
        let count = words.word("a type")?;
        let entry = words.word("a type")?;
        (Some(scalar(words, count)?), scalar(words, entry)?)
    } else {
        (None, scalar(words, kind)?)
    };
    Ok(Property {
        name: words.word("a name")?.into(),
        list,
        scalar,
    })
}

fn scalar(words: &Words<'_>, name: &str) -> Result<Scalar, Fault> {
    Ok(match name {
        "char" | "int8" => Scalar::I8,
        "uchar" | "uint8" => Scalar::U8,
        "short" | "int16" => Scalar::I16,
        "ushort" | "uint16" => Scalar::U16,
        "int" | "int32" => Scalar::I32,
        "uint" | "uint32" => Scalar::U32,
        "float" | "float32" => Scalar::F32,
        "double" | "float64" => Scalar::F64,
        _ => {
            return Err(words.fault(format!(
                "unknown type {name:?}; allowed: char, uchar, short, ushort, int, uint, float, double"
            )));
        }
    })
}

fn vertex(numbers: &mut Numbers<'_>, element: &Element, mesh: &mut RawMesh) -> Result<(), Fault> {
    let mut position = [f64::NAN; 3];
    for property in &element.properties {
        match ["x", "y", "z"]
            .iter()
            .position(|axis| *axis == property.name)
        {
            Some(c) if property.list.is_none() => position[c] = numbers.real(property.scalar)?,
            _ => numbers.skip(property)?,
        }
    }
    mesh.nodes.push(position);
    Ok(())
}

fn face(numbers: &mut Numbers<'_>, element: &Element, mesh: &mut RawMesh) -> Result<(), Fault> {
    for property in &element.properties {
        match (property.name.as_str(), property.list) {
            ("vertex_indices" | "vertex_index", Some(count)) => {
                let corners = numbers.list(count, property.scalar)?;
                if corners.len() < 3 {
                    return Err(numbers.fault(format!(
                        "the face has {} corner(s); at least 3 are required",
                        corners.len()
                    )));
                }
                let corners = corners
                    .into_iter()
                    .map(|number| {
                        vertex_number(number).ok_or_else(|| numbers.fault(no_vertex(number)))
                    })
                    .collect::<Result<Vec<u32>, Fault>>()?;
                mesh.polygon(&corners);
            }
            _ => numbers.skip(property)?,
        }
    }
    Ok(())
}
