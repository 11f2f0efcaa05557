//! The `.pvd` collection, which assigns times to `.vtu` files.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use crate::xml::{escaped, unescaped};
use crate::{IoError, write_atomically};

const START: &str = "<?xml version=\"1.0\"?>\n\
                     <VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
const END: &str = "</Collection>\n</VTKFile>\n";

/// A series of outputs. The file is small and rewritten at every output, so that it can be opened during the run.
#[derive(Debug)]
pub struct PvdSeries {
    path: PathBuf,
    entries: Vec<String>,
}

impl PvdSeries {
    /// Creates an empty series, replacing an existing file.
    pub fn create(path: impl Into<PathBuf>) -> Result<Self, IoError> {
        let series = Self {
            path: path.into(),
            entries: Vec::new(),
        };
        series.write()?;
        Ok(series)
    }

    /// Reads the outputs of a series: times in seconds, and files relative to the folder of the `.pvd`.
    pub fn read(path: impl AsRef<Path>) -> Result<Vec<(f64, PathBuf)>, IoError> {
        let path = path.as_ref();
        let text = fs::read_to_string(path).map_err(|source| IoError::reading(path, source))?;
        let output = |element: &str| {
            let time = quoted(element, "timestep=\"")?.parse().ok()?;
            Some((time, unescaped(quoted(element, "file=\"")?).into()))
        };
        let entries = text
            .split('<')
            .filter(|entry| entry.starts_with("DataSet "));
        entries
            .map(|entry| {
                let reason = "an output has no time or no file";
                output(entry).ok_or_else(|| IoError::damaged(path, reason))
            })
            .collect()
    }

    /// Reopens a series written by Pericles to continue after its first `entries` outputs; later ones are
    /// dropped.
    pub fn reopen(path: impl Into<PathBuf>, entries: usize) -> Result<Self, IoError> {
        let path = path.into();
        let text = fs::read_to_string(&path).map_err(|source| IoError::reading(&path, source))?;
        let lines: Vec<_> = text
            .strip_prefix(START)
            .and_then(|rest| rest.strip_suffix(END))
            .ok_or_else(|| IoError::damaged(&path, "it is not a collection written by Pericles"))?
            .lines()
            .map(str::to_owned)
            .collect();
        if lines.len() < entries {
            let found = lines.len();
            let reason =
                format!("it lists {found} outputs, but the checkpoint expects at least {entries}");
            return Err(IoError::damaged(&path, reason));
        }
        let mut series = Self {
            path,
            entries: lines,
        };
        series.entries.truncate(entries);
        series.write()?;
        Ok(series)
    }

    /// Adds an output: its time in seconds and its file, relative to the folder of the `.pvd`.
    pub fn push(&mut self, time: f64, file: &str) -> Result<(), IoError> {
        if !time.is_finite() || file.chars().any(char::is_control) {
            return Err(IoError::Unsuitable {
                path: self.path.clone(),
                reason: format!(
                    "output {file:?} at time {time}; the time must be finite and the name must not contain line breaks"
                ),
            });
        }
        let file = escaped(file);
        self.entries.push(format!(
            "<DataSet timestep=\"{time:?}\" group=\"\" part=\"0\" file=\"{file}\"/>"
        ));
        self.write()
    }

    /// Returns the number of outputs.
    pub fn len(&self) -> usize {
        self.entries.len()
    }

    /// Returns whether there are no outputs.
    pub fn is_empty(&self) -> bool {
        self.entries.is_empty()
    }

    /// Returns the path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the usual name of the k-th output, relative to the `.pvd`: `fields/fields_000000.vtu`.
    pub fn field_file(index: usize) -> String {
        format!("fields/fields_{index:06}.vtu")
    }

    fn write(&self) -> Result<(), IoError> {
        write_atomically(&self.path, |out| {
            out.write_all(START.as_bytes())?;
            for entry in &self.entries {
                writeln!(out, "{entry}")?;
            }
            out.write_all(END.as_bytes())
        })
    }
}

/// Returns the text after `opening` up to the next quotation mark.
fn quoted<'a>(text: &'a str, opening: &str) -> Option<&'a str> {
    let (_, rest) = text.split_once(opening)?;
    Some(rest.split_once('"')?.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_resumed_series_equals_an_uninterrupted_one() {
        let folder = tempfile::tempdir().unwrap();
        let push = |series: &mut PvdSeries, range: std::ops::Range<usize>| {
            for k in range {
                let file = PvdSeries::field_file(k);
                series.push(k as f64 * 1e-7, &file).unwrap();
            }
        };
        let mut whole = PvdSeries::create(folder.path().join("a.pvd")).unwrap();
        push(&mut whole, 0..9);
        let mut parts = PvdSeries::create(folder.path().join("b.pvd")).unwrap();
        push(&mut parts, 0..6);
        let mut parts = PvdSeries::reopen(parts.path(), 4).unwrap();
        assert_eq!(parts.len(), 4);
        push(&mut parts, 4..9);
        let text = fs::read_to_string(parts.path()).unwrap();
        assert_eq!(text, fs::read_to_string(whole.path()).unwrap());
        assert!(text.contains("timestep=\"8e-7\""));
        assert!(text.contains("file=\"fields/fields_000008.vtu\""));
        assert_eq!(text.matches("<DataSet ").count(), 9);
        let outputs = PvdSeries::read(parts.path()).unwrap();
        let expected = |k: usize| (k as f64 * 1e-7, PvdSeries::field_file(k).into());
        assert_eq!(outputs, (0..9).map(expected).collect::<Vec<_>>());
    }

    #[test]
    fn a_series_that_is_too_short_or_from_another_program_is_rejected() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.pvd");
        let mut series = PvdSeries::create(&path).unwrap();
        series.push(0.0, "a.vtu").unwrap();
        let before = fs::read(&path).unwrap();
        let short = PvdSeries::reopen(&path, 2);
        assert!(matches!(short, Err(IoError::Damaged { .. })));
        assert_eq!(fs::read(&path).unwrap(), before);
        fs::write(&path, "<VTKFile/>").unwrap();
        assert!(matches!(
            PvdSeries::reopen(&path, 0),
            Err(IoError::Damaged { .. })
        ));
        assert!(series.push(f64::NAN, "b.vtu").is_err());
    }
}
