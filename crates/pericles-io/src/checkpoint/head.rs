//! The head of a checkpoint file: everything but the entries of the arrays.

use std::borrow::Cow;
use std::io::{Read, Seek};
use std::ops::Range;
use std::path::Path;

use crc32fast::Hasher;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::block::{self, Block};
use super::kind::Kind;
use super::section::Codec;
use crate::IoError;

const MAGIC: &[u8; 8] = b"PERICLES";
/// Version of the format.
pub(super) const VERSION: u32 = 2;
/// Bytes of magic, version, and length and CRC-32 of the header.
const PREFIX: u64 = 24;
/// Bytes of the CRC-32 of the table of blocks.
const CHECK: u64 = 4;
/// A number in a JSON list takes 32 bytes of memory and at least two characters.
const PER_CHARACTER: u64 = 16;

#[derive(Serialize, Deserialize)]
struct Header<'a> {
    metadata: Cow<'a, Value>,
    sections: Vec<Entry>,
}

/// A section in the header.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Entry {
    pub(super) name: String,
    #[serde(rename = "type")]
    pub(super) kind: Kind,
    pub(super) len: u64,
    pub(super) codec: Codec,
}

impl Entry {
    /// Number of its blocks.
    pub(super) fn blocks(&self) -> u64 {
        self.len.div_ceil(block::entries(self.kind) as u64)
    }
}

/// Header of a file that is being written. Its size is known before the blocks are.
pub(super) struct Draft {
    json: Vec<u8>,
    blocks: u64,
}

impl Draft {
    pub(super) fn new(metadata: &Value, sections: Vec<Entry>) -> Result<Self, serde_json::Error> {
        let blocks = sections.iter().map(Entry::blocks).sum();
        let header = Header {
            metadata: Cow::Borrowed(metadata),
            sections,
        };
        let json = serde_json::to_vec(&header)?;
        Ok(Self { json, blocks })
    }

    /// Place of the first block in the file.
    pub(super) fn end(&self) -> u64 {
        PREFIX + self.json.len() as u64 + self.blocks * Block::SIZE as u64 + CHECK
    }

    /// Number of blocks.
    pub(super) fn blocks(&self) -> u64 {
        self.blocks
    }

    /// Returns the bytes of the head.
    pub(super) fn bytes(&self, table: &[Block]) -> Vec<u8> {
        let table: Vec<u8> = table.iter().flat_map(|block| block.to_bytes()).collect();
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((self.json.len() as u64).to_le_bytes());
        bytes.extend(header_crc(VERSION, &self.json).to_le_bytes());
        bytes.extend(&self.json);
        bytes.extend(&table);
        bytes.extend(crc32fast::hash(&table).to_le_bytes());
        bytes
    }
}

/// Header of a file.
pub(super) struct Opening {
    pub(super) json: Vec<u8>,
    crc32: u32,
    /// Bytes of the file after the header.
    pub(super) rest: u64,
}

impl Opening {
    /// Reads the start of a file of `length` bytes, whose content may take at most `memory` bytes.
    pub(super) fn read(
        path: &Path,
        mut file: impl Read,
        length: u64,
        memory: u64,
    ) -> Result<Self, IoError> {
        let reading = |source| IoError::reading(path, source);
        let damaged = |reason: String| IoError::damaged(path, reason);
        let mut prefix = [0; PREFIX as usize];
        if length < PREFIX {
            return Err(damaged(format!(
                "{length} bytes are too few for a checkpoint"
            )));
        }
        file.read_exact(&mut prefix).map_err(reading)?;
        if !prefix.starts_with(MAGIC) {
            return Err(damaged("it is not a Pericles checkpoint".into()));
        }
        let version = u32_at(&prefix, 8);
        if version != VERSION {
            return Err(IoError::UnsupportedVersion {
                path: path.to_path_buf(),
                found: version,
                supported: VERSION,
            });
        }
        let room = u64::from(u32_at(&prefix, 12)) | u64::from(u32_at(&prefix, 16)) << 32;
        if room > length - PREFIX {
            return Err(damaged(format!(
                "a header of {room} bytes does not fit into a file of {length}"
            )));
        }
        check_memory(path, room.saturating_mul(PER_CHARACTER), memory)?;
        let mut json = Vec::new();
        file.take(room).read_to_end(&mut json).map_err(reading)?;
        let crc32 = u32_at(&prefix, 20);
        if json.len() as u64 != room || header_crc(version, &json) != crc32 {
            return Err(damaged("the CRC-32 of the header does not match".into()));
        }
        Ok(Self {
            json,
            crc32,
            rest: length - PREFIX - room,
        })
    }
}

