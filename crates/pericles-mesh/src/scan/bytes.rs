//! Reading of numbers from binary files, with their offsets.

use crate::fault::Fault;

/// Reader of a binary file.
pub(crate) struct Bytes<'a> {
    data: &'a [u8],
    at: usize,
    little: bool,
}

/// Number types.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Scalar {
    pub(crate) fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }
}

impl<'a> Bytes<'a> {
    pub(crate) fn new(data: &'a [u8], at: usize, little: bool) -> Self {
        Self { data, at, little }
    }

    pub(crate) fn position(&self) -> usize {
        self.at
    }

    pub(crate) fn fault(&self, reason: impl Into<String>) -> Fault {
        Fault::at_byte(self.at, reason)
    }

    /// Returns the next bytes.
    pub(crate) fn take(&mut self, count: usize) -> Result<&'a [u8], Fault> {
        let left = self.data.len().saturating_sub(self.at);
        if count > left {
            return Err(self.fault(format!(
                "unexpected end of file: {count} more byte(s) expected, {left} left"
            )));
        }
        let taken = &self.data[self.at..self.at + count];
        self.at += count;
        Ok(taken)
    }

    /// Checks that the remaining bytes can contain `count` items of at least `bytes_each` bytes.
    pub(crate) fn room(&self, count: u64, bytes_each: usize, what: &str) -> Result<usize, Fault> {
        let left = self.data.len().saturating_sub(self.at);
        let room = (left / bytes_each.max(1)) as u64;
        if count > room {
            return Err(self.fault(format!(
                "{count} {what} are declared, but the remaining {left} bytes hold at most {room}"
            )));
        }
        Ok(count as usize)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        if !self.little {
            array.reverse();
        }
        Ok(array)
    }

    pub(crate) fn real(&mut self, scalar: Scalar) -> Result<f64, Fault> {
        Ok(match scalar {
            Scalar::F32 => f64::from(f32::from_le_bytes(self.array()?)),
            Scalar::F64 => f64::from_le_bytes(self.array()?),
            _ => self.integer(scalar)? as f64,
        })
    }

    pub(crate) fn integer(&mut self, scalar: Scalar) -> Result<i64, Fault> {
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(self.array()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.array()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.array()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.array()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.array()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.array()?).into(),
            Scalar::I64 => i64::from_le_bytes(self.array()?),
            Scalar::U64 => {
                let number = u64::from_le_bytes(self.array()?);
                i64::try_from(number)
                    .map_err(|_| self.fault(format!("the number {number} is too large")))?
            }
            Scalar::F32 | Scalar::F64 => {
                return Err(self.fault("found real numbers, expected integers"));
            }
        })
    }
}

/// Returns a vertex number if it is valid.
pub(crate) fn vertex_number(number: i64) -> Option<u32> {
    u32::try_from(number)
        .ok()
        .filter(|&number| number < u32::MAX)
}

pub(crate) fn no_vertex(number: i64) -> String {
    format!("{number} is not a valid vertex number; allowed: 0 to 4294967294")
}
