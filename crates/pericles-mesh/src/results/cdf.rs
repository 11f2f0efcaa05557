//! Header of a CDF-2 file (classic netCDF with 64-bit offsets), and the offsets of its values.

use super::{WriteError, unsuitable};

/// Value types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Type {
    Character = 2,
    Int = 4,
    Float = 5,
    Double = 6,
}

impl Type {
    fn bytes(self) -> u64 {
        match self {
            Self::Character => 1,
            Self::Int | Self::Float => 4,
            Self::Double => 8,
        }
    }
}

/// An attribute.
pub(super) enum Attribute {
    Text(String),
    Int(i32),
    Float(f32),
}

/// A variable; the record dimension has length zero and comes first.
struct Variable {
    name: String,
    dimensions: Vec<usize>,
    attributes: Vec<(String, Attribute)>,
    kind: Type,
}

/// Dimensions, attributes and variables of a file.
#[derive(Default)]
pub(super) struct Header {
    dimensions: Vec<(String, u32)>,
    attributes: Vec<(String, Attribute)>,
    variables: Vec<Variable>,
}

/// Offsets in the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Places {
    /// The header, for zero records.
    pub(super) header: Vec<u8>,
    /// Offset of each variable, or of its first record.
    pub(super) begins: Vec<u64>,
    /// Offset of the first record.
    pub(super) first_record: u64,
    pub(super) record_bytes: u64,
}

/// Maximum size of a variable in the format.
const MOST_BYTES: u64 = u32::MAX as u64 - 3;

impl Header {
    /// Adds a dimension; length zero marks the record dimension.
    pub(super) fn dimension(
        &mut self,
        name: impl Into<String>,
        length: usize,
    ) -> Result<usize, WriteError> {
        let name = name.into();
        let Ok(length) = u32::try_from(length) else {
            return unsuitable(format!(
                "{name} is {length}; Exodus files allow at most {}",
                u32::MAX
            ));
        };
        self.dimensions.push((name, length));
        Ok(self.dimensions.len() - 1)
    }

    pub(super) fn attribute(&mut self, name: &str, attribute: Attribute) {
        self.attributes.push((name.to_owned(), attribute));
    }

    /// Adds a variable and returns its index.
    pub(super) fn variable(
        &mut self,
        name: impl Into<String>,
        kind: Type,
        dimensions: &[usize],
    ) -> usize {
        self.variables.push(Variable {
            name: name.into(),
            dimensions: dimensions.to_vec(),
            attributes: Vec::new(),
            kind,
        });
        self.variables.len() - 1
    }

    /// Adds an attribute to the last variable.
    pub(super) fn of_last(&mut self, name: &str, text: &str) {
        if let Some(variable) = self.variables.last_mut() {
            let text = Attribute::Text(text.to_owned());
            variable.attributes.push((name.to_owned(), text));
        }
    }

    /// Computes header and offsets.
    pub(super) fn places(&self) -> Result<Places, WriteError> {
        let begin = self.bytes(&vec![0; self.variables.len()])?.len() as u64;
        let mut begins = vec![0; self.variables.len()];
        let mut next = begin;
        let mut first_record = begin;
        for of_records in [false, true] {
            first_record = next;
            for (place, variable) in begins.iter_mut().zip(&self.variables) {
                if self.has_records(variable) == of_records {
                    *place = next;
                    next += self.size(variable)?;
                }
            }
        }
        Ok(Places {
            header: self.bytes(&begins)?,
            begins,
            first_record,
            record_bytes: next - first_record,
        })
    }

    fn has_records(&self, variable: &Variable) -> bool {
        variable
            .dimensions
            .first()
            .is_some_and(|&d| self.dimensions[d].1 == 0)
    }

    /// Returns the padded size of a variable or of its record, in bytes.
    fn size(&self, variable: &Variable) -> Result<u64, WriteError> {
        let lengths = variable
            .dimensions
            .iter()
            .map(|&d| u64::from(self.dimensions[d].1));
        let lengths = lengths.skip(usize::from(self.has_records(variable)));
        let size = lengths.fold(variable.kind.bytes(), u64::saturating_mul);
        if size > MOST_BYTES {
            return unsuitable(format!(
                "{} would take {size} bytes; a variable of an Exodus file is limited to 4 GiB, which allows at most {:.1e} points",
                variable.name,
                MOST_BYTES as f64 / variable.kind.bytes() as f64
            ));
        }
        Ok(size.next_multiple_of(4))
    }

    fn bytes(&self, begins: &[u64]) -> Result<Vec<u8>, WriteError> {
        let mut out = b"CDF\x02\0\0\0\0".to_vec();
        let int = |out: &mut Vec<u8>, x: usize| out.extend((x as u32).to_be_bytes());
        list(&mut out, 10, self.dimensions.len());
        for (name, length) in &self.dimensions {
            text(&mut out, name);
            out.extend(length.to_be_bytes());
        }
        attributes(&mut out, &self.attributes);
        list(&mut out, 11, self.variables.len());
        for (variable, begin) in self.variables.iter().zip(begins) {
            text(&mut out, &variable.name);
            int(&mut out, variable.dimensions.len());
            for &dimension in &variable.dimensions {
                int(&mut out, dimension);
            }
            attributes(&mut out, &variable.attributes);
            int(&mut out, variable.kind as usize);
            out.extend((self.size(variable)? as u32).to_be_bytes());
            out.extend(begin.to_be_bytes());
        }
        Ok(out)
    }
}

/// Writes a tag and a count; both are zero for an empty list.
fn list(out: &mut Vec<u8>, tag: u32, count: usize) {
    let tag = if count == 0 { 0 } else { tag };
    out.extend(tag.to_be_bytes());
    out.extend((count as u32).to_be_bytes());
}

/// Writes a length and a text, padded.
fn text(out: &mut Vec<u8>, text: &str) {
    out.extend((text.len() as u32).to_be_bytes());
    out.extend(text.as_bytes());
    out.resize(out.len().next_multiple_of(4), 0);
}

fn attributes(out: &mut Vec<u8>, all: &[(String, Attribute)]) {
    list(out, 12, all.len());
    for (name, attribute) in all {
        text(out, name);
        match attribute {
            Attribute::Text(value) => {
                out.extend((Type::Character as u32).to_be_bytes());
                text(out, value);
            }
            Attribute::Int(value) => {
                out.extend((Type::Int as u32).to_be_bytes());
                out.extend(1u32.to_be_bytes());
                out.extend(value.to_be_bytes());
            }
            Attribute::Float(value) => {
                out.extend((Type::Float as u32).to_be_bytes());
                out.extend(1u32.to_be_bytes());
                out.extend(value.to_be_bytes());
            }
        }
    }
}
