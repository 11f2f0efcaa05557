//! Import of input files of PeriLab (YAML) and Peridigm (its own text format, YAML, XML) as decks of Pericles.
//!
//! [`import`] reads the file to a tree of entries (module `entry`), which records the entries that the translation
//! reads. The module `translate` makes the tables of the deck from it. Entries that have not been read, that have no counterpart or
//! whose translation differs are [`Remark`]s; nothing is omitted silently.
//!
//! The input files have no units; [`Units`] states in which units their numbers are. Volumes of bodies in the plane are area times
//! thickness, which is one unless the file gives it.

mod entry;
mod error;
mod expression;
mod plain;
mod table;
mod translate;
mod units;
mod xml;
mod yaml;

use std::fs;
use std::path::Path;

use entry::Entry;
use error::Fault;
use table::comment;
use translate::{Code, Source};

pub use entry::Remark;
pub use error::ImportError;
pub use units::Units;

/// A deck made from an input file.
#[derive(Debug)]
pub struct Imported {
    /// The text of the deck, with comments.
    pub deck: String,
    /// Entries without exact translation, in the order of the input file.
    pub remarks: Vec<Remark>,
}

/// Imports an input file, whose numbers are in `units`, as a deck in the folder `to`; paths in the deck are relative to it.
///
/// # Errors
/// The file cannot be read, is not an input file of PeriLab or Peridigm, or has an error such as a missing block, an
/// unknown material model or a text in place of a number.
pub fn import(file: &Path, to: &Path, units: &Units) -> Result<Imported, ImportError> {
    let text = fs::read_to_string(file).map_err(|reason| ImportError::Unreadable {
        path: file.into(),
        reason,
    })?;
    let folder = file.parent().unwrap_or(Path::new(""));
    let link = link(folder, to);
    imported(file, &text, folder, &link, units).map_err(|fault| ImportError::Invalid {
        path: file.into(),
        line: fault.line,
        reason: fault.reason,
    })
}

fn imported(
    file: &Path,
    text: &str,
    folder: &Path,
    link: &Path,
    units: &Units,
) -> Result<Imported, Fault> {
    let tree = if text.trim_start().starts_with('<') {
        xml::read(text)?
    } else if plain::is_plain(text) {
        plain::read(text)?
    } else {
        yaml::read(text)?
    };
    let (code, root) = root(&tree)?;
    let source = Source {
        code,
        root,
        units: units.clone(),
        folder: folder.into(),
        link: link.into(),
    };
    let tables = translate::tables(&source)?;
    let mut remarks = Vec::new();
    tree.remarks(&mut remarks);
    let mut deck = head(file, code, units, &remarks);
    let title = file.file_stem().unwrap_or_default().to_string_lossy();
    deck += &format!("\ntitle = {}\n", table::text(&title));
    for table in &tables {
        table.write(&mut deck);
    }
    Ok(Imported { deck, remarks })
}

/// Returns the code of an input file and its entries.
fn root(tree: &Entry) -> Result<(Code, &Entry), Fault> {
    if let Some(root) = tree.find("PeriLab") {
        return Ok((Code::PeriLab, root));
    }
    // XML files and text files have no key of their own.
    let root = tree.find("Peridigm").unwrap_or(tree);
    if root.find("Blocks").is_none() && root.find("Discretization").is_none() {
        return Err(Fault {
            line: tree.line(),
            reason: "this is no input file of PeriLab (a group `PeriLab`) or Peridigm (a group `Peridigm`, an XML parameter list, or text) with `Blocks` and `Discretization`".into(),
        });
    }
    Ok((Code::Peridigm, root))
}

/// The comments at the head of a deck.
fn head(file: &Path, code: Code, units: &Units, remarks: &[Remark]) -> String {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let code = match code {
        Code::PeriLab => "PeriLab",
        Code::Peridigm => "Peridigm",
    };
    let mut head = comment(&format!("{name} ({code}), imported by `pericles import`."));
    head += &comment(&match units.names() {
        Some(names) => format!("The input file has no units; its numbers are in units of {names} and have been converted."),
        None => "The input file has no units: its numbers are SI units here. Option --units converts other units.".to_owned(),
    });
    head += &comment("Each table names the entries from which it comes.");
    for (is_translated, title) in [
        (true, "Translations that differ:"),
        (false, "Not translated:"),
    ] {
        let mut lines = remarks
            .iter()
            .filter(|remark| remark.is_translated == is_translated)
            .peekable();
        if lines.peek().is_some() {
            head += "#\n";
            head += &comment(title);
        }
        for remark in lines {
            head += &comment(&format!("  line {}: {}", remark.line, remark.text()));
        }
    }
    head
}

impl Remark {
    /// Returns the entry, with its value, and the reason.
    pub fn text(&self) -> String {
        let value = self.value.as_ref().map(|value| format!(" = {value}"));
        format!(
            "{}{}: {}",
            self.path,
            value.unwrap_or_default(),
            self.reason
        )
    }
}

/// Returns the path of a folder relative to another one, or its full path if it is not inside it.
fn link(folder: &Path, from: &Path) -> std::path::PathBuf {
    let full = |path: &Path| {
        let path = if path.as_os_str().is_empty() {
            Path::new(".")
        } else {
            path
        };
        fs::canonicalize(path).unwrap_or_else(|_| path.into())
    };
    let (folder, from) = (full(folder), full(from));
    folder
        .strip_prefix(&from)
        .map_or_else(|_| folder.clone(), Into::into)
}