/// A section of a file.
pub(super) struct Placed {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) len: u64,
    /// Its blocks in the table.
    pub(super) blocks: Range<usize>,
}

/// Head of a file that is read.
pub(super) struct Head {
    pub(super) metadata: Value,
    pub(super) sections: Vec<Placed>,
    /// The blocks, and their places in the file.
    pub(super) blocks: Vec<(Block, u64)>,
    /// Checksums of header and table.
    pub(super) checks: [u32; 2],
}

impl Head {
    /// Reads what follows the opening of a file.
    pub(super) fn read(
        path: &Path,
        opening: Opening,
        mut file: impl Read + Seek,
        memory: u64,
    ) -> Result<Self, IoError> {
        let reading = |source| IoError::reading(path, source);
        let damaged = |reason: String| IoError::damaged(path, reason);
        let header: Header = serde_json::from_slice(&opening.json)
            .map_err(|error| damaged(format!("the header is not valid: {error}")))?;
        let rest = opening.rest;
        let blocks = header.sections.iter().map(Entry::blocks);
        let blocks = blocks.fold(0, u64::saturating_add);
        let table = blocks.saturating_mul(Block::SIZE as u64);
        let stored = rest
            .checked_sub(CHECK)
            .and_then(|rest| rest.checked_sub(table));
        let unfilled = || {
            damaged(format!(
                "its sections do not fill the {rest} bytes after the header"
            ))
        };
        let stored = stored.ok_or_else(unfilled)?;
        let bytes = |entry: &Entry| entry.len.saturating_mul(entry.kind.bytes());
        let needed = header.sections.iter().map(bytes);
        check_memory(path, needed.fold(0, u64::saturating_add), memory)?;
        let mut bytes = Vec::new();
        let both = table + CHECK;
        (&mut file)
            .take(both)
            .read_to_end(&mut bytes)
            .map_err(reading)?;
        if bytes.len() as u64 != both {
            return Err(unfilled());
        }
        let (table, check) = bytes.split_at(table as usize);
        let check = u32_at(check, 0);
        if crc32fast::hash(table) != check {
            return Err(damaged(
                "the CRC-32 of the table of blocks does not match".into(),
            ));
        }
        let mut place = file.stream_position().map_err(reading)?;
        let end = place + stored;
        let block = |bytes: &[u8]| {
            let block = Block::of_bytes(bytes);
            let at = place;
            place += u64::from(block.stored);
            (block, at)
        };
        let blocks: Vec<(Block, u64)> = table.chunks_exact(Block::SIZE).map(block).collect();
        if place != end {
            return Err(unfilled());
        }
        let mut next = 0;
        let place = |entry: Entry| {
            let first = next;
            next += entry.blocks() as usize;
            Placed {
                blocks: first..next,
                name: entry.name,
                kind: entry.kind,
                len: entry.len,
            }
        };
        let sections: Vec<Placed> = header.sections.into_iter().map(place).collect();
        if blocks
            .iter()
            .any(|(block, _)| block.stored as usize > block::BYTES)
        {
            return Err(damaged("a block is too long".into()));
        }
        Ok(Self {
            metadata: header.metadata.into_owned(),
            sections,
            blocks,
            checks: [opening.crc32, check],
        })
    }
}

/// Checks that content of a file fits into the memory limit.
pub(super) fn check_memory(path: &Path, needed: u64, memory: u64) -> Result<(), IoError> {
    match needed {
        needed if needed <= memory => Ok(()),
        needed => Err(IoError::TooLarge {
            path: path.to_path_buf(),
            needed,
            memory,
        }),
    }
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(std::array::from_fn(|k| bytes[at + k]))
}

/// Returns the CRC-32 of version, length and header.
pub(super) fn header_crc(version: u32, json: &[u8]) -> u32 {
    let mut crc = Hasher::new();
    crc.update(&version.to_le_bytes());
    crc.update(&(json.len() as u64).to_le_bytes());
    crc.update(json);
    crc.finalize()
}
