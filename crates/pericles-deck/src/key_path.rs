//! Paths from the root of a deck to a value.

use std::fmt;

/// One step of a path.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Step {
    Key(String),
    Index(usize),
}

/// The path of a value in a deck or model: keys under their first names and indices of list entries from zero, such as
/// `load.0.traction`.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct KeyPath(Vec<Step>);

impl KeyPath {
    /// Returns the path of a key in this table.
    pub fn key(&self, key: &str) -> Self {
        self.then(Step::Key(key.into()))
    }

    /// Returns the path of an entry of this list, counted from zero.
    pub fn index(&self, index: usize) -> Self {
        self.then(Step::Index(index))
    }

    /// Returns the path of the table or list that contains the value; none for the root.
    pub fn parent(&self) -> Option<Self> {
        let (_, steps) = self.0.split_last()?;
        Some(Self(steps.to_vec()))
    }

    /// Returns the path with the prefix `from` replaced by `to`; none if it does not start with `from`.
    pub(crate) fn moved(&self, from: &Self, to: &Self) -> Option<Self> {
        let rest = self.0.strip_prefix(&from.0[..])?;
        Some(Self(to.0.iter().chain(rest).cloned().collect()))
    }

    pub(crate) fn steps(&self) -> &[Step] {
        &self.0
    }

    /// Returns the keys joined by dots, as in an override.
    pub fn dotted(&self) -> String {
        let steps: Vec<String> = self.0.iter().map(Step::to_string).collect();
        steps.join(".")
    }

    fn then(&self, step: Step) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }
}

impl From<&str> for KeyPath {
    /// Parses keys joined by dots, for paths fixed in the program.
    fn from(dotted: &str) -> Self {
        dotted
            .split('.')
            .fold(Self::default(), |path, key| path.key(key))
    }
}

impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(key) => f.write_str(key),
            Self::Index(index) => write!(f, "{index}"),
        }
    }
}

impl fmt::Display for KeyPath {
    /// Formats the path as the name of a table in messages: `[load.0]`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.0.is_empty() {
            return f.write_str("the deck");
        }
        write!(f, "[{}]", self.dotted())
    }
}
