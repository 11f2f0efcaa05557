//! The tree of entries of an input file: values and groups with their lines, and a record of what has been read.

use std::cell::{Cell, RefCell};

use crate::error::Fault;

/// Deepest nesting of groups.
pub(crate) const DEEPEST: usize = 50;

/// A value or a group of entries. An entry that no translation reads is reported.
#[derive(Debug)]
pub(crate) struct Entry {
    key: String,
    /// Keys from the root, separated by slashes.
    path: String,
    line: usize,
    content: Content,
    is_read: Cell<bool>,
    refusal: RefCell<Option<String>>,
    changes: RefCell<Vec<String>>,
}

#[derive(Debug)]
enum Content {
    Value(String),
    Group(Vec<Entry>),
}

/// What became of an entry that has no exact translation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// Line in the input file.
    pub line: usize,
    /// Keys of the entry, separated by slashes.
    pub path: String,
    /// The value, for an entry with a value.
    pub value: Option<String>,
    /// Whether the deck contains a translation, with the difference that `reason` describes.
    pub is_translated: bool,
    /// Why the entry has no translation, or how the translation differs.
    pub reason: String,
}

impl Entry {
    pub(crate) fn value(key: &str, parent: &str, line: usize, text: &str) -> Self {
        Self::new(key, parent, line, Content::Value(text.trim().to_owned()))
    }

    pub(crate) fn group(key: &str, parent: &str, line: usize, entries: Vec<Self>) -> Self {
        Self::new(key, parent, line, Content::Group(entries))
    }

    fn new(key: &str, parent: &str, line: usize, content: Content) -> Self {
        Self {
            key: key.to_owned(),
            path: path_of(parent, key),
            line,
            content,
            is_read: Cell::new(false),
            refusal: RefCell::new(None),
            changes: RefCell::new(Vec::new()),
        }
    }

    pub(crate) fn key(&self) -> &str {
        &self.key
    }

    pub(crate) fn path(&self) -> &str {
        &self.path
    }

    pub(crate) fn line(&self) -> usize {
        self.line
    }

    /// Returns an error about this entry.
    pub(crate) fn fault(&self, reason: impl Into<String>) -> Fault {
        let reason = reason.into();
        Fault {
            line: self.line,
            reason: match self.path.as_str() {
                "" => reason,
                path => format!("{path}: {reason}"),
            },
        }
    }

    /// Returns whether this is a group with entries.
    pub(crate) fn is_group(&self) -> bool {
        matches!(&self.content, Content::Group(_))
    }

    /// Returns the entries of a group; an empty value is a group without entries.
    pub(crate) fn entries(&self) -> Result<&[Self], Fault> {
        match &self.content {
            Content::Group(entries) => Ok(entries),
            Content::Value(text) if text.is_empty() => Ok(&[]),
            Content::Value(text) => {
                Err(self.fault(format!("`{text}` is a value; expected: a group of entries")))
            }
        }
    }

    /// Returns the entry with a key; capitals do not matter, and `_` counts as a blank. A value has no entries.
    pub(crate) fn find(&self, key: &str) -> Option<&Self> {
        let Content::Group(entries) = &self.content else {
            return None;
        };
        entries.iter().find(|entry| is_same(&entry.key, key))
    }

    /// Returns the first of several entries.
    pub(crate) fn find_any(&self, keys: &[&str]) -> Option<&Self> {
        keys.iter().find_map(|key| self.find(key))
    }

    /// Returns the first of several entries; one of them is needed.
    pub(crate) fn need(&self, keys: &[&str]) -> Result<&Self, Fault> {
        self.find_any(keys).ok_or_else(|| {
            let keys: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
            self.fault(format!("the entry {} is missing", keys.join(" or ")))
        })
    }

    /// Returns the text of a value and records that it has been read.
    pub(crate) fn text(&self) -> Result<&str, Fault> {
        self.is_read.set(true);
        match &self.content {
            Content::Value(text) => Ok(text),
            Content::Group(_) => Err(self.fault("this is a group of entries; expected: a value")),
        }
    }

