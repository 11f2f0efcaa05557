//! A named array: its element types, byte shuffling and compression.

use std::io::{self, Read, Write};

use lz4_flex::frame::{FrameDecoder, FrameEncoder};
use pericles::Values;
use serde::{Deserialize, Serialize};

/// Number of elements shuffled together; bounds the memory needed for encoding.
const CHUNK: usize = 1 << 16;

/// The values of one section.
#[derive(Debug, Clone)]
pub enum Section {
    /// Real numbers, preserved bit for bit.
    F64(Vec<f64>),
    /// 64-bit integers: counts, offsets.
    U64(Vec<u64>),
    /// 32-bit integers: point and bond numbers.
    U32(Vec<u32>),
    /// Bytes: flags, bit masks.
    U8(Vec<u8>),
}

/// Compares type and bits: NaN equals itself and −0 differs from 0.
impl PartialEq for Section {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::F64(a), Self::F64(b)) => {
                a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
            }
            (Self::U64(a), Self::U64(b)) => a == b,
            (Self::U32(a), Self::U32(b)) => a == b,
            (Self::U8(a), Self::U8(b)) => a == b,
            _ => false,
        }
    }
}

impl From<Values> for Section {
    fn from(values: Values) -> Self {
        match values {
            Values::F64(values) => Self::F64(values),
            Values::U64(values) => Self::U64(values),
            Values::U8(values) => Self::U8(values),
        }
    }
}

/// Archives have no 32-bit integers; the error names the unsupported type.
impl TryFrom<Section> for Values {
    type Error = &'static str;

    fn try_from(section: Section) -> Result<Self, Self::Error> {
        match section {
            Section::F64(values) => Ok(Self::F64(values)),
            Section::U64(values) => Ok(Self::U64(values)),
            Section::U8(values) => Ok(Self::U8(values)),
            Section::U32(_) => Err("u32"),
        }
    }
}

/// Element type of a section, as named in the header.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    F64,
    U64,
    U32,
    U8,
}

impl Kind {
    /// Returns the size of one element in bytes.
    pub(super) fn bytes(self) -> u64 {
        match self {
            Self::F64 | Self::U64 => 8,
            Self::U32 => 4,
            Self::U8 => 1,
        }
    }
}

/// Encoding of the bytes, as named in the header.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Codec {
    #[serde(rename = "shuffle+lz4")]
    ShuffleLz4,
}

impl Section {
    /// Returns the number of elements.
    pub fn len(&self) -> usize {
        match self {
            Self::F64(values) => values.len(),
            Self::U64(values) => values.len(),
            Self::U32(values) => values.len(),
            Self::U8(values) => values.len(),
        }
    }

    /// Returns whether the section is empty.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(super) fn kind(&self) -> Kind {
        match self {
            Self::F64(_) => Kind::F64,
            Self::U64(_) => Kind::U64,
            Self::U32(_) => Kind::U32,
            Self::U8(_) => Kind::U8,
        }
    }

    /// Writes the encoded form.
    pub(super) fn encode(&self, out: impl Write) -> io::Result<()> {
        match self {
            Self::F64(values) => encode(values, out),
            Self::U64(values) => encode(values, out),
            Self::U32(values) => encode(values, out),
            Self::U8(values) => encode(values, out),
        }
    }

    /// Decodes exactly `len` elements.
    pub(super) fn decode(kind: Kind, len: u64, stored: impl Read) -> io::Result<Self> {
        Ok(match kind {
            Kind::F64 => Self::F64(decode(len, stored)?),
            Kind::U64 => Self::U64(decode(len, stored)?),
            Kind::U32 => Self::U32(decode(len, stored)?),
            Kind::U8 => Self::U8(decode(len, stored)?),
        })
    }
}

trait Element: Copy {
    const WIDTH: usize;
    fn byte(self, k: usize) -> u8;
    fn from_bytes(byte: impl Fn(usize) -> u8) -> Self;
}

macro_rules! element {
    ($($type:ty),*) => {$(
        impl Element for $type {
            const WIDTH: usize = size_of::<$type>();
            fn byte(self, k: usize) -> u8 {
                self.to_le_bytes()[k]
            }
            fn from_bytes(byte: impl Fn(usize) -> u8) -> Self {
                Self::from_le_bytes(std::array::from_fn(byte))
            }
        }
    )*};
}
element!(f64, u64, u32, u8);

fn encode<T: Element>(values: &[T], out: impl Write) -> io::Result<()> {
    let mut lz4 = FrameEncoder::new(out);
    let mut shuffled = Vec::with_capacity(CHUNK.min(values.len()) * T::WIDTH);
    for chunk in values.chunks(CHUNK) {
        shuffled.clear();
        for k in 0..T::WIDTH {
            shuffled.extend(chunk.iter().map(|value| value.byte(k)));
        }
        lz4.write_all(&shuffled)?;
    }
    lz4.finish().map_err(io::Error::from)?;
    Ok(())
}

fn decode<T: Element>(len: u64, stored: impl Read) -> io::Result<Vec<T>> {
    let mut lz4 = FrameDecoder::new(stored);
    let mut values = Vec::new();
    let mut shuffled = Vec::new();
    let mut left = len;
    while left > 0 {
        // At most u32::MAX elements, so the number fits usize. The vector grows with the data that are
        // present, not with `len`.
        let count = left.min(CHUNK as u64) as usize;
        shuffled.resize(count * T::WIDTH, 0);
        lz4.read_exact(&mut shuffled)?;
        values.extend((0..count).map(|i| T::from_bytes(|k| shuffled[k * count + i])));
        left -= count as u64;
    }
    if lz4.read(&mut [0])? > 0 {
        return Err(io::Error::new(
            io::ErrorKind::InvalidData,
            "more values than the header states",
        ));
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_encoded_form_is_lz4_of_shuffled_little_endian_bytes() {
        let mut stored = Vec::new();
        let section = Section::U32(vec![0x0403_0201, 0x1413_1211, 0x2423_2221]);
        section.encode(&mut stored).unwrap();
        let mut plain = Vec::new();
        let mut frame = FrameDecoder::new(&stored[..]);
        frame.read_to_end(&mut plain).unwrap();
        assert_eq!(
            plain,
            [1, 0x11, 0x21, 2, 0x12, 0x22, 3, 0x13, 0x23, 4, 0x14, 0x24]
        );
    }

    #[test]
    fn data_across_chunk_boundaries_are_preserved() {
        for len in [CHUNK - 1, CHUNK, CHUNK + 1, 2 * CHUNK + 7] {
            let section = Section::F64((0..len).map(|i| (i as f64).sqrt()).collect());
            let mut stored = Vec::new();
            section.encode(&mut stored).unwrap();
            assert!(stored.len() < 8 * len, "shuffled square roots compress");
            let back = Section::decode(Kind::F64, len as u64, &stored[..]).unwrap();
            assert!(back == section, "{len}");
        }
    }

    #[test]
    fn a_wrong_length_is_rejected_without_allocating_it() {
        let mut stored = Vec::new();
        Section::U64(vec![5; 1000]).encode(&mut stored).unwrap();
        for len in [999, 1001, u64::MAX] {
            assert!(Section::decode(Kind::U64, len, &stored[..]).is_err());
        }
    }
}
