//! Checkpoints: everything a run needs to go on bit for bit, in one file that is either whole or refused.
//!
//! A [`Container`] holds a JSON value and named arrays. The file, little-endian throughout:
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
//! A section's bytes are shuffled (all first bytes of some 65536 elements, then all second bytes …), which puts the slowly varying
//! exponents side by side, and compressed as an LZ4 frame; `crc32` is that of the `stored` bytes. Every size is checked against
//! the length of the file before anything is read, and no section is decoded before its CRC-32 has been checked.
//!
//! [`CheckpointFolder`] keeps the last two of them, so that one is left whatever happens to the other.
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
