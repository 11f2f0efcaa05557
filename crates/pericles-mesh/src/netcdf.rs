//! Classic netCDF files: CDF-1, CDF-2 (64-bit offsets) and CDF-5 (64-bit data), as Exodus II is written in.
//!
//! All numbers are big-endian. A file is a magic number, the number of records, dimensions, attributes, variables with the places of their values, then
//! the values: those of fixed variables one after the other, then records with the values of all variables that have the record dimension. Lengths in the
//! header of a variable may be wrong by design (beyond 4 GiB) and are computed instead.

use std::cell::Cell;

use crate::fault::Fault;
use crate::scan::{Bytes, Scalar};

/// A file, whose header is read.
#[derive(Debug)]
pub(crate) struct NetCdf<'a> {
    content: &'a [u8],
    records: u64,
    /// Bytes of a record.
    record_bytes: u64,
    dimensions: Vec<(String, u64)>,
    variables: Vec<Variable>,
    /// Bytes of values that may still be read: variables that overlap cannot multiply a file.
    room: Cell<u64>,
}

/// Times that the bytes of a file may be read.
const READINGS: u64 = 4;

/// A variable.
#[derive(Debug)]
pub(crate) struct Variable {
    name: String,
    dimensions: Vec<usize>,
    attributes: Vec<(String, String)>,
    scalar: Type,
    begin: u64,
    has_records: bool,
    /// Values of the whole variable, or of one record.
    len: u64,
}

impl Variable {
    /// The text of an attribute.
    pub(crate) fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(given, _)| given == name);
        found.map(|(_, text)| text.as_str())
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Type {
    Character,
    Number(Scalar),
}

impl Type {
    fn bytes(self) -> u64 {
        match self {
            Self::Character => 1,
            Self::Number(scalar) => scalar.bytes() as u64,
        }
    }
}

struct Header<'a> {
    bytes: Bytes<'a>,
    version: u8,
}

impl Header<'_> {
    fn int(&mut self) -> Result<u64, Fault> {
        Ok(self.bytes.integer(Scalar::U32)? as u64)
    }

    /// A size: eight bytes in CDF-5, else four.
    fn size(&mut self) -> Result<u64, Fault> {
        match self.version {
            5 => self.bytes.integer(Scalar::U64).map(|size| size as u64),
            _ => self.int(),
        }
    }

    /// A tag and the number of entries that follow.
    fn list(&mut self, tag: u64, what: &str) -> Result<usize, Fault> {
        let found = self.int()?;
        let count = self.size()?;
        if found != tag && (found != 0 || count != 0) {
            let reason = format!("the tag {found} where {what} (tag {tag}) should begin");
            return Err(self.bytes.fault(reason));
        }
        // A name's length and another number at least.
        self.bytes.room(count, 8, what)
    }

    fn padded(&mut self, count: u64) -> Result<&[u8], Fault> {
        let count = self.bytes.room(count, 1, "bytes")?;
        let taken = self.bytes.take(count)?;
        self.bytes.take(count.next_multiple_of(4) - count)?;
        Ok(taken)
    }

    fn name(&mut self) -> Result<String, Fault> {
        let length = self.size()?;
        Ok(String::from_utf8_lossy(self.padded(length)?).into_owned())
    }

    fn scalar(&mut self) -> Result<Type, Fault> {
        let number = self.int()?;
        Ok(match (number, self.version) {
            (1, _) => Type::Number(Scalar::I8),
            (2, _) => Type::Character,
            (3, _) => Type::Number(Scalar::I16),
            (4, _) => Type::Number(Scalar::I32),
            (5, _) => Type::Number(Scalar::F32),
            (6, _) => Type::Number(Scalar::F64),
            (7, 5) => Type::Number(Scalar::U8),
            (8, 5) => Type::Number(Scalar::U16),
            (9, 5) => Type::Number(Scalar::U32),
            (10, 5) => Type::Number(Scalar::I64),
            (11, 5) => Type::Number(Scalar::U64),
            _ => {
                return Err(self.bytes.fault(format!(
                    "the type {number} of values; allowed: 1 to 6, in CDF-5 to 11"
                )));
            }
        })
    }

    /// Attributes, of which texts are kept.
    fn attributes(&mut self) -> Result<Vec<(String, String)>, Fault> {
        let mut attributes = Vec::new();
        for _ in 0..self.list(12, "attributes")? {
            let name = self.name()?;
            let scalar = self.scalar()?;
            let count = self.size()?;
            let bytes = count.saturating_mul(scalar.bytes());
            let data = self.padded(bytes)?;
            if scalar == Type::Character {
                let text = String::from_utf8_lossy(data);
                attributes.push((name, text.trim_end_matches('\0').to_owned()));
            }
        }
        Ok(attributes)
    }
}

