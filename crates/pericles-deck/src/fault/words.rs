//! Words that are not among those allowed.

use super::Fault;
use crate::nearest::nearest;
use crate::wording::shortened;

impl Fault {
    /// A word that is not among those allowed, with the one that may have been meant. Of many words the first 30 are named.
    pub fn unknown_word<'w>(
        what: &'static str,
        word: &str,
        allowed: impl Iterator<Item = &'w str> + Clone,
    ) -> Self {
        /// Nobody reads more; a deck with as many wrong names would take as many copies.
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