    pub(crate) fn number(&self) -> Result<f64, Fault> {
        let text = self.text()?;
        let number = text.parse().ok().filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| self.fault(format!("`{text}` is not a number")))
    }

    pub(crate) fn positive(&self) -> Result<f64, Fault> {
        match self.number()? {
            number if number > 0.0 => Ok(number),
            number => Err(self.fault(format!("`{number}`; allowed: a positive number"))),
        }
    }

    pub(crate) fn count(&self) -> Result<usize, Fault> {
        self.count_in(self.text()?)
    }

    /// Returns the first of several whole numbers.
    pub(crate) fn first_count(&self) -> Result<usize, Fault> {
        self.count_in(self.text()?.split_whitespace().next().unwrap_or_default())
    }

    fn count_in(&self, text: &str) -> Result<usize, Fault> {
        let count = text.parse().ok().filter(|count| *count > 0);
        count.ok_or_else(|| self.fault(format!("`{text}` is not a whole number above 0")))
    }

    pub(crate) fn flag(&self) -> Result<bool, Fault> {
        let text = self.text()?;
        match text.to_ascii_lowercase().as_str() {
            "true" | "yes" | "on" => Ok(true),
            "false" | "no" | "off" => Ok(false),
            _ => Err(self.fault(format!("`{text}`; allowed: true or false"))),
        }
    }

    /// Returns the number with a key, if there is one.
    pub(crate) fn number_of(&self, keys: &[&str]) -> Result<Option<f64>, Fault> {
        self.find_any(keys).map(Self::number).transpose()
    }

    /// Returns whether the flag with a key is set.
    pub(crate) fn is_set(&self, key: &str) -> Result<bool, Fault> {
        self.find(key).map_or(Ok(false), Self::flag)
    }

    /// Records that the entry, with all entries below it, has no translation.
    pub(crate) fn refuse(&self, reason: impl Into<String>) {
        self.refusal.borrow_mut().get_or_insert(reason.into());
    }

    /// Records a difference between the entry and its translation.
    pub(crate) fn differ(&self, reason: impl Into<String>) {
        let reason = reason.into();
        let mut changes = self.changes.borrow_mut();
        if !changes.contains(&reason) {
            changes.push(reason);
        }
    }

    /// Returns whether the entry or one below it has been read.
    fn is_touched(&self) -> bool {
        let below = match &self.content {
            Content::Group(entries) => entries.iter().any(Self::is_touched),
            Content::Value(_) => false,
        };
        below || self.is_read.get() || self.refusal.borrow().is_some()
    }

    /// Adds remarks about this entry and those below it, in the order of the file.
    pub(crate) fn remarks(&self, remarks: &mut Vec<Remark>) {
        let value = match &self.content {
            Content::Value(text) => Some(text.clone()),
            Content::Group(_) => None,
        };
        let remark = |is_translated, reason: &str| Remark {
            line: self.line,
            path: self.path.clone(),
            value: value.clone(),
            is_translated,
            reason: reason.to_owned(),
        };
        if let Some(reason) = &*self.refusal.borrow() {
            remarks.push(remark(false, reason));
            return;
        }
        if !self.is_touched() {
            remarks.push(remark(false, "this command has no translation for it"));
            return;
        }
        remarks.extend(
            self.changes
                .borrow()
                .iter()
                .map(|change| remark(true, change)),
        );
        if let Content::Group(entries) = &self.content {
            for entry in entries {
                entry.remarks(remarks);
            }
        }
    }
}

/// Returns the path of an entry of a group.
pub(crate) fn path_of(parent: &str, key: &str) -> String {
    if parent.is_empty() {
        key.to_owned()
    } else {
        format!("{parent}/{key}")
    }
}

/// Returns whether two keys or names are the same: capitals do not matter, and `_` counts as a blank.
pub(crate) fn is_same(a: &str, b: &str) -> bool {
    let plain = |text: &str| text.trim().to_lowercase().replace('_', " ");
    plain(a) == plain(b)
}
