//! File format of checkpoints.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Cursor, Read, Seek, SeekFrom, Write};
use std::path::Path;

use crc32fast::Hasher;
use pericles::{Archive, Values};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::section::{Codec, Kind, Section};
use crate::{IoError, write_atomically};

const MAGIC: &[u8; 8] = b"PERICLES";
const VERSION: u32 = 1;
/// Bytes of magic, version, and length and CRC-32 of the header.
const PREFIX: u64 = 24;
/// A number in a JSON list takes 32 bytes of memory and at least two characters.
const PER_CHARACTER: u64 = 16;

/// JSON metadata and named arrays.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Container {
    /// Metadata: deck, step number, settings. Finite numbers are preserved exactly; JSON has no NaN or infinity.
    pub metadata: Value,
    /// Named arrays.
    pub sections: BTreeMap<String, Section>,
}

#[derive(Serialize, Deserialize)]
struct Header<'a> {
    metadata: std::borrow::Cow<'a, Value>,
    sections: Vec<Entry>,
}

#[derive(Serialize, Deserialize)]
struct Entry {
    name: String,
    #[serde(rename = "type")]
    kind: Kind,
    len: u64,
    stored: u64,
    crc32: u32,
    codec: Codec,
}

impl Container {
    /// Creates a container from the arrays of an archive.
    pub fn from_archive(metadata: Value, archive: Archive) -> Self {
        let sections = archive.into_arrays().into_iter();
        Self {
            metadata,
            sections: sections
                .map(|(name, values)| (name, values.into()))
                .collect(),
        }
    }

    /// Returns the metadata, and the arrays as an archive.
    ///
    /// # Errors
    /// Returns an error if an array has a type that archives do not support.
    pub fn into_archive(self) -> Result<(Value, Archive), String> {
        let mut archive = Archive::default();
        for (name, section) in self.sections {
            let values = Values::try_from(section)
                .map_err(|kind| format!("the array {name:?} has the unsupported type {kind}"))?;
            archive.put(name, values);
        }
        Ok((self.metadata, archive))
    }

    /// Writes the container atomically; equal content gives equal bytes.
    pub fn write(&self, path: impl AsRef<Path>) -> Result<(), IoError> {
        write_atomically(path.as_ref(), |out| self.write_into(out))
    }

    fn write_into(&self, out: &mut (impl Write + Seek)) -> io::Result<()> {
        // Sizes and checksums are known only after the sections are written. Space for the longest possible
        // numbers is reserved, so that no encoded section is held in memory.
        let mut header = Header {
            metadata: std::borrow::Cow::Borrowed(&self.metadata),
            sections: Vec::with_capacity(self.sections.len()),
        };
        for (name, section) in &self.sections {
            header.sections.push(Entry {
                name: name.clone(),
                kind: section.kind(),
                len: section.len() as u64,
                stored: u64::MAX,
                crc32: u32::MAX,
                codec: Codec::ShuffleLz4,
            });
        }
        let room = serde_json::to_vec(&header)?.len();
        out.seek(SeekFrom::Start(PREFIX + room as u64))?;
        for (entry, section) in header.sections.iter_mut().zip(self.sections.values()) {
            let mut counted = Counted {
                out: &mut *out,
                crc: Hasher::new(),
                length: 0,
            };
            section.encode(&mut counted)?;
            entry.stored = counted.length;
            entry.crc32 = counted.crc.finalize();
        }
        let mut json = serde_json::to_vec(&header)?;
        json.resize(room, b' ');
        out.seek(SeekFrom::Start(0))?;
        out.write_all(MAGIC)?;
        out.write_all(&VERSION.to_le_bytes())?;
        out.write_all(&(room as u64).to_le_bytes())?;
        out.write_all(&header_crc(&json).to_le_bytes())?;
        out.write_all(&json)
    }

    /// Reads a container whose decoded content may take at most `memory` bytes.
    ///
    /// # Errors
    /// Returns an error if the file differs from what was written (with the reason), or if its content
    /// exceeds `memory`.
    pub fn read(path: impl AsRef<Path>, memory: u64) -> Result<Self, IoError> {
        let path = path.as_ref();
        let reading = |source| IoError::reading(path, source);
        let file = File::open(path).map_err(reading)?;
        let length = file.metadata().map_err(reading)?.len();
        Self::read_from(
            path,
            BufReader::with_capacity(1 << 16, file),
            length,
            memory,
        )
    }

    /// Parses the content of a container file; `name` is used in messages.
    ///
    /// # Errors
    /// As [`Container::read`], except for errors of reading the file.
    pub fn parse(name: impl AsRef<Path>, content: &[u8], memory: u64) -> Result<Self, IoError> {
        let length = content.len() as u64;
        Self::read_from(name.as_ref(), Cursor::new(content), length, memory)
    }

