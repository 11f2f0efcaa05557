//! VTK XML files: `UnstructuredGrid` with its cells, `PolyData` with its polygons.

use std::cell::Cell;

use super::Mesh;
use super::bytes::{Scalar, no_vertex, vertex_number};
use super::error::Fault;
use super::vtk_array::{Encoding, Source, read};

/// Cell types of VTK: triangle, polygon, quadrilateral.
const FACES: [i64; 3] = [5, 7, 9];

pub(super) fn parse(content: &[u8], memory: u64) -> Result<Mesh, Fault> {
    let file = File::new(content, memory)?;
    let points = file.array("Points", None)?.real();
    if points.len() % 3 != 0 {
        return Err(Fault::of_file(format!(
            "{} coordinates of points; three each are needed",
            points.len()
        )));
    }
    let mut mesh = Mesh {
        positions: points.as_chunks::<3>().0.to_vec(),
        triangles: Vec::new(),
    };
    let unstructured = file.has("UnstructuredGrid");
    let section = if unstructured { "Cells" } else { "Polys" };
    if !unstructured && !file.has("PolyData") {
        return Err(Fault::of_file(
            "the file holds neither an UnstructuredGrid nor PolyData",
        ));
    }
    let connectivity = file
        .array(section, Some("connectivity"))?
        .whole("connectivity")?;
    let offsets = file.array(section, Some("offsets"))?.whole("offsets")?;
    let types = match unstructured {
        true => Some(file.array(section, Some("types"))?.whole("types")?),
        false => None,
    };
    if let Some(types) = types.as_ref().filter(|types| types.len() != offsets.len()) {
        return Err(Fault::of_file(format!(
            "{} types for {} cells",
            types.len(),
            offsets.len()
        )));
    }
    let mut begin = 0;
    for (cell, &end) in offsets.iter().enumerate() {
        let range = usize::try_from(end)
            .ok()
            .and_then(|end| connectivity.get(begin..end));
        let Some(corners) = range else {
            return Err(Fault::of_file(format!(
                "cell {cell} ends at {end}; allowed: {begin} to {}",
                connectivity.len()
            )));
        };
        begin += corners.len();
        if types
            .as_ref()
            .is_some_and(|types| !FACES.contains(&types[cell]))
        {
            continue;
        }
        if corners.len() < 3 {
            return Err(Fault::of_file(format!(
                "cell {cell} has {} corner(s); at least 3 are needed",
                corners.len()
            )));
        }
        let corners = corners
            .iter()
            .map(|&number| vertex_number(number).ok_or_else(|| Fault::of_file(no_vertex(number))))
            .collect::<Result<Vec<u32>, Fault>>()?;
        mesh.polygon(&corners);
    }
    Ok(mesh)
}

/// A file in its parts: elements, and data appended to them.
pub(super) struct File<'a> {
    content: &'a [u8],
    elements: Vec<Element<'a>>,
    encoding: Encoding,
    appended: Option<(Appended, &'a [u8])>,
    /// Bytes that arrays may still take.
    room: Cell<u64>,
    memory: u64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Appended {
    Raw,
    Base64,
}

/// A start or end tag of the XML, with the place of the text behind it.
struct Element<'a> {
    tag: &'a str,
    text: usize,
}

impl<'a> Element<'a> {
    fn name(&self) -> &'a str {
        self.tag
            .split([' ', '\t', '\r', '\n', '/'])
            .find(|word| !word.is_empty())
            .unwrap_or_default()
    }

    fn ends(&self, name: &str) -> bool {
        self.tag.starts_with('/') && self.name() == name
    }

    fn starts(&self, name: &str) -> bool {
        !self.tag.starts_with('/') && self.name() == name
    }

    fn attribute(&self, name: &str) -> Option<&'a str> {
        self.tag.match_indices(name).find_map(|(place, _)| {
            let before = self.tag[..place].chars().next_back();
            let value = self.tag[place + name.len()..]
                .trim_start()
                .strip_prefix('=')?
                .trim_start();
            let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''))?;
            let value = &value[1..];
            before.filter(|c| c.is_ascii_whitespace())?;
            Some(&value[..value.find(quote)?])
        })
    }
}

impl<'a> File<'a> {
    /// A file whose content and arrays may take `memory` bytes together.
    pub(super) fn new(content: &'a [u8], memory: u64) -> Result<Self, Fault> {
        let last = b"</VTKFile>";
        if !content
            .windows(last.len())
            .rev()
            .any(|window| window == last)
        {
            return Err(Fault::of_file(
                "the file ends where </VTKFile> should follow",
            ));
        }
        let mark = b"<AppendedData";
        let appended = content
            .windows(mark.len())
            .position(|window| window == mark);
        let xml = &content[..appended.unwrap_or(content.len())];
        let mut elements = tags(xml)?;
        let appended = match appended {
            None => None,
            Some(place) => {
                let rest = &content[place..];
                let Some(end) = rest.iter().position(|&byte| byte == b'>') else {
                    return Err(Fault::of_file("the file ends within the tag AppendedData"));
                };
                elements.extend(tags(&rest[..=end])?);
                let form = match elements
                    .last()
                    .and_then(|element| element.attribute("encoding"))
                {
                    Some("raw") => Appended::Raw,
                    _ => Appended::Base64,
                };
                let data = &rest[end + 1..];
                let Some(start) = data.iter().position(|&byte| byte == b'_') else {
                    return Err(Fault::of_file("the mark _ before appended data is missing"));
                };
                Some((form, &data[start + 1..]))
            }
        };
        let Some(file) = elements.iter().find(|element| element.starts("VTKFile")) else {
            return Err(Fault::of_file("there is no element VTKFile"));
        };
        let encoding = Encoding {
            little: file.attribute("byte_order") != Some("BigEndian"),
            header: match file.attribute("header_type") {
                Some("UInt64") => Scalar::U64,
                _ => Scalar::U32,
            },
            packed: match file.attribute("compressor") {
                None => false,
                Some("vtkZLibDataCompressor") => true,
                Some(other) => {
                    return Err(Fault::of_file(format!(
                        "the compressor {other}; allowed: vtkZLibDataCompressor, or none"
                    )));
                }
            },
        };
        Ok(Self {
            content,
            elements,
            encoding,
            appended,
            room: Cell::new(memory.saturating_sub(content.len() as u64)),
            memory,
        })
    }

