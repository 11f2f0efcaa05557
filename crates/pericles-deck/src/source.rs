//! Locations of values in decks and overrides.

use std::sync::Arc;

use miette::{LabeledSpan, NamedSource, SourceSpan};

/// A byte range in one of the texts of a deck: source 0 is the deck, the following are the overrides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(crate) struct Place {
    pub(crate) source: usize,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// A location as file, line and column.
#[derive(Debug, Clone)]
pub struct Location {
    text: Arc<NamedSource<String>>,
    /// Length of the line in bytes.
    line_length: usize,
    source: usize,
    start: usize,
    length: usize,
    line: usize,
    column: usize,
}

impl Location {
    /// Returns the name of the file as given, or `--set key` for an override.
    pub fn file(&self) -> &str {
        self.text.name()
    }

    /// Returns the line, from 1.
    pub fn line(&self) -> usize {
        self.line
    }

    /// Returns the column in characters, from 1.
    pub fn column(&self) -> usize {
        self.column
    }

    /// Returns the length of the line in bytes; very long lines should not be shown.
    pub fn line_length(&self) -> usize {
        self.line_length
    }

    /// Returns the byte range.
    pub fn span(&self) -> SourceSpan {
        (self.start, self.length).into()
    }

    /// Returns the text at the location.
    pub fn excerpt(&self) -> &str {
        self.text
            .inner()
            .get(self.start..self.start + self.length)
            .unwrap_or_default()
    }

    pub(crate) fn text(&self) -> &NamedSource<String> {
        &self.text
    }

    pub(crate) fn label(&self, words: &str) -> LabeledSpan {
        LabeledSpan::new(Some(words.into()), self.start, self.length)
    }

    /// Sort key: source (overrides after the deck) and position.
    pub(crate) fn order(&self) -> (usize, usize) {
        (self.source, self.start)
    }
}

impl std::fmt::Display for Location {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}:{}", self.file(), self.line, self.column)
    }
}

/// The texts of a deck: the file and its overrides.
#[derive(Debug, Clone)]
pub(crate) struct Sources(Vec<Source>);

/// A text with its name and the offsets of its lines.
#[derive(Debug, Clone)]
struct Source {
    name: String,
    text: String,
    /// Name and text as shown in reports: control characters, which terminals may interpret, are replaced by
    /// characters of equal length.
    shown: Arc<NamedSource<String>>,
    lines: Arc<[usize]>,
}

impl Source {
    fn new(name: &str, text: &str) -> Self {
        let breaks = text.match_indices('\n').map(|(at, _)| at + 1);
        Self {
            name: name.to_owned(),
            text: text.to_owned(),
            shown: Arc::new(NamedSource::new(visible(name), visible(text))),
            lines: std::iter::once(0).chain(breaks).collect(),
        }
    }
}

/// Returns whether a character changes how the text around it is shown, or is not shown at all: control characters, and
/// format characters such as those that reverse the direction of text.
pub fn is_invisible(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{fffb}' | '\u{e0000}'..='\u{e007f}')
}

/// Replaces invisible characters by a visible one of the same length, except for line ends and tabs.
fn visible(text: &str) -> String {
    let shown = |c: char| match c {
        '\n' | '\r' | '\t' => c,
        c if !is_invisible(c) => c,
        c => match c.len_utf8() {
            1 => ' ',
            2 => '¿',
            3 => char::REPLACEMENT_CHARACTER,
            _ => '𐄂',
        },
    };
    text.chars().map(shown).collect()
}

impl Default for Sources {
    /// Returns a single empty text.
    fn default() -> Self {
        Self::new("", "")
    }
}

impl Sources {
    pub(crate) fn new(name: &str, text: &str) -> Self {
        Self(vec![Source::new(name, text)])
    }

    /// Adds a text and returns its number.
    pub(crate) fn add(&mut self, name: &str, text: &str) -> usize {
        self.0.push(Source::new(name, text));
        self.0.len() - 1
    }

    /// Returns the name of the deck's file.
    pub(crate) fn name(&self) -> &str {
        self.0.first().map_or("", |source| &source.name)
    }

    pub(crate) fn text(&self, source: usize) -> &str {
        self.0.get(source).map_or("", |source| &source.text)
    }

    pub(crate) fn count(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn locate(&self, place: Place) -> Location {
        let source = place.source.min(self.0.len() - 1);
        let Source {
            shown: text, lines, ..
        } = &self.0[source];
        let inner = text.inner();
        let floor = |mut at: usize| {
            at = at.min(inner.len());
            while !inner.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let (start, end) = (floor(place.start), floor(place.end));
        let line = lines.partition_point(|&line| line <= start);
        let line_start = lines[line - 1];
        let line_end = lines.get(line).copied().unwrap_or(inner.len());
        Location {
            source,
            start,
            length: end.saturating_sub(start),
            line,
            line_length: line_end - line_start,
            column: inner[line_start..start].chars().count() + 1,
            text: Arc::clone(text),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_are_counted_in_characters() {
        let sources = Sources::new("a.toml", "x = 1\nµ = \"ü\" # z\n");
        let at = |start, end| {
            sources.locate(Place {
                source: 0,
                start,
                end,
            })
        };
        // The text of the second line begins at byte 6; µ takes two bytes.
        let value = at(11, 15);
        assert_eq!((value.line(), value.column()), (2, 5));
        assert_eq!(value.excerpt(), "\"ü\"");
        assert_eq!(value.to_string(), "a.toml:2:5");
        // Control characters are hidden without changing locations.
        let odd = Sources::new("a\u{1b}[1m.toml", "µ\u{9b}\u{1b} = 1\n");
        assert_eq!(odd.text(0), "µ\u{9b}\u{1b} = 1\n");
        let value = odd.locate(Place {
            source: 0,
            start: 8,
            end: 9,
        });
        assert_eq!((value.excerpt(), value.file()), ("1", "a [1m.toml"));
        assert_eq!(value.text().inner(), "µ¿  = 1\n");
        // Positions within a character, and beyond the end.
        assert_eq!(at(7, 8).column(), 1);
        assert_eq!(at(999, 1000).excerpt(), "");
        assert_eq!(at(999, 1000).line(), 3);
    }
}
