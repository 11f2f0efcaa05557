//! netCDF files, as Exodus II is written in: dimensions, and variables with their values.
//!
//! Classic files (CDF-1, CDF-2, CDF-5) are read by this crate; netCDF-4 files, which are HDF5 files, with the feature `netcdf4`.

mod classic;
#[cfg(feature = "netcdf4")]
mod hdf5;

use std::borrow::Cow;
use std::cell::Cell;

use crate::fault::Fault;
use crate::scan::{Bytes, Scalar};

/// A file, whose dimensions and variables are known.
pub(crate) struct NetCdf<'a> {
    values: Values<'a>,
    /// The number of bytes of the file.
    bytes: usize,
    records: u64,
    dimensions: Vec<(String, u64)>,
    variables: Vec<Variable>,
    /// Bytes of values that may still be read: neither variables that overlap nor compressed ones can multiply a file without limit.
    room: Cell<u64>,
}

/// Where values are read from.
enum Values<'a> {
    Classic {
        content: &'a [u8],
        /// Bytes of a record.
        record_bytes: u64,
    },
    #[cfg(feature = "netcdf4")]
    Hdf5(hdf5_pure::File),
}

/// Times that the bytes of a file may be read.
const READINGS: u64 = 4;

/// A variable.
#[derive(Debug)]
pub(crate) struct Variable {
    name: String,
    /// The length of the last dimension.
    last_length: u64,
    attributes: Vec<(String, String)>,
    scalar: Type,
    /// Whether the numbers are little-endian.
    little: bool,
    /// The first byte of the values in a classic file.
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

    /// The length of the last dimension; 1 of a variable without dimensions.
    pub(crate) fn last_length(&self) -> u64 {
        self.last_length
    }

    /// The bytes of the whole variable, or of one record.
    fn bytes(&self) -> u64 {
        self.len.saturating_mul(self.scalar.bytes())
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

impl<'a> NetCdf<'a> {
    /// The dimensions and variables of a file. Values of netCDF-4 files, which may be compressed, may take `memory` bytes.
    ///
    /// # Errors
    /// A file that is not netCDF or is damaged; netCDF-4 without the feature `netcdf4`.
    pub(crate) fn new(content: &'a [u8], memory: u64) -> Result<Self, Fault> {
        if content.starts_with(b"\x89HDF") {
            #[cfg(feature = "netcdf4")]
            return hdf5::open(content, memory);
            #[cfg(not(feature = "netcdf4"))]
            let _ = memory;
            #[cfg(not(feature = "netcdf4"))]
            return Err(Fault::of_file(
                "the file is netCDF-4 (HDF5), which this build does not read; allowed: classic netCDF (CDF-1, CDF-2, CDF-5). Convert it: ncks -5 IN OUT, or nccopy -k cdf5 IN OUT; or build Pericles with the feature netcdf4",
            ));
        }
        classic::open(content)
    }

    /// The number of bytes of the file.
    pub(crate) fn bytes(&self) -> usize {
        self.bytes
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

    /// The bytes of a variable, of its record where it has records.
    fn data(&self, variable: &Variable, record: u64) -> Result<Cow<'_, [u8]>, Fault> {
        let length = variable.bytes();
        let data: Cow<'_, [u8]> = match &self.values {
            Values::Classic {
                content,
                record_bytes,
            } => classic::data((content, *record_bytes), variable, record)?.into(),
            #[cfg(feature = "netcdf4")]
            Values::Hdf5(file) => {
                if length > self.room.get() {
                    return Err(Fault::too_large(length));
                }
                hdf5::data(file, variable, record, self.room.get())?.into()
            }
        };
        match self.room.get().checked_sub(length) {
            Some(room) => self.room.set(room),
            None => return Err(Fault::of_file("the variables of the file overlap")),
        }
        Ok(data)
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
        let mut bytes = Bytes::new(&data, 0, variable.little);
        // All bytes are there: the length is no more than theirs.
        let mut numbers = Vec::with_capacity(variable.len as usize);
        for _ in 0..variable.len {
            numbers.push(read(&mut bytes, scalar)?);
        }
        Ok(numbers)
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
        let length = usize::try_from(variable.last_length).unwrap_or(usize::MAX);
        let text = |bytes: &[u8]| {
            let end = bytes.iter().position(|&byte| byte == 0);
            let text = String::from_utf8_lossy(&bytes[..end.unwrap_or(bytes.len())]);
            text.trim().to_owned()
        };
        Ok(data.chunks(length.max(1)).map(text).collect())
    }
}