    fn read_from(
        path: &Path,
        mut file: impl Read + Seek,
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
                newest: VERSION,
            });
        }
        let room = u64::from(u32_at(&prefix, 12)) | u64::from(u32_at(&prefix, 16)) << 32;
        if room > length - PREFIX {
            return Err(damaged(format!(
                "a header of {room} bytes does not fit into a file of {length}"
            )));
        }
        let fits = |needed: u64| match needed {
            needed if needed <= memory => Ok(()),
            needed => Err(IoError::TooLarge {
                path: path.to_path_buf(),
                needed,
                memory,
            }),
        };
        fits(room.saturating_mul(PER_CHARACTER))?;
        let mut json = Vec::new();
        (&mut file)
            .take(room)
            .read_to_end(&mut json)
            .map_err(reading)?;
        if json.len() as u64 != room || header_crc(&json) != u32_at(&prefix, 20) {
            return Err(damaged("the CRC-32 of the header does not match".into()));
        }
        let header: Header = serde_json::from_slice(&json)
            .map_err(|error| damaged(format!("the header is not valid: {error}")))?;

        let stored = header
            .sections
            .iter()
            .try_fold(0_u64, |sum, entry| sum.checked_add(entry.stored));
        let found = length - PREFIX - room;
        if stored != Some(found) {
            return Err(damaged(format!(
                "its sections do not fill the {found} bytes after the header"
            )));
        }
        let bytes = |entry: &Entry| entry.len.saturating_mul(entry.kind.bytes());
        let needed = header.sections.iter().map(bytes);
        fits(needed.fold(0, u64::saturating_add))?;
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
            let section = Section::decode(entry.kind, entry.len, (&mut file).take(entry.stored))
                .map_err(|error| damaged(format!("section {:?}: {error}", entry.name)))?;
            file.seek(SeekFrom::Start(start + entry.stored))
                .map_err(reading)?;
            if sections.insert(entry.name, section).is_some() {
                return Err(damaged("two sections have the same name".into()));
            }
        }
        Ok(Self {
            metadata: header.metadata.into_owned(),
            sections,
        })
    }
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(std::array::from_fn(|k| bytes[at + k]))
}

