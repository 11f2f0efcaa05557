//! A cache for arrays that are expensive to compute and depend on few inputs, shared by several runs.
//!
//! Kernels of absorbing boundaries and geodesic distances are looked up in a [`Cache`] before they are computed.
//! The engine accesses no files; `pericles-io` provides a cache in a folder. That cache checks that the arrays were
//! stored under the same key; the caller checks that they have the right sizes.
//!
//! ```
//! use pericles::cache::{Cache, Key, NoCache};
//! let key = Key::new("squares").u64s(&[10]);
//! assert_ne!(key, Key::new("squares").u64s(&[11]));
//! assert!(NoCache.load(&key).is_none());
//! ```

use std::fmt;

use sha2::{Digest, Sha256};

use crate::archive::Archive;

/// A store of arrays that outlives a run. It may forget entries, but never returns arrays stored under another key.
pub trait Cache: Send + Sync {
    /// Returns the arrays stored under a key, if they exist and are undamaged.
    fn load(&self, key: &Key) -> Option<Archive>;
    /// Stores arrays. A failure is not an error of the run: the arrays are computed again next time.
    fn store(&self, key: &Key, arrays: &Archive);
}

/// A cache that stores nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoCache;

impl Cache for NoCache {
    fn load(&self, _: &Key) -> Option<Archive> {
        None
    }

    fn store(&self, _: &Key, _: &Archive) {}
}

/// The key of a stored result: its kind, which names the algorithm and its version, and all inputs bit for bit.
///
/// Every input is hashed (SHA-256) with its type and length, so that different lists of inputs have different keys.
#[derive(Clone)]
pub struct Key {
    kind: &'static str,
    hash: Sha256,
}

impl Key {
    /// Makes a key without inputs. The kind is part of file names: letters, digits and hyphens. Change it when the
    /// results of the algorithm change.
    pub fn new(kind: &'static str) -> Self {
        Self {
            kind,
            hash: Sha256::new(),
        }
        .text(kind)
    }

    /// Returns the kind.
    pub fn kind(&self) -> &'static str {
        self.kind
    }

    /// Adds a string.
    #[must_use]
    pub fn text(mut self, text: &str) -> Self {
        self.start(b't', text.len());
        self.hash.update(text);
        self
    }

    /// Adds numbers, bit for bit.
    #[must_use]
    pub fn f64s(mut self, numbers: &[f64]) -> Self {
        self.start(b'f', numbers.len());
        for number in numbers {
            self.hash.update(number.to_bits().to_le_bytes());
        }
        self
    }

    /// Adds whole numbers.
    #[must_use]
    pub fn u64s(mut self, numbers: &[u64]) -> Self {
        self.start(b'u', numbers.len());
        for number in numbers {
            self.hash.update(number.to_le_bytes());
        }
        self
    }

    fn start(&mut self, kind: u8, length: usize) {
        self.hash.update([kind]);
        self.hash.update((length as u64).to_le_bytes());
    }

    /// Returns the digest in hexadecimal digits.
    pub fn digest(&self) -> String {
        let bytes = self.hash.clone().finalize();
        bytes.iter().map(|byte| format!("{byte:02x}")).collect()
    }
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind && self.digest() == other.digest()
    }
}

impl Eq for Key {}

impl fmt::Debug for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}-{}", self.kind, self.digest())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_depend_on_every_input_and_its_length() {
        let keys = [
            Key::new("a"),
            Key::new("b"),
            Key::new("a").f64s(&[0.0]),
            Key::new("a").f64s(&[-0.0]),
            Key::new("a").u64s(&[0]),
            Key::new("a").f64s(&[0.0, 1.0]),
            Key::new("a").f64s(&[0.0]).f64s(&[1.0]),
            Key::new("a").text("bc"),
            Key::new("a").text("b").text("c"),
        ];
        for (i, a) in keys.iter().enumerate() {
            for (j, b) in keys.iter().enumerate() {
                assert_eq!(a == b, i == j, "{a:?} {b:?}");
            }
        }
    }
}
