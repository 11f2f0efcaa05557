//! Words of a text, with their lines.

use std::str::FromStr;

use crate::fault::Fault;

/// A text read word by word.
pub(crate) struct Words<'a> {
    text: &'a [u8],
    at: usize,
    line: usize,
    /// From here to the end of its line, text is a comment.
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

    /// The line of what was read last.
    pub(crate) fn line(&self) -> usize {
        self.line
    }

    /// Where the next byte is.
    pub(crate) fn position(&self) -> usize {
        self.at
    }

    /// Goes on elsewhere further on.
    pub(crate) fn skip_to(&mut self, position: usize) {
        let position = position.min(self.text.len());
        self.line += count_lines(&self.text[self.at..position]);
        self.at = position;
    }

    pub(crate) fn fault(&self, reason: impl Into<String>) -> Fault {
        Fault::at_line(self.line, reason)
    }

    /// The next word; none at the end.
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
        // What is no text becomes a word that is no number and no key.
        Some(std::str::from_utf8(&self.text[start..self.at]).unwrap_or("\u{fffd}"))
    }

    /// The words up to the end of the line.
    pub(crate) fn rest_of_line(&mut self) -> impl Iterator<Item = &'a str> {
        let start = self.at;
        self.skip_line();
        let text = &self.text[start..self.at];
        std::str::from_utf8(text)
            .unwrap_or("\u{fffd}")
            .split_ascii_whitespace()
    }

    /// Goes to the end of the line.
    pub(crate) fn skip_line(&mut self) {
        let rest = &self.text[self.at..];
        self.at += rest
            .iter()
            .position(|&byte| byte == b'\n')
            .unwrap_or(rest.len());
    }

    /// The next word, which must be there.
    pub(crate) fn word(&mut self, what: &str) -> Result<&'a str, Fault> {
        match self.next() {
            Some(word) => Ok(word),
            None => Err(self.fault(format!("the file ends where {what} should follow"))),
        }
    }

    /// The next word as a number.
    pub(crate) fn number<T: FromStr>(&mut self, what: &str) -> Result<T, Fault> {
        let word = self.word(what)?;
        word.parse()
            .map_err(|_| self.fault(format!("{word:?} is not {what}")))
    }

    /// Three coordinates.
    pub(crate) fn point(&mut self) -> Result<[f64; 3], Fault> {
        let mut point = [0.0; 3];
        for x in &mut point {
            *x = self.number("a coordinate")?;
        }
        Ok(point)
    }

    /// A number of things to follow, each of at least so many words.
    pub(crate) fn count(&mut self, what: &str, words_each: usize) -> Result<usize, Fault> {
        let count: u64 = self.number(&format!("a number of {what}"))?;
        let left = self.text.len() - self.at;
        // A word is a character and a space.
        let room = (left / (2 * words_each.max(1)) + 1) as u64;
        if count > room {
            return Err(self.fault(format!(
                "{count} {what} are announced, but the {left} bytes left hold {room} at most"
            )));
        }
        Ok(count as usize)
    }
}

fn count_lines(text: &[u8]) -> usize {
    text.iter().filter(|&&byte| byte == b'\n').count()
}
