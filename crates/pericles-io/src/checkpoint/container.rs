//! File format of checkpoints.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader, Cursor, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::Path;

use pericles::{Archive, Values};
use serde_json::Value;

use super::block::{Coder, entries};
use super::head::{Draft, Entry, Head, Opening, Placed};
use super::section::{Codec, Section};
use crate::{IoError, write_atomically};

/// JSON metadata and named arrays.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Container {
    /// Metadata: deck, step number, settings. Finite numbers are preserved exactly; JSON has no NaN or infinity.
    pub metadata: Value,
    /// Named arrays.
    pub sections: BTreeMap<String, Section>,
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
        let entry = |(name, section): (&String, &Section)| Entry {
            name: name.clone(),
            kind: section.kind(),
            len: section.len() as u64,
            codec: Codec::ShuffleLz4,
        };
        let draft = Draft::new(&self.metadata, self.sections.iter().map(entry).collect())?;
        // Sizes and checksums of the blocks are known only after they are written.
        let mut table = Vec::with_capacity(draft.blocks() as usize);
        let mut coder = Coder::default();
        out.seek(SeekFrom::Start(draft.end()))?;
        for section in self.sections.values() {
            section.encode(&mut coder, &mut |block, bytes| {
                table.push(block);
                out.write_all(bytes)
            })?;
        }
        out.seek(SeekFrom::Start(0))?;
        out.write_all(&draft.bytes(&table))
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
        let opening = Opening::read(path, &mut file, length, memory)?;
        let head = Head::read(path, opening, &mut file, memory)?;
        let mut coder = Coder::default();
        let mut sections = BTreeMap::new();
        for placed in &head.sections {
            let section = read_section(path, &mut file, &head, placed, 0..placed.len, &mut coder)?;
            if sections.insert(placed.name.clone(), section).is_some() {
                return Err(IoError::damaged(path, "two sections have the same name"));
            }
        }
        Ok(Self {
            metadata: head.metadata,
            sections,
        })
    }
}

/// Reads a range of a section, which begins with a block and ends with one or with the section.
pub(super) fn read_section(
    path: &Path,
    mut file: impl Read + Seek,
    head: &Head,
    placed: &Placed,
    range: Range<u64>,
    coder: &mut Coder,
) -> Result<Section, IoError> {
    let most = entries(placed.kind) as u64;
    let mut section = Section::empty(placed.kind);
    let mut bytes = Vec::new();
    let blocks = (range.start / most) as usize..range.end.div_ceil(most) as usize;
    for (block, place) in &head.blocks[placed.blocks.clone()][blocks] {
        file.seek(SeekFrom::Start(*place))
            .map_err(|source| IoError::reading(path, source))?;
        bytes.resize(block.stored as usize, 0);
        file.read_exact(&mut bytes)
            .map_err(|source| IoError::reading(path, source))?;
        let left = range.end - range.start - section.len() as u64;
        section
            .decode(coder, *block, &bytes, left.min(most) as usize)
            .map_err(|error| {
                IoError::damaged(path, format!("section {:?}: {error}", placed.name))
            })?;
    }
    Ok(section)
}

