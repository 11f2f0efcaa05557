//! A named array: its element types and its blocks.

use std::io;

use pericles::Values;
use serde::{Deserialize, Serialize};

use super::block::{Block, Coder, Element, entries};
use super::kind::Kind;

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

    /// Returns a section without elements.
    pub(super) fn empty(kind: Kind) -> Self {
        match kind {
            Kind::F64 => Self::F64(Vec::new()),
            Kind::U64 => Self::U64(Vec::new()),
            Kind::U32 => Self::U32(Vec::new()),
            Kind::U8 => Self::U8(Vec::new()),
        }
    }

    /// Passes the blocks and their bytes to `write`, in order.
    pub(super) fn encode(
        &self,
        coder: &mut Coder,
        write: &mut dyn FnMut(Block, &[u8]) -> io::Result<()>,
    ) -> io::Result<()> {
        fn each<T: Element>(
            values: &[T],
            block: usize,
            coder: &mut Coder,
            write: &mut dyn FnMut(Block, &[u8]) -> io::Result<()>,
        ) -> io::Result<()> {
            values.chunks(block).try_for_each(|values| {
                let (block, bytes) = coder.encode(values);
                write(block, bytes)
            })
        }
        let block = entries(self.kind());
        match self {
            Self::F64(values) => each(values, block, coder, write),
            Self::U64(values) => each(values, block, coder, write),
            Self::U32(values) => each(values, block, coder, write),
            Self::U8(values) => each(values, block, coder, write),
        }
    }

    /// Appends the `count` elements of a block.
    pub(super) fn decode(
        &mut self,
        coder: &mut Coder,
        block: Block,
        bytes: &[u8],
        count: usize,
    ) -> io::Result<()> {
        match self {
            Self::F64(values) => coder.decode(block, bytes, count, values),
            Self::U64(values) => coder.decode(block, bytes, count, values),
            Self::U32(values) => coder.decode(block, bytes, count, values),
            Self::U8(values) => coder.decode(block, bytes, count, values),
        }
    }
}
