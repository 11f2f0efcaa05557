//! Arrays that are dear to compute and depend on few inputs, kept from run to run.
//!
//! Kernels of absorbing boundaries, geodesic distances: who computes them asks a [`Cache`] first. The library knows no files; `pericles-io` has a
//! cache in a folder. What a cache gives is checked there to be what was stored under this key, and by the caller to have the sizes it needs.
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

/// A place where arrays are kept from run to run. A cache may forget; it never gives what was stored under another key.
pub trait Cache: Send + Sync {
    /// What was stored under the key, if it is there and undamaged.
    fn load(&self, key: &Key) -> Option<Archive>;
    /// Stores arrays. A failure is not an error of the run: the arrays are computed again next time.
    fn store(&self, key: &Key, arrays: &Archive);
}

/// A cache that forgets everything.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoCache;

impl Cache for NoCache {
    fn load(&self, _: &Key) -> Option<Archive> {
        None
    }

    fn store(&self, _: &Key, _: &Archive) {}
}

/// All that a stored result depends on: a kind, which names the algorithm and its version, and the inputs to the last bit.
///
/// Every input is hashed with its type and length, so that different lists of inputs give different keys (SHA-256).
#[derive(Clone)]
pub struct Key {
    kind: &'static str,
    hash: Sha256,
}

impl Key {
    /// A key without inputs yet. The kind is part of file names: letters, digits and hyphens. It changes when the algorithm's results do.
    pub fn new(kind: &'static str) -> Self {
        Self {
            kind,
            hash: Sha256::new(),
        }
        .text(kind)
    }

    /// The kind.
    pub fn kind(&self) -> &'static str {
        self.kind
    }

    /// Adds a text.
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

    /// The digest in hexadecimal digits.
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
    fn keys_differ_with_the_inputs_and_where_one_ends() {
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