impl<'a> NetCdf<'a> {
    /// The header of a file.
    ///
    /// # Errors
    /// A file that is not classic netCDF or is damaged.
    pub(crate) fn new(content: &'a [u8]) -> Result<Self, Fault> {
        if content.starts_with(b"\x89HDF") {
            return Err(Fault::of_file(
                "the file is netCDF-4 (HDF5); allowed: classic netCDF (CDF-1, CDF-2, CDF-5). Convert it: ncks -5 IN OUT, or nccopy -k cdf5 IN OUT",
            ));
        }
        let version = match content {
            [b'C', b'D', b'F', version @ (1 | 2 | 5), ..] => *version,
            _ => {
                return Err(Fault::at_byte(
                    0,
                    "the file does not begin with CDF and the version 1, 2 or 5",
                ));
            }
        };
        let bytes = Bytes::new(content, 4, false);
        let mut header = Header { bytes, version };
        let records = header.size()?;
        let mut dimensions = Vec::new();
        for _ in 0..header.list(10, "dimensions")? {
            dimensions.push((header.name()?, header.size()?));
        }
        header.attributes()?;
        let mut variables = Vec::new();
        for _ in 0..header.list(11, "variables")? {
            variables.push(Self::variable_of(&mut header, &dimensions)?);
        }
        let of_records = variables.iter().filter(|v| v.has_records);
        let sizes: Vec<u64> = of_records
            .map(|v| v.len.saturating_mul(v.scalar.bytes()))
            .collect();
        let record_bytes = match sizes[..] {
            // One variable alone is not padded.
            [only] => only,
            _ => sizes.iter().fold(0, |sum: u64, &size| {
                sum.saturating_add(size.checked_next_multiple_of(4).unwrap_or(u64::MAX))
            }),
        };
        Ok(Self {
            content,
            records,
            record_bytes,
            dimensions,
            variables,
            room: Cell::new(READINGS * content.len() as u64),
        })
    }

    fn variable_of(
        header: &mut Header<'_>,
        dimensions: &[(String, u64)],
    ) -> Result<Variable, Fault> {
        let name = header.name()?;
        let count = header.size()?;
        let count = header.bytes.room(count, 4, "dimensions of a variable")?;
        let mut own = Vec::with_capacity(count);
        for _ in 0..count {
            let number = header.size()?;
            let known = usize::try_from(number).ok();
            match known.filter(|&number| number < dimensions.len()) {
                Some(number) => own.push(number),
                None => {
                    let reason = format!(
                        "the variable {name} has the dimension {number}; there are {}",
                        dimensions.len()
                    );
                    return Err(header.bytes.fault(reason));
                }
            }
        }
        let attributes = header.attributes()?;
        let scalar = header.scalar()?;
        header.size()?;
        let begin = match header.version {
            1 => header.int()?,
            _ => header.bytes.integer(Scalar::U64)? as u64,
        };
        // The record dimension has the length zero and comes first.
        let has_records = own.first().is_some_and(|&d| dimensions[d].1 == 0);
        let fixed = own.iter().skip(usize::from(has_records));
        let len = fixed.fold(1u64, |len, &d| len.saturating_mul(dimensions[d].1));
        Ok(Variable {
            name,
            dimensions: own,
            attributes,
            scalar,
            begin,
            has_records,
            len,
        })
    }

