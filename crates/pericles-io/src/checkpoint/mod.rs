//! Checkpoints: the complete state of a run in one file, from which it resumes bit for bit.
//!
//! A [`Container`] holds a JSON value and named arrays. The file is little-endian throughout:
//!
//! | bytes | content |
//! |---|---|
//! | 8 | `PERICLES` |
//! | 4 | format version, 2 |
//! | 8 | length of the header |
//! | 4 | CRC-32 of the version, the length and the header |
//! | … | header: JSON `{metadata, sections: [{name, type, len, codec}]}` |
//! | 8 per block | table of blocks: `stored` bytes and their CRC-32, 4 bytes each, in the order of the sections |
//! | 4 | CRC-32 of the table |
//! | … | the blocks in the order of the table, without gaps, up to the end of the file |
//!
//! A section is cut into blocks of 512 KiB, the last of which may be shorter. The bytes of a block are shuffled (the first
//! bytes of all elements, then their second bytes …), which groups slowly varying exponents, and compressed in the block format
//! of LZ4; a block that would not become smaller is stored as it is. Every size is checked against the length of the file
//! before data are read, and no block is decoded before its CRC-32 is verified.
//!
//! The blocks do not depend on each other, so that processes that share a divided body encode and write them in parallel
//! ([`CheckpointFolder::write_divided`]); the file is the same, byte for byte, for any number of processes.
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

mod block;
mod container;
mod divided;
mod folder;
mod head;
mod kind;
mod section;

pub use container::Container;
pub use divided::{DividedCheckpoint, write_divided};
pub use folder::{CheckpointFolder, LatestCheckpoint};
pub use section::Section;
