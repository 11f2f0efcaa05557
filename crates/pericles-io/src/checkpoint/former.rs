//! Reading of version 1: sections are LZ4 frames, each with one checksum in the header.

use std::collections::BTreeMap;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use crc32fast::Hasher;
use lz4_flex::frame::FrameDecoder;
use serde::Deserialize;
use serde_json::Value;

use super::block::{Element, append_shuffled};
use super::head::{Opening, check_memory};
use super::kind::Kind;
use super::section::Section;
use crate::IoError;

/// Number of entries shuffled together.
const CHUNK: usize = 1 << 16;

#[derive(Deserialize)]
struct Header {
    metadata: Value,
    sections: Vec<Entry>,
}

#[derive(Deserialize)]
struct Entry {
    name: String,
    #[serde(rename = "type")]
    kind: Kind,
    len: u64,
    stored: u64,
    crc32: u32,
}

/// Reads what follows the opening of a file: metadata and sections.
pub(super) fn read(
    path: &Path,
    opening: &Opening,
    mut file: impl Read + Seek,
    memory: u64,
) -> Result<(Value, BTreeMap<String, Section>), IoError> {
    let reading = |source| IoError::reading(path, source);
    let damaged = |reason: String| IoError::damaged(path, reason);
    let header: Header = serde_json::from_slice(&opening.json)
        .map_err(|error| damaged(format!("the header is not valid: {error}")))?;
    let mut stored = header.sections.iter().map(|entry| entry.stored);
    let stored = stored.try_fold(0_u64, |sum, stored| sum.checked_add(stored));
    if stored != Some(opening.rest) {
        return Err(damaged(format!(
            "its sections do not fill the {} bytes after the header",
            opening.rest
        )));
    }
    let bytes = |entry: &Entry| entry.len.saturating_mul(entry.kind.bytes());
    let needed = header.sections.iter().map(bytes);
    check_memory(path, needed.fold(0, u64::saturating_add), memory)?;
    let mut sections = BTreeMap::new();
    for entry in header.sections {
        let start = file.stream_position().map_err(reading)?;
        if crc_of(&mut (&mut file).take(entry.stored)).map_err(reading)? != entry.crc32 {
            let name = entry.name;
            return Err(damaged(format!(
                "the CRC-32 of section {name:?} does not match"
            )));
        }
        file.seek(SeekFrom::Start(start)).map_err(reading)?;
        let section = section(entry.kind, entry.len, (&mut file).take(entry.stored))
            .map_err(|error| damaged(format!("section {:?}: {error}", entry.name)))?;
        file.seek(SeekFrom::Start(start + entry.stored))
            .map_err(reading)?;
        if sections.insert(entry.name, section).is_some() {
            return Err(damaged("two sections have the same name".into()));
        }
    }
    Ok((header.metadata, sections))
}

fn crc_of(input: &mut impl Read) -> io::Result<u32> {
    let mut crc = Hasher::new();
    let mut buffer = [0; 1 << 13];
    loop {
        match input.read(&mut buffer) {
            Ok(0) => return Ok(crc.finalize()),
            Ok(count) => crc.update(&buffer[..count]),
            Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// Decodes exactly `len` entries.
fn section(kind: Kind, len: u64, stored: impl Read) -> io::Result<Section> {
    Ok(match kind {
        Kind::F64 => Section::F64(decode(len, stored)?),
        Kind::U64 => Section::U64(decode(len, stored)?),
        Kind::U32 => Section::U32(decode(len, stored)?),
        Kind::U8 => Section::U8(decode(len, stored)?),
    })
}

fn decode<T: Element>(len: u64, stored: impl Read) -> io::Result<Vec<T>> {
    let mut lz4 = FrameDecoder::new(stored);
    let mut values = Vec::new();
    let mut shuffled = Vec::new();
    let mut left = len;
    while left > 0 {
        // The vector grows with the data that are present, not with `len`.
        let count = left.min(CHUNK as u64) as usize;
        shuffled.resize(count * T::WIDTH, 0);
        lz4.read_exact(&mut shuffled)?;
        append_shuffled(&mut values, &shuffled);
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
pub(super) mod tests {
    use super::super::Container;
    use std::io::Write;

    use lz4_flex::frame::FrameEncoder;
    use serde_json::json;

    use super::super::head::{FORMER, header_crc};
    use super::*;

    fn encoded<T: Element>(values: &[T]) -> Vec<u8> {
        let mut lz4 = FrameEncoder::new(Vec::new());
        for chunk in values.chunks(CHUNK) {
            let byte = |k: usize| chunk.iter().map(move |value| value.byte(k));
            let shuffled: Vec<u8> = (0..T::WIDTH).flat_map(byte).collect();
            lz4.write_all(&shuffled).unwrap();
        }
        lz4.finish().unwrap()
    }

    /// Returns the file of version 1 with a content.
    pub(in super::super) fn file(container: &Container) -> Vec<u8> {
        let mut entries = Vec::new();
        let mut body = Vec::new();
        for (name, section) in &container.sections {
            let stored = match section {
                Section::F64(values) => encoded(values),
                Section::U64(values) => encoded(values),
                Section::U32(values) => encoded(values),
                Section::U8(values) => encoded(values),
            };
            entries.push(json!({
                "name": name, "type": section.kind(), "len": section.len(),
                "stored": stored.len(), "crc32": crc32fast::hash(&stored), "codec": "shuffle+lz4",
            }));
            body.extend(stored);
        }
        let header = json!({ "metadata": container.metadata, "sections": entries }).to_string();
        let mut bytes = b"PERICLES\x01\0\0\0".to_vec();
        bytes.extend((header.len() as u64).to_le_bytes());
        bytes.extend(header_crc(FORMER, header.as_bytes()).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(body);
        bytes
    }

    #[test]
    fn files_of_version_1_are_read() {
        let mut container = Container {
            metadata: json!({ "step": 7 }),
            ..Container::default()
        };
        let numbers = (0..CHUNK + 9).map(|i| (i as f64).sqrt()).collect();
        let sections = &mut container.sections;
        sections.insert("velocity".into(), Section::F64(numbers));
        sections.insert("bonds".into(), Section::U8(vec![1; 20]));
        sections.insert("step".into(), Section::U64(vec![7]));
        sections.insert("numbers".into(), Section::U32(vec![3, 1]));
        let bytes = file(&container);
        let read = |bytes: &[u8]| Container::parse("a.chk", bytes, u64::MAX);
        assert_eq!(read(&bytes).unwrap(), container);
        for at in [30, bytes.len() - 1] {
            let mut bytes = bytes.clone();
            bytes[at] ^= 1;
            assert!(matches!(read(&bytes), Err(IoError::Damaged { .. })));
            assert!(matches!(read(&bytes[..at]), Err(IoError::Damaged { .. })));
        }
    }
}
