//! Arrays as messages between processes, which consist of 64-bit words.

use std::ops::Range;

use crate::archive::Values;

/// Bytes in a word.
const BYTES: usize = 8;

/// Returns the entries of an array as words, whose bits floating-point numbers carry unchanged.
pub(super) fn into_words(values: &Values) -> Vec<f64> {
    match values {
        Values::F64(numbers) => numbers.clone(),
        Values::U64(numbers) => numbers.iter().copied().map(f64::from_bits).collect(),
        Values::U8(bytes) => {
            let word = |bytes: &[u8]| {
                let mut word = [0; BYTES];
                word[..bytes.len()].copy_from_slice(bytes);
                f64::from_bits(u64::from_le_bytes(word))
            };
            bytes.chunks(BYTES).map(word).collect()
        }
    }
}

/// Returns an array of `length` entries of the type of `like` from its words.
pub(super) fn of_words(like: &Values, length: usize, words: &[f64]) -> Values {
    match like {
        Values::F64(_) => Values::F64(words.to_vec()),
        Values::U64(_) => Values::U64(words.iter().map(|word| word.to_bits()).collect()),
        Values::U8(_) => {
            let bytes = words.iter().flat_map(|word| word.to_bits().to_le_bytes());
            Values::U8(bytes.take(length).collect())
        }
    }
}

/// Returns a text as an array of bytes.
pub(super) fn bytes_of(text: &str) -> Values {
    Values::U8(text.bytes().collect())
}

/// Returns a text of `length` bytes from its words.
pub(super) fn text_of(length: usize, words: &[f64]) -> String {
    match of_words(&Values::U8(Vec::new()), length, words) {
        Values::U8(bytes) => String::from_utf8_lossy(&bytes).into_owned(),
        _ => String::new(),
    }
}

impl Values {
    /// Returns an array of the same type with `length` zeros.
    pub(super) fn zeros(&self, length: usize) -> Self {
        match self {
            Self::F64(_) => Self::F64(vec![0.0; length]),
            Self::U64(_) => Self::U64(vec![0; length]),
            Self::U8(_) => Self::U8(vec![0; length]),
        }
    }

    /// Returns a range of the entries.
    pub(super) fn slice(&self, range: Range<usize>) -> Self {
        match self {
            Self::F64(numbers) => Self::F64(numbers[range].to_vec()),
            Self::U64(numbers) => Self::U64(numbers[range].to_vec()),
            Self::U8(numbers) => Self::U8(numbers[range].to_vec()),
        }
    }

    /// Appends an array of the same type.
    pub(super) fn append(&mut self, more: Self) {
        match (self, more) {
            (Self::F64(numbers), Self::F64(more)) => numbers.extend(more),
            (Self::U64(numbers), Self::U64(more)) => numbers.extend(more),
            (Self::U8(numbers), Self::U8(more)) => numbers.extend(more),
            // Both arrays are made of the same type.
            _ => {}
        }
    }

    /// Returns whether both arrays have the same type.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// Number of the type in messages.
    pub(super) fn kind(&self) -> u8 {
        match self {
            Self::F64(_) => 0,
            Self::U64(_) => 1,
            Self::U8(_) => 2,
        }
    }

    /// Returns an empty array of a type.
    pub(super) fn of_kind(kind: u8) -> Self {
        match kind {
            0 => Self::F64(Vec::new()),
            1 => Self::U64(Vec::new()),
            _ => Self::U8(Vec::new()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_preserve_all_bits() {
        let bits = [0, 1, u64::MAX, 0x7FF0_0000_0000_0001, 0xFFF8_0000_0000_0000];
        for values in [
            Values::F64(bits.map(f64::from_bits).to_vec()),
            Values::U64(bits.to_vec()),
            Values::U8((0..=255).chain(0..3).collect()),
            Values::U8(Vec::new()),
        ] {
            let words = into_words(&values);
            let kind = Values::of_kind(values.kind());
            assert_eq!(of_words(&kind, values.len(), &words), values);
        }
        let text = "operator/σ";
        assert_eq!(text_of(text.len(), &into_words(&bytes_of(text))), text);
    }
}
