//! Tables of a deck, with comments that name their origin.

use crate::entry::Entry;

/// A table of a deck.
#[derive(Debug)]
pub(crate) struct Table {
    heading: String,
    /// The entries of the input file from which the table comes.
    origins: Vec<String>,
    /// Keys and values, as TOML.
    keys: Vec<(&'static str, String)>,
}

impl Table {
    /// A table with a heading such as `[body]`.
    pub(crate) fn new(heading: impl Into<String>) -> Self {
        Self {
            heading: heading.into(),
            origins: Vec::new(),
            keys: Vec::new(),
        }
    }

    /// Adds an entry from which the table comes.
    pub(crate) fn from(mut self, entry: &Entry) -> Self {
        let origin = format!("{} (line {})", entry.path(), entry.line());
        if !self.origins.contains(&origin) {
            self.origins.push(origin);
        }
        self
    }

    pub(crate) fn key(mut self, key: &'static str, value: impl Into<String>) -> Self {
        self.keys.push((key, value.into()));
        self
    }

    pub(crate) fn maybe(self, key: &'static str, value: Option<String>) -> Self {
        match value {
            Some(value) => self.key(key, value),
            None => self,
        }
    }

    pub(crate) fn keys(self, keys: impl IntoIterator<Item = (&'static str, String)>) -> Self {
        let mut table = self;
        table.keys.extend(keys);
        table
    }

    /// Adds the table to the text of a deck.
    pub(crate) fn write(&self, deck: &mut String) {
        deck.push('\n');
        for origin in &self.origins {
            deck.push_str(&comment(origin));
        }
        deck.push_str(&self.heading);
        deck.push('\n');
        for (key, value) in &self.keys {
            deck.push_str(&format!("{key} = {value}\n"));
        }
    }
}

/// Returns lines of a comment.
pub(crate) fn comment(text: &str) -> String {
    // Control characters are not allowed in TOML comments.
    let shown = |c: char| if c.is_control() { ' ' } else { c };
    format!("# {}\n", text.chars().map(shown).collect::<String>())
}

/// Returns a name in a heading such as `[sets.NAME]`.
pub(crate) fn heading(table: &str, name: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !name.is_empty() && name.chars().all(bare) {
        format!("[{table}.{name}]")
    } else {
        format!("[{table}.{}]", text(name))
    }
}

pub(crate) fn text(text: &str) -> String {
    toml::Value::from(text).to_string()
}

pub(crate) fn number(number: f64) -> String {
    if number == 0.0 || (1e-3..1e6).contains(&number.abs()) {
        format!("{number}")
    } else {
        format!("{number:e}")
    }
}

/// Returns a number rounded to some digits.
pub(crate) fn rounded(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

pub(crate) fn list(entries: impl IntoIterator<Item = String>) -> String {
    let entries: Vec<String> = entries.into_iter().collect();
    format!("[{}]", entries.join(", "))
}

pub(crate) fn numbers(entries: &[f64]) -> String {
    list(entries.iter().copied().map(number))
}