    fn has(&self, name: &str) -> bool {
        self.elements.iter().any(|element| element.starts(name))
    }

    /// The arrays in the first section of this name.
    fn arrays(&self, section: &str) -> impl Iterator<Item = &Element<'a>> {
        let inside = self
            .elements
            .iter()
            .skip_while(move |element| !element.starts(section));
        inside
            .take_while(move |element| !element.ends(section))
            .filter(|element| element.starts("DataArray"))
    }

    /// Names and numbers of components of the arrays in the first section of this name.
    pub(super) fn columns(&self, section: &str) -> impl Iterator<Item = (&'a str, usize)> {
        self.arrays(section).map(|array| {
            let components = array.attribute("NumberOfComponents");
            let components = components.and_then(|count| count.trim().parse().ok());
            (
                array.attribute("Name").unwrap_or_default(),
                components.unwrap_or(1),
            )
        })
    }

    /// The first array of this name, or of any, in the first section of this name.
    pub(super) fn array(
        &self,
        section: &str,
        name: Option<&str>,
    ) -> Result<super::vtk_array::Numbers, Fault> {
        let what = name.unwrap_or(section);
        let array = self
            .arrays(section)
            .find(|element| name.is_none() || element.attribute("Name") == name);
        let Some(array) = array else {
            return Err(Fault::of_file(format!(
                "there is no array {what} in {section}"
            )));
        };
        let scalar = match array.attribute("type") {
            Some("Float32") => Scalar::F32,
            Some("Float64") => Scalar::F64,
            Some("Int8") => Scalar::I8,
            Some("UInt8") => Scalar::U8,
            Some("Int16") => Scalar::I16,
            Some("UInt16") => Scalar::U16,
            Some("Int32") => Scalar::I32,
            Some("UInt32") => Scalar::U32,
            Some("Int64") => Scalar::I64,
            Some("UInt64") => Scalar::U64,
            other => {
                return Err(Fault::of_file(format!(
                    "{what}: the type {}",
                    other.unwrap_or("is missing")
                )));
            }
        };
        let text = || {
            let rest = &self.content[array.text..];
            &rest[..rest
                .iter()
                .position(|&byte| byte == b'<')
                .unwrap_or(rest.len())]
        };
        let source = match array.attribute("format") {
            Some("ascii") => Source::Text(text()),
            Some("binary") => Source::Base64(text().trim_ascii()),
            Some("appended") => {
                let offset = array
                    .attribute("offset")
                    .and_then(|offset| offset.trim().parse::<usize>().ok());
                let data = self
                    .appended
                    .zip(offset)
                    .and_then(|((form, data), offset)| Some((form, data.get(offset..)?)));
                match data {
                    Some((Appended::Raw, data)) => Source::Raw(data),
                    Some((Appended::Base64, data)) => Source::Base64(data),
                    None => {
                        return Err(Fault::of_file(format!(
                            "{what}: its offset leads beyond the appended data"
                        )));
                    }
                }
            }
            other => {
                return Err(Fault::of_file(format!(
                    "{what}: the format {:?}; allowed: ascii, binary, appended",
                    other.unwrap_or_default()
                )));
            }
        };
        let (numbers, taken) =
            read(source, scalar, self.encoding, what, self.room.get()).map_err(|fault| Fault {
                // Of the file as a whole: what arrays before have taken is needed as well.
                needed: fault
                    .needed
                    .map(|needed| needed + (self.memory - self.room.get())),
                ..fault
            })?;
        self.room.set(self.room.get() - taken);
        Ok(numbers)
    }
}

/// All tags of an XML text, comments and declarations left out.
fn tags(xml: &[u8]) -> Result<Vec<Element<'_>>, Fault> {
    let mut tags = Vec::new();
    let mut at = 0;
    while let Some(open) = xml[at..].iter().position(|&byte| byte == b'<') {
        let start = at + open + 1;
        let Some(length) = xml[start..].iter().position(|&byte| byte == b'>') else {
            return Err(Fault::of_file("the file ends within a tag"));
        };
        at = start + length + 1;
        let Ok(tag) = std::str::from_utf8(&xml[start..start + length]) else {
            return Err(Fault::at_byte(start, "a tag that is no text"));
        };
        if !tag.starts_with(['?', '!']) {
            tags.push(Element { tag, text: at });
        }
    }
    Ok(tags)
}
