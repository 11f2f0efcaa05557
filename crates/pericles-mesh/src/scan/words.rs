//! Reading of words from text, with their lines.

use std::str::FromStr;

use crate::fault::Fault;

/// Word-by-word reader of a text.
pub(crate) struct Words<'a> {
    text: &'a [u8],
    at: usize,
    line: usize,
    /// Character that begins a comment up to the end of the line.
    comment: Option<u8>,
}

impl<'a> Words<'a> {
    pub(crate) fn new(text: &'a [u8], comment: Option<u8>) -> Self {
        Self {
            text,
            at: 0,
            line: 1,
            comment,
        }
    }

    /// Returns the line of the last word read.
    pub(crate) fn line(&self) -> usize {
        self.line
    }

    /// Returns the offset of the next byte.
    pub(crate) fn position(&self) -> usize {
        self.at
    }

    /// Continues at a later position.
    pub(crate) fn skip_to(&mut self, position: usize) {
        let position = position.min(self.text.len());
        self.line += count_lines(&self.text[self.at..position]);
        self.at = position;
    }

    pub(crate) fn fault(&self, reason: impl Into<String>) -> Fault {
        Fault::at_line(self.line, reason)
    }

    /// Returns the next word; `None` at the end.
    pub(crate) fn next(&mut self) -> Option<&'a str> {
        loop {
            let byte = *self.text.get(self.at)?;
            if Some(byte) == self.comment {
                self.skip_line();
            } else if byte.is_ascii_whitespace() {
                self.line += usize::from(byte == b'\n');
                self.at += 1;
            } else {
                break;
            }
        }
        let start = self.at;
        let ends = |byte: &u8| byte.is_ascii_whitespace() || Some(*byte) == self.comment;
        let length = self.text[start..].iter().position(ends);
        self.at = length.map_or(self.text.len(), |length| start + length);
        // Bytes that are not UTF-8 become a word that is neither a number nor a keyword.
        Some(std::str::from_utf8(&self.text[start..self.at]).unwrap_or("\u{fffd}"))
    }

    /// Returns the words up to the end of the line.
    pub(crate) fn rest_of_line(&mut self) -> impl Iterator<Item = &'a str> {
        let start = self.at;
        self.skip_line();
        let text = &self.text[start..self.at];
        std::str::from_utf8(text)
            .unwrap_or("\u{fffd}")
            .split_ascii_whitespace()
    }

    /// Skips to the end of the line.
    pub(crate) fn skip_line(&mut self) {
        let rest = &self.text[self.at..];
        self.at += rest
            .iter()
            .position(|&byte| byte == b'\n')
            .unwrap_or(rest.len());
    }

    /// Returns the next word or an error.
    pub(crate) fn word(&mut self, what: &str) -> Result<&'a str, Fault> {
        match self.next() {
            Some(word) => Ok(word),
            None => Err(self.fault(format!("unexpected end of file; expected {what}"))),
        }
    }

    /// Returns the next word as a number.
    pub(crate) fn number<T: FromStr>(&mut self, what: &str) -> Result<T, Fault> {
        let word = self.word(what)?;
        word.parse()
            .map_err(|_| self.fault(format!("{word:?} is not {what}")))
    }

    /// Reads three coordinates.
    pub(crate) fn point(&mut self) -> Result<[f64; 3], Fault> {
        let mut point = [0.0; 3];
        for x in &mut point {
            *x = self.number("a coordinate")?;
        }
        Ok(point)
    }

    /// Reads the number of items that follow, each with at least `words_each` words.
    pub(crate) fn count(&mut self, what: &str, words_each: usize) -> Result<usize, Fault> {
        let count: u64 = self.number(&format!("a number of {what}"))?;
        let left = self.text.len() - self.at;
        // A word takes at least a character and a space.
        let room = (left / (2 * words_each.max(1)) + 1) as u64;
        if count > room {
            return Err(self.fault(format!(
                "{count} {what} are declared, but the remaining {left} bytes hold at most {room}"
            )));
        }
        Ok(count as usize)
    }
}

fn count_lines(text: &[u8]) -> usize {
    text.iter().filter(|&&byte| byte == b'\n').count()
}
