//! Texts of errors that depend on numbers or on words.

use super::Fault;
use crate::nearest::nearest;
use crate::wording::shortened;

/// A pressure on a set without faces, or with faces inside the body.
pub(super) fn no_faces(set: &str, inner: usize) -> String {
    let set = shortened(set);
    match inner {
        0 => format!("the set `{set}` has no face on which a pressure can act"),
        inner => format!(
            "{inner} face(s) of the set `{set}` lie between two elements of the body, where a pressure has no resultant"
        ),
    }
}

impl Fault {
    /// Creates the error for an expression of position and time, or of stress and strain.
    pub fn bad_expression(text: String, reason: String) -> Self {
        Self::BadExpression {
            text,
            reason,
            allowed: "such as { expression = \"1e-3 * exp(-(x/0.01)^2)\" }, in SI units",
        }
    }

    /// An unknown word, with the most similar allowed word and the first 30 allowed words.
    pub fn unknown_word<'w>(
        what: &'static str,
        word: &str,
        allowed: impl Iterator<Item = &'w str> + Clone,
    ) -> Self {
        /// Bounds the length of the message and the memory for decks with many wrong names.
        const MOST: usize = 30;
        let few = allowed.clone().nth(100 * MOST).is_none();
        let meant = match few {
            true => nearest(word, allowed.clone()),
            false => None,
        };
        Self::UnknownWord {
            what,
            value: shortened(word),
            nearest: meant.map(String::from),
            allowed: allowed.take(MOST).map(String::from).collect(),
        }
    }
}
