//! Checkpoints: the complete state of a run in one file, from which it resumes bit for bit.
//!
//! A [`Container`] holds a JSON value and named arrays. The file is little-endian throughout:
//!
//! | bytes | content |
//! |---|---|
//! | 8 | `PERICLES` |
//! | 4 | format version |
//! | 8 | length of the header |
//! | 4 | CRC-32 of the version, the length and the header |
//! | … | header: JSON `{metadata, sections: [{name, type, len, stored, crc32, codec}]}`, padded with spaces |
//! | … | the sections in the order of the header, without gaps, up to the end of the file |
//!
//! The bytes of a section are shuffled (the first bytes of up to 65536 elements, then their second bytes …),
//! which groups slowly varying exponents, and compressed as an LZ4 frame; `crc32` is the checksum of the
//! `stored` bytes. Every size is checked against the length of the file before data are read, and no section
//! is decoded before its CRC-32 is verified.
//!
//! [`CheckpointFolder`] keeps the last two checkpoints, so that one remains if the other is damaged.
//!
//! ```
//! use pericles_io::{CheckpointFolder, Container, Section};
//! let folder = tempfile::tempdir().unwrap();
//! let checkpoints = CheckpointFolder::new(folder.path().join("checkpoints"));
//! let mut state = Container::default();
//! state.metadata = serde_json::json!({ "step": 1840 });
//! state.sections.insert("velocity".into(), Section::F64(vec![0.1, -0.2]));
//! checkpoints.write(1840, &state).unwrap();
//! let latest = checkpoints.latest_valid(u64::MAX).unwrap();
//! assert_eq!((latest.step, latest.container), (1840, state));
//! ```

mod container;
mod folder;
mod section;

pub use container::Container;
pub use folder::{CheckpointFolder, LatestCheckpoint};
pub use section::Section;