#[cfg(test)]
mod tests {
    use super::super::head::{VERSION, header_crc};
    use super::super::kind::Kind;
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
            let mut file = if marked { b"PERICLES\x02\0\0\0".to_vec() } else { Vec::new() };
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
        let rejected = |bytes: &[u8], what: String| {
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
                rejected(&bytes, format!("bit {bit} of byte {at}"));
            }
            rejected(&good[..at], format!("cut at {at}"));
        }
        rejected(&[&good[..], b"x"].concat(), "one byte more".into());
    }

    /// A file with this header and what follows it.
    fn forged(header: &str, rest: &[u8]) -> Vec<u8> {
        let mut bytes = b"PERICLES\x02\0\0\0".to_vec();
        bytes.extend((header.len() as u64).to_le_bytes());
        bytes.extend(header_crc(VERSION, header.as_bytes()).to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(rest);
        bytes
    }

    /// A table of blocks and its checksum.
    fn table(blocks: &[[u32; 2]]) -> Vec<u8> {
        let numbers = blocks.as_flattened().iter();
        let table: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
        let crc = crc32fast::hash(&table).to_le_bytes();
        [&table[..], &crc].concat()
    }

    #[test]
    fn a_false_header_is_rejected_before_memory_is_allocated() {
        let entry = |name: &str, len: u64| json!({ "name": name, "type": "f64", "len": len, "codec": "shuffle+lz4" });
        let crc = crc32fast::hash(b"abc");
        let eight = crc32fast::hash(b"12345678");
        let plain = [8, eight];
        for (sections, rest) in [
            (json!([entry("u", u64::MAX)]), table(&[])),
            (
                json!([entry("u", u64::MAX), entry("v", u64::MAX)]),
                table(&[]),
            ),
            (json!([entry("u", 1)]), table(&[])),
            (json!([entry("u", 1)]), table(&[[u32::MAX, 0]])),
            (
                json!([entry("u", 0)]),
                [table(&[]), b"abc".to_vec()].concat(),
            ),
            (
                json!([entry("u", 1)]),
                [table(&[[3, crc]]), b"abc".to_vec()].concat(),
            ),
            (
                json!([entry("u", 2)]),
                [table(&[plain]), b"12345678".to_vec()].concat(),
            ),
            (
                json!([entry("u", 1)]),
                [table(&[[3, crc]]), b"abcd".to_vec()].concat(),
            ),
            (
                json!([entry("u", 1), entry("u", 1)]),
                [table(&[plain, plain]), b"1234567812345678".to_vec()].concat(),
            ),
        ] {
            let text = json!({ "metadata": null, "sections": sections }).to_string();
            let error = Container::parse("a.chk", &forged(&text, &rest), u64::MAX).unwrap_err();
            assert!(matches!(error, IoError::Damaged { .. }), "{text}: {error}");
        }
        let text = json!({ "metadata": null, "sections": [entry("u", 1)] }).to_string();
        let good = [table(&[plain]), b"12345678".to_vec()].concat();
        assert!(Container::parse("a.chk", &forged(&text, &good), u64::MAX).is_ok());
        let mut bytes = b"PERICLES\x02\0\0\0".to_vec();
        bytes.extend(u64::MAX.to_le_bytes());
        bytes.extend([0; 4]);
        assert!(Container::parse("a.chk", &bytes, u64::MAX).is_err());
    }

    #[test]
    fn the_layout_matches_the_module_documentation() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.chk");
        example().write(&path).unwrap();
        let bytes = fs::read(&path).unwrap();
        assert_eq!(&bytes[..12], b"PERICLES\x02\0\0\0");
        let room = u64::from_le_bytes(bytes[12..20].try_into().unwrap()) as usize;
        let header: Value = serde_json::from_slice(&bytes[24..24 + room]).unwrap();
        let covered = [&bytes[8..20], &bytes[24..24 + room]].concat();
        let crc = u32::from_le_bytes(bytes[20..24].try_into().unwrap());
        assert_eq!(crc32fast::hash(&covered), crc);
        for (entry, name) in
            (header["sections"].as_array().unwrap().iter()).zip(["bonds", "velocity"])
        {
            assert_eq!(entry["name"], name);
        }
        let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        let table = 24 + room;
        let mut at = table + 2 * 8 + 4;
        assert_eq!(crc32fast::hash(&bytes[table..at - 4]), number(at - 4));
        for block in 0..2 {
            let stored = &bytes[at..at + number(table + 8 * block) as usize];
            assert_eq!(number(table + 8 * block + 4), crc32fast::hash(stored));
            at += stored.len();
        }
        assert_eq!(at, bytes.len());
    }

    #[test]
    fn sections_of_several_blocks_are_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.chk");
        let most = entries(Kind::F64);
        for len in [most - 1, most, most + 1, 2 * most + 7] {
            let mut container = Container::default();
            let numbers = (0..len).map(|i| (i as f64).sqrt()).collect();
            container.sections.insert("u".into(), Section::F64(numbers));
            container.write(&path).unwrap();
            let size = fs::metadata(&path).unwrap().len() as usize;
            assert!(size < 8 * len, "shuffled square roots compress");
            assert!(Container::read(&path, u64::MAX).unwrap() == container);
        }
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
                supported: VERSION,
                ..
            }
        ));
        let gone = Container::read(folder.path().join("gone.chk"), u64::MAX);
        assert!(matches!(gone, Err(IoError::NotFound { .. })));
    }
}