    /// The number of bytes of the file.
    pub(crate) fn bytes(&self) -> usize {
        self.content.len()
    }

    /// The number of records.
    pub(crate) fn records(&self) -> u64 {
        self.records
    }

    /// The length of a dimension.
    pub(crate) fn dimension(&self, name: &str) -> Option<u64> {
        let found = self.dimensions.iter().find(|(given, _)| given == name);
        found.map(|&(_, length)| length)
    }

    /// The variable of this name.
    pub(crate) fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    /// The length of the last dimension of a variable.
    pub(crate) fn last_length(&self, variable: &Variable) -> u64 {
        let last = variable.dimensions.last();
        last.map_or(1, |&dimension| self.dimensions[dimension].1)
    }

    /// The bytes of a variable, of its record where it has records.
    fn data(&self, variable: &Variable, record: u64) -> Result<&'a [u8], Fault> {
        let skipped = match variable.has_records {
            true => record.saturating_mul(self.record_bytes),
            false => 0,
        };
        let begin = variable.begin.saturating_add(skipped);
        let length = variable.len.saturating_mul(variable.scalar.bytes());
        let range = usize::try_from(begin)
            .ok()
            .zip(usize::try_from(length).ok());
        let data = range.and_then(|(begin, length)| {
            let end = begin.checked_add(length)?;
            self.content.get(begin..end)
        });
        match self.room.get().checked_sub(length) {
            Some(room) => self.room.set(room),
            None if data.is_some() => {
                return Err(Fault::of_file("the variables of the file overlap"));
            }
            None => {}
        }
        data.ok_or_else(|| {
            Fault::of_file(format!(
                "the variable {} needs {length} bytes from byte {begin} on, but the file has {}",
                variable.name,
                self.content.len()
            ))
        })
    }

    fn numbers<T>(
        &self,
        variable: &Variable,
        record: u64,
        read: impl Fn(&mut Bytes<'_>, Scalar) -> Result<T, Fault>,
    ) -> Result<Vec<T>, Fault> {
        let data = self.data(variable, record)?;
        let Type::Number(scalar) = variable.scalar else {
            let name = &variable.name;
            return Err(Fault::of_file(format!(
                "the variable {name} holds text, not numbers"
            )));
        };
        let mut bytes = Bytes::new(data, 0, false);
        (0..variable.len)
            .map(|_| read(&mut bytes, scalar))
            .collect()
    }

    /// The values of a variable, or of its record, as whole numbers.
    pub(crate) fn whole(&self, variable: &Variable, record: u64) -> Result<Vec<i64>, Fault> {
        self.numbers(variable, record, |bytes, scalar| bytes.integer(scalar))
    }

    /// The values of a variable, or of its record.
    pub(crate) fn real(&self, variable: &Variable, record: u64) -> Result<Vec<f64>, Fault> {
        self.numbers(variable, record, |bytes, scalar| bytes.real(scalar))
    }

    /// The texts of a variable, as many as its dimensions but the last one say.
    pub(crate) fn texts(&self, variable: &Variable) -> Result<Vec<String>, Fault> {
        let data = self.data(variable, 0)?;
        let length = usize::try_from(self.last_length(variable)).unwrap_or(usize::MAX);
        let text = |bytes: &[u8]| {
            let end = bytes.iter().position(|&byte| byte == 0);
            let text = String::from_utf8_lossy(&bytes[..end.unwrap_or(bytes.len())]);
            text.trim().to_owned()
        };
        Ok(data.chunks(length.max(1)).map(text).collect())
    }
}
