//! Blocks of a section: byte shuffling, compression and checksum of up to 512 KiB of entries.

use std::io;

use lz4_flex::block::{
    CompressTable, compress_into_with_table, decompress_into, get_maximum_output_size,
};

use super::kind::Kind;

/// Bytes of the entries of a block; bounds the memory needed for encoding, and is a multiple of the size of every type.
pub(super) const BYTES: usize = 1 << 19;

/// Returns the number of entries of a block, except for the last one of a section.
pub(super) fn entries(kind: Kind) -> usize {
    BYTES / kind.bytes() as usize
}

/// What the table of a file contains for a block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Block {
    /// Bytes in the file.
    pub(super) stored: u32,
    /// Their CRC-32.
    pub(super) crc32: u32,
}

impl Block {
    /// Bytes in the table.
    pub(super) const SIZE: usize = 8;

    pub(super) fn to_bytes(self) -> [u8; Self::SIZE] {
        let [a, b] = [self.stored, self.crc32].map(u32::to_le_bytes);
        std::array::from_fn(|k| if k < 4 { a[k] } else { b[k - 4] })
    }

    pub(super) fn of_bytes(bytes: &[u8]) -> Self {
        let number = |at: usize| u32::from_le_bytes(std::array::from_fn(|k| bytes[at + k]));
        Self {
            stored: number(0),
            crc32: number(4),
        }
    }
}

/// A type of entries.
pub(super) trait Element: Copy {
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

/// Appends the entries whose shuffled bytes these are.
pub(super) fn append_shuffled<T: Element>(values: &mut Vec<T>, shuffled: &[u8]) {
    let count = shuffled.len() / T::WIDTH;
    values.extend((0..count).map(|i| T::from_bytes(|k| shuffled[k * count + i])));
}

/// Work memory for encoding and decoding.
pub(super) struct Coder {
    shuffled: Vec<u8>,
    packed: Vec<u8>,
    table: CompressTable,
}

impl Default for Coder {
    fn default() -> Self {
        Self {
            shuffled: Vec::new(),
            packed: Vec::new(),
            table: CompressTable::large(),
        }
    }
}

impl Coder {
    /// Returns a block with these entries and its bytes in the file: compressed, unless they would not become fewer.
    pub(super) fn encode<T: Element>(&mut self, values: &[T]) -> (Block, &[u8]) {
        self.shuffled.clear();
        for k in 0..T::WIDTH {
            self.shuffled
                .extend(values.iter().map(|value| value.byte(k)));
        }
        self.packed
            .resize(get_maximum_output_size(self.shuffled.len()), 0);
        let packed = compress_into_with_table(&self.shuffled, &mut self.packed, &mut self.table);
        let bytes = match packed {
            Ok(length) if length < self.shuffled.len() => &self.packed[..length],
            _ => &self.shuffled[..],
        };
        let block = Block {
            stored: bytes.len() as u32,
            crc32: crc32fast::hash(bytes),
        };
        (block, bytes)
    }

    /// Appends the `count` entries of a block to `values`.
    ///
    /// # Errors
    /// The bytes differ from what was encoded.
    pub(super) fn decode<T: Element>(
        &mut self,
        block: Block,
        bytes: &[u8],
        count: usize,
        values: &mut Vec<T>,
    ) -> io::Result<()> {
        let invalid = |reason: &str| io::Error::new(io::ErrorKind::InvalidData, reason);
        if crc32fast::hash(bytes) != block.crc32 {
            return Err(invalid("the CRC-32 of a block does not match"));
        }
        let plain = count * T::WIDTH;
        if bytes.len() == plain {
            append_shuffled(values, bytes);
            return Ok(());
        }
        self.shuffled.resize(plain, 0);
        match decompress_into(bytes, &mut self.shuffled) {
            Ok(length) if length == plain => append_shuffled(values, &self.shuffled),
            Ok(_) => return Err(invalid("a block has too few entries")),
            Err(error) => return Err(io::Error::new(io::ErrorKind::InvalidData, error)),
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_encoded_form_is_lz4_of_shuffled_little_endian_bytes() {
        let mut coder = Coder::default();
        let values = vec![0x0403_0201_u32; 100];
        let (block, bytes) = coder.encode(&values);
        assert!(bytes.len() < 60 && block.stored as usize == bytes.len());
        let plain = lz4_flex::block::decompress(bytes, 400).unwrap();
        let expected = [1, 2, 3, 4].map(|byte| [byte; 100]).concat();
        assert_eq!(plain, expected);
        // Too short to be compressed.
        let (block, bytes) = coder.encode(&[0x0403_0201_u32, 0x1413_1211]);
        assert_eq!(bytes, [1, 0x11, 2, 0x12, 3, 0x13, 4, 0x14]);
        assert_eq!(block.crc32, crc32fast::hash(bytes));
        assert_eq!(Block::of_bytes(&block.to_bytes()), block);
    }

    #[test]
    fn entries_are_preserved_and_wrong_numbers_are_rejected() {
        let mut coder = Coder::default();
        for len in [1, 7, 1000, entries(Kind::F64)] {
            let values: Vec<f64> = (0..len).map(|i| (i as f64).sqrt()).collect();
            let (block, bytes) = coder.encode(&values);
            let bytes = bytes.to_vec();
            let mut back = Vec::new();
            coder.decode(block, &bytes, len, &mut back).unwrap();
            assert!(back == values, "{len}");
            for count in [len - 1, len + 1] {
                let found = coder.decode::<f64>(block, &bytes, count, &mut back);
                assert!(found.is_err(), "{count} of {len}");
            }
        }
    }
}
