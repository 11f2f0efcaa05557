//! Keyword lines and data lines.

use crate::fault::Fault;

/// A name, compared case-insensitively unless it was quoted.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct Name {
    key: String,
}

impl Name {
    /// Returns the name in a word of the file, and its displayed form.
    pub(super) fn of(word: &str) -> (Self, String) {
        let word = word.trim();
        let quoted = word
            .strip_prefix('"')
            .and_then(|word| word.strip_suffix('"'));
        match quoted {
            Some(inside) => (
                Self {
                    key: inside.to_owned(),
                },
                inside.to_owned(),
            ),
            None => (
                Self {
                    key: word.to_uppercase(),
                },
                word.to_owned(),
            ),
        }
    }

    /// Splits `instance.number` into instance and number.
    pub(super) fn numbered(&self) -> Option<(Self, i64)> {
        let (instance, number) = self.key.rsplit_once('.')?;
        let key = instance.trim_matches('"').to_owned();
        Some((Self { key }, number.trim().parse().ok()?))
    }

    /// Returns the compared form, for messages.
    pub(super) fn key(&self) -> &str {
        &self.key
    }

    /// Splits `instance.set` into instance and set.
    pub(super) fn parts(&self) -> Option<(Self, Self)> {
        let (instance, set) = self.key.split_once('.')?;
        let name = |key: &str| Self {
            key: key.trim_matches('"').to_owned(),
        };
        Some((name(instance), name(set)))
    }
}

/// `*KEY, PARAMETER=VALUE, PARAMETER`.
#[derive(Debug)]
pub(super) struct Keyword {
    /// In upper case, words separated by one blank.
    pub(super) key: String,
    parameters: Vec<(String, Option<String>)>,
}

impl Keyword {
    /// Parses the keyword of a line, without its star.
    pub(super) fn of(text: &str) -> Self {
        let mut words = text.split(',');
        let upper = |word: &str| {
            let words: Vec<&str> = word.split_whitespace().collect();
            words.join(" ").to_uppercase()
        };
        let key = upper(words.next().unwrap_or_default());
        let parameters = words
            .filter(|word| !word.trim().is_empty())
            .map(|word| match word.split_once('=') {
                Some((name, value)) => (upper(name), Some(value.trim().to_owned())),
                None => (upper(word), None),
            })
            .collect();
        Self { key, parameters }
    }

    pub(super) fn has(&self, name: &str) -> bool {
        self.parameters.iter().any(|(given, _)| given == name)
    }

    pub(super) fn value(&self, name: &str) -> Option<&str> {
        let found = self.parameters.iter().find(|(given, _)| given == name);
        found?.1.as_deref()
    }

    /// Returns the value of a required parameter.
    pub(super) fn needed(&self, name: &str, line: usize) -> Result<&str, Fault> {
        self.value(name).ok_or_else(|| {
            let key = &self.key;
            Fault::at_line(line, format!("*{key} has no {name}, which is required"))
        })
    }
}

/// Returns the words of a data line.
pub(super) fn words(text: &str) -> impl Iterator<Item = &str> {
    let text = text.trim();
    let text = text.strip_suffix(',').unwrap_or(text);
    text.split(',').map(str::trim)
}

/// Parses a number with a Fortran or C exponent.
pub(super) fn real(word: &str, line: usize) -> Result<f64, Fault> {
    let number = match word.contains(['d', 'D']) {
        true => word.replace(['d', 'D'], "e").parse(),
        false => word.parse(),
    };
    number.map_err(|_| Fault::at_line(line, format!("{word:?} is not a number")))
}

/// Parses the number of a node or an element.
pub(super) fn whole(word: &str, line: usize) -> Result<i64, Fault> {
    word.parse()
        .map_err(|_| Fault::at_line(line, format!("{word:?} is not a whole number")))
}
