//! netCDF files, the container of Exodus II: dimensions and variables.
//!
//! Classic files (CDF-1, CDF-2, CDF-5) are read directly; netCDF-4 files, which are HDF5 files, with the
//! feature `netcdf4`.

mod classic;
#[cfg(feature = "netcdf4")]
mod hdf5;

use std::borrow::Cow;
use std::cell::Cell;

use crate::fault::Fault;
use crate::scan::{Bytes, Scalar};

/// A file with parsed dimensions and variables.
pub(crate) struct NetCdf<'a> {
    values: Values<'a>,
    /// Size of the file in bytes.
    bytes: usize,
    records: u64,
    dimensions: Vec<(String, u64)>,
    variables: Vec<Variable>,
    /// Remaining bytes of values that may be read: neither overlapping nor compressed variables can expand a
    /// file without limit.
    room: Cell<u64>,
}

/// Source of the values.
enum Values<'a> {
    Classic {
        content: &'a [u8],
        /// Size of a record in bytes.
        record_bytes: u64,
    },
    #[cfg(feature = "netcdf4")]
    Hdf5(hdf5_pure::File),
}

/// Maximum number of times that the bytes of a file may be read.
const READINGS: u64 = 4;

/// A variable.
#[derive(Debug)]
pub(crate) struct Variable {
    name: String,
    /// Length of the last dimension.
    last_length: u64,
    attributes: Vec<(String, String)>,
    scalar: Type,
    /// Whether the numbers are little-endian.
    little: bool,
    /// Offset of the values in a classic file.
    begin: u64,
    has_records: bool,
    /// Number of values of the variable, or of one record.
    len: u64,
}

impl Variable {
    /// Returns the text of an attribute.
    pub(crate) fn attribute(&self, name: &str) -> Option<&str> {
        let found = self.attributes.iter().find(|(given, _)| given == name);
        found.map(|(_, text)| text.as_str())
    }

    /// Returns the length of the last dimension; 1 for a variable without dimensions.
    pub(crate) fn last_length(&self) -> u64 {
        self.last_length
    }

    /// Returns the size of the variable, or of one record, in bytes.
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
    /// Parses the dimensions and variables of a file. Values of netCDF-4 files, which may be compressed, may
    /// take up to `memory` bytes.
    ///
    /// # Errors
    /// Returns an error if the file is not netCDF or is damaged, or is netCDF-4 without the feature `netcdf4`.
    pub(crate) fn new(content: &'a [u8], memory: u64) -> Result<Self, Fault> {
        if content.starts_with(b"\x89HDF") {
            #[cfg(feature = "netcdf4")]
            return hdf5::open(content, memory);
            #[cfg(not(feature = "netcdf4"))]
            let _ = memory;
            #[cfg(not(feature = "netcdf4"))]
            return Err(Fault::of_file(
                "the file is netCDF-4 (HDF5), which this build does not support; allowed: classic netCDF (CDF-1, CDF-2, CDF-5). Convert it with ncks -5 IN OUT or nccopy -k cdf5 IN OUT, or build Pericles with the feature netcdf4",
            ));
        }
        classic::open(content)
    }

    /// Returns the size of the file in bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.bytes
    }

    /// Returns the number of records.
    pub(crate) fn records(&self) -> u64 {
        self.records
    }

    /// Returns the length of a dimension.
    pub(crate) fn dimension(&self, name: &str) -> Option<u64> {
        let found = self.dimensions.iter().find(|(given, _)| given == name);
        found.map(|&(_, length)| length)
    }

    /// Returns the variable with this name.
    pub(crate) fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    /// Returns the bytes of a variable, or of one record.
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
                "the variable {name} contains text, not numbers"
            )));
        };
        let mut bytes = Bytes::new(&data, 0, variable.little);
        // All bytes are present, so the length is bounded by them.
        let mut numbers = Vec::with_capacity(variable.len as usize);
        for _ in 0..variable.len {
            numbers.push(read(&mut bytes, scalar)?);
        }
        Ok(numbers)
    }

    /// Returns the values of a variable, or of one record, as integers.
    pub(crate) fn whole(&self, variable: &Variable, record: u64) -> Result<Vec<i64>, Fault> {
        self.numbers(variable, record, |bytes, scalar| bytes.integer(scalar))
    }

    /// Returns the values of a variable, or of one record.
    pub(crate) fn real(&self, variable: &Variable, record: u64) -> Result<Vec<f64>, Fault> {
        self.numbers(variable, record, |bytes, scalar| bytes.real(scalar))
    }

    /// Returns the texts of a variable: one per entry of all dimensions except the last.
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
