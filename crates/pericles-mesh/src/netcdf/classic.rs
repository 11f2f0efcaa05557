//! Classic netCDF files: CDF-1, CDF-2 (64-bit offsets) and CDF-5 (64-bit data).
//!
//! All numbers are big-endian. A file consists of a magic number, the number of records, dimensions,
//! attributes, variables with the offsets of their values, then the values: of fixed variables one
//! after the other, then records with the values of all variables that have the record dimension. Lengths in
//! the header of a variable may be wrong by design (beyond 4 GiB) and are computed instead.

use super::{READINGS, Type, Values, Variable};
use crate::fault::Fault;
use crate::netcdf::NetCdf;
use crate::scan::{Bytes, Scalar};

struct Header<'a> {
    bytes: Bytes<'a>,
    version: u8,
}

impl Header<'_> {
    fn int(&mut self) -> Result<u64, Fault> {
        Ok(self.bytes.integer(Scalar::U32)? as u64)
    }

    /// Reads a size: eight bytes in CDF-5, otherwise four.
    fn size(&mut self) -> Result<u64, Fault> {
        match self.version {
            5 => self.bytes.integer(Scalar::U64).map(|size| size as u64),
            _ => self.int(),
        }
    }

    /// Reads a tag and the number of entries that follow.
    fn list(&mut self, tag: u64, what: &str) -> Result<usize, Fault> {
        let found = self.int()?;
        let count = self.size()?;
        if found != tag && (found != 0 || count != 0) {
            let reason = format!("found tag {found}, expected {what} (tag {tag})");
            return Err(self.bytes.fault(reason));
        }
        // At least the length of a name and another number.
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
                    "unknown data type {number}; allowed: 1 to 6, in CDF-5 1 to 11"
                )));
            }
        })
    }

    /// Reads attributes; only text is kept.
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

/// Reads the header of a file.
pub(super) fn open(content: &[u8]) -> Result<NetCdf<'_>, Fault> {
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
        variables.push(variable_of(&mut header, &dimensions)?);
    }
    let of_records = variables.iter().filter(|v| v.has_records);
    let sizes: Vec<u64> = of_records.map(Variable::bytes).collect();
    let record_bytes = match sizes[..] {
        // A single record variable is not padded.
        [only] => only,
        _ => sizes.iter().fold(0, |sum: u64, &size| {
            sum.saturating_add(size.checked_next_multiple_of(4).unwrap_or(u64::MAX))
        }),
    };
    Ok(NetCdf {
        values: Values::Classic {
            content,
            record_bytes,
        },
        bytes: content.len(),
        records,
        dimensions,
        variables,
        room: std::cell::Cell::new(READINGS.saturating_mul(content.len() as u64)),
    })
}

fn variable_of(header: &mut Header<'_>, dimensions: &[(String, u64)]) -> Result<Variable, Fault> {
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
                    "the variable {name} refers to dimension {number}; there are only {}",
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
    // The record dimension has length zero and comes first.
    let has_records = own.first().is_some_and(|&d| dimensions[d].1 == 0);
    let fixed = own.iter().skip(usize::from(has_records));
    let len = fixed.fold(1u64, |len, &d| len.saturating_mul(dimensions[d].1));
    Ok(Variable {
        name,
        last_length: own.last().map_or(1, |&d| dimensions[d].1),
        attributes,
        scalar,
        little: false,
        begin,
        has_records,
        len,
    })
}

/// Returns the bytes of a variable, or of one record.
pub(super) fn data<'a>(
    (content, record_bytes): (&'a [u8], u64),
    variable: &Variable,
    record: u64,
) -> Result<&'a [u8], Fault> {
    let skipped = match variable.has_records {
        true => record.saturating_mul(record_bytes),
        false => 0,
    };
    let begin = variable.begin.saturating_add(skipped);
    let length = variable.bytes();
    let range = usize::try_from(begin)
        .ok()
        .zip(usize::try_from(length).ok());
    let data = range.and_then(|(begin, length)| {
        let end = begin.checked_add(length)?;
        content.get(begin..end)
    });
    data.ok_or_else(|| {
        Fault::of_file(format!(
            "the variable {} needs {length} bytes from byte {begin}, but the file has {}",
            variable.name,
            content.len()
        ))
    })
}
