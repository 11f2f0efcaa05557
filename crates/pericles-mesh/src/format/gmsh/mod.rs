//! Gmsh 2.2 and 4.1, as text or binary: elements of any type and order by their corners, and physical groups.
//!
//! In version 2.2 an element of several groups is repeated for each group with different numbers: these are
//! merged. In version 4.1 an element belongs to the groups of its entity.

mod elements;
mod groups;
mod numbers;

use crate::fault::Fault;
use crate::raw::RawMesh;
use crate::scan::{Bytes, Words};
use elements::Reading;
use numbers::{Numbers, Version};

#[derive(Debug, Clone, Copy)]
struct Format {
    version: Version,
    /// Byte order of a binary file.
    binary: Option<bool>,
}

pub(crate) fn parse(content: &[u8]) -> Result<RawMesh, Fault> {
    let mut words = Words::new(content, None);
    let mut format = None;
    let mut reading = Reading::default();
    while let Some(word) = words.next() {
        let Some(section) = word.strip_prefix('$') else {
            return Err(words.fault(format!("found {word:?}, expected a section such as $Nodes")));
        };
        let reader = format.map(|format: Format| {
            let numbers = match format.binary {
                None => {
                    let mut inside = Words::new(content, None);
                    inside.skip_to(words.position());
                    Numbers::Text(inside)
                }
                // Binary data begin after the end of the line; text of version 2 before them is read by the
                // section.
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
                return Err(words.fault(format!("${section} appears before $MeshFormat")));
            }
            ("ParametricNodes", _) => {
                return Err(words.fault(
                    "the section $ParametricNodes is not supported; save the mesh without parametric coordinates (Mesh.SaveParametric = 0)",
                ));
            }
            ("PhysicalNames", _) => reading.groups.read_names(&mut words)?,
            ("Entities", Some((mut numbers, format))) if format.version == Version::Four => {
                reading.groups.read_entities(&mut numbers)?;
                words.skip_to(numbers.position());
            }
            ("PartitionedEntities", Some((mut numbers, _))) => {
                reading.groups.read_partitioned(&mut numbers)?;
                words.skip_to(numbers.position());
            }
            ("Nodes", Some((mut numbers, format))) => {
                reading.read_nodes(&mut numbers, format, content)?;
                words.skip_to(numbers.position());
            }
            ("Elements", Some((mut numbers, format))) => {
                reading.read_elements(&mut numbers, format, content)?;
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
            None => return Err(words.fault(format!("unexpected end of file; expected {end}"))),
        }
    }
    if format.is_none() {
        return Err(Fault::of_file("the section $MeshFormat is missing"));
    }
    let Reading {
        mut mesh, groups, ..
    } = reading;
    mesh.groups = groups.lists();
    Ok(mesh)
}

/// Returns the position after the end of a line.
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
        other => {
            return Err(words.fault(format!("unsupported version {other}; allowed: 2.2 and 4.1")));
        }
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
                _ => return Err(words.fault("the integer 1 that marks the byte order is missing")),
            }
        }
        other => {
            return Err(words.fault(format!(
                "the file type is {other:?}; allowed: 0 (text) and 1 (binary)"
            )));
        }
    };
    Ok(Format { version, binary })
}