fn header_crc(json: &[u8]) -> u32 {
    let mut crc = Hasher::new();
    crc.update(&VERSION.to_le_bytes());
    crc.update(&(json.len() as u64).to_le_bytes());
    crc.update(json);
    crc.finalize()
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

/// Counts bytes and computes the CRC-32 of everything written through it.
struct Counted<W> {
    out: W,
    crc: Hasher,
    length: u64,
}

impl<W: Write> Write for Counted<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.out.write(bytes)?;
        self.crc.update(&bytes[..count]);
        self.length += count as u64;
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use serde_json::json;
    use std::fs;

    fn section() -> impl Strategy<Value = Section> {
        prop_oneof![
            // random bits, to cover NaN, infinity and signed zero
            prop::collection::vec(any::<u64>(), 0..60)
                .prop_map(|bits| Section::F64(bits.into_iter().map(f64::from_bits).collect())),
            prop::collection::vec(any::<u64>(), 0..60).prop_map(Section::U64),
            prop::collection::vec(any::<u32>(), 0..60).prop_map(Section::U32),
            prop::collection::vec(any::<u8>(), 0..60).prop_map(Section::U8),
        ]
    }

    fn container() -> impl Strategy<Value = Container> {
        let metadata = (any::<u64>(), -1e300_f64..1e300, "\\PC{0,12}");
        let sections = prop::collection::btree_map("\\PC{0,12}", section(), 0..5);
        (metadata, sections).prop_map(|((step, time, deck), sections)| Container {
            metadata: json!({ "step": step, "time": time, "deck": deck }),
            sections,
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn a_container_is_read_back_bit_for_bit(container in container()) {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("a.chk");
            container.write(&path).unwrap();
            let back = Container::read(&path, u64::MAX).unwrap();
            prop_assert_eq!(&back.metadata, &container.metadata);
            prop_assert!(back.sections == container.sections);
        }

        #[test]
        fn a_file_of_random_bytes_is_rejected(bytes in prop::collection::vec(any::<u8>(), 0..200), marked in any::<bool>()) {
            let folder = tempfile::tempdir().unwrap();
            let path = folder.path().join("a.chk");
            let mut file = if marked { b"PERICLES\x01\0\0\0".to_vec() } else { Vec::new() };
            file.extend(bytes);
            fs::write(&path, file).unwrap();
            prop_assert!(Container::read(&path, u64::MAX).is_err());
        }
    }

    fn example() -> Container {
        let velocity = (0..40).map(|i| (i as f64).sin()).collect();
        Container {
            metadata: json!({ "deck": "branching.toml", "time": 0.1 + 0.2 }),
            sections: BTreeMap::from([
                ("bonds".into(), Section::U8(vec![1, 0, 1, 1])),
                ("velocity".into(), Section::F64(velocity)),
            ]),
        }
    }

    #[test]
    fn content_beyond_the_memory_limit_is_rejected_before_decoding() {
        const NUMBERS: usize = 1_000_000;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.chk");
        let mut container = Container::default();
        let zeros = Section::F64(vec![0.0; NUMBERS]);
        container.sections.insert("u".into(), zeros);
        container.write(&path).unwrap();
        let size = fs::metadata(&path).unwrap().len();
        let needed = 8 * NUMBERS as u64;
        assert!(100 * size < needed, "{size}");
        assert!(Container::read(&path, needed).is_ok());
        let error = Container::read(&path, needed - 1).unwrap_err();
        let told = matches!(error, IoError::TooLarge { needed: n, .. } if n == needed);
        assert!(told, "{error}");
    }

    #[test]
    fn every_flipped_bit_and_every_truncation_is_rejected() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.chk");
        example().write(&path).unwrap();
        let good = fs::read(&path).unwrap();
        let refused = |bytes: &[u8], what: String| {
            fs::write(&path, bytes).unwrap();
            let error = Container::read(&path, u64::MAX).expect_err(&what);
            let told = matches!(
                error,
                IoError::Damaged { .. } | IoError::UnsupportedVersion { .. }
            );
            assert!(told && !error.is_output_problem(), "{what}: {error}");
        };
        for at in 0..good.len() {
            for bit in 0..8 {
                let mut bytes = good.clone();
                bytes[at] ^= 1 << bit;
                refused(&bytes, format!("bit {bit} of byte {at}"));
            }
            refused(&good[..at], format!("cut at {at}"));
        }
        refused(&[&good[..], b"x"].concat(), "one byte more".into());
    }

    #[test]
    fn a_false_header_is_rejected_before_memory_is_allocated() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.chk");
        let entry = |len: u64, stored: u64| json!({ "name": "u", "type": "f64", "len": len, "stored": stored, "crc32": 0, "codec": "shuffle+lz4" });
        let huge = u64::MAX;
        for (sections, body) in [
            (json!([entry(huge, 0)]), &b""[..]),
            (json!([entry(1, huge)]), b""),
            (json!([entry(1, huge), entry(1, 2)]), b"x"), // the sum overflows to 1
            (json!([entry(0, 3)]), b"abc"),
        ] {
            let text = json!({ "metadata": null, "sections": sections }).to_string();
            let mut bytes = MAGIC.to_vec();
            bytes.extend(VERSION.to_le_bytes());
            bytes.extend((text.len() as u64).to_le_bytes());
            bytes.extend(header_crc(text.as_bytes()).to_le_bytes());
            bytes.extend(text.as_bytes());
            bytes.extend(body);
            fs::write(&path, bytes).unwrap();
            let error = Container::read(&path, u64::MAX).unwrap_err();
            assert!(matches!(error, IoError::Damaged { .. }), "{text}: {error}");
        }
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(huge.to_le_bytes());
        bytes.extend([0; 4]);
        fs::write(&path, bytes).unwrap();
        assert!(Container::read(&path, u64::MAX).is_err());
    }

    #[test]
    fn the_layout_matches_the_module_documentation() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.chk");
        example().write(&path).unwrap();
        let bytes = fs::read(&path).unwrap();
        assert_eq!(&bytes[..12], b"PERICLES\x01\0\0\0");
        let room = u64::from_le_bytes(bytes[12..20].try_into().unwrap()) as usize;
        let header: Value = serde_json::from_slice(&bytes[24..24 + room]).unwrap();
        let covered = [&bytes[8..20], &bytes[24..24 + room]].concat();
        let crc = u32::from_le_bytes(bytes[20..24].try_into().unwrap());
        assert_eq!(crc32fast::hash(&covered), crc);
        let mut at = 24 + room;
        for (entry, name) in header["sections"]
            .as_array()
            .unwrap()
            .iter()
            .zip(["bonds", "velocity"])
        {
            assert_eq!(entry["name"], name);
            let stored = &bytes[at..at + entry["stored"].as_u64().unwrap() as usize];
            assert_eq!(entry["crc32"], crc32fast::hash(stored));
            at += stored.len();
        }
        assert_eq!(at, bytes.len());
    }

    #[test]
    fn a_newer_format_version_is_not_reported_as_damage() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.chk");
        example().write(&path).unwrap();
        let mut bytes = fs::read(&path).unwrap();
        bytes[8] = 9;
        fs::write(&path, bytes).unwrap();
        let error = Container::read(&path, u64::MAX).unwrap_err();
        assert!(matches!(
            error,
            IoError::UnsupportedVersion {
                found: 9,
                newest: VERSION,
                ..
            }
        ));
        let gone = Container::read(folder.path().join("gone.chk"), u64::MAX);
        assert!(matches!(gone, Err(IoError::NotFound { .. })));
    }
}
