//! Translation of an input file to tables of a deck.

mod body;
mod conditions;
mod material;
mod model;
mod output;
mod sets;
mod solver;

use std::path::PathBuf;

use crate::entry::Entry;
use crate::error::Fault;
use crate::table::Table;
use crate::units::Units;

/// The code that an input file is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Code {
    PeriLab,
    Peridigm,
}

/// Groups that are not translated, with the tables of a deck that have their content.
const TABLES: [(&str, &str); 3] = [
    (
        "Contact",
        "contact is described by [contact] and [[impactor]]",
    ),
    (
        "Thermal Models",
        "heat and thermal expansion are described by [thermal]",
    ),
    ("Restart", "checkpoints are automatic; see [checkpoint]"),
];

/// An input file.
#[derive(Debug)]
pub(crate) struct Source<'e> {
    pub(crate) code: Code,
    pub(crate) root: &'e Entry,
    pub(crate) units: Units,
    /// Folder of the input file, to which the paths in it are relative.
    pub(crate) folder: PathBuf,
    /// The same folder, relative to the deck.
    pub(crate) link: PathBuf,
}

/// Translates an input file.
pub(crate) fn tables(source: &Source<'_>) -> Result<Vec<Table>, Fault> {
    let solver = solver::Solver::read(source)?;
    let materials = material::Materials::read(source, &solver)?;
    let body = body::Body::read(source, &materials)?;
    let sets = sets::Sets::read(source, body.is_mesh())?;
    let conditions = conditions::tables(source, &body, &sets, &solver)?;
    let materials = materials.tables(&sets);
    let output = output::tables(source, &body)?;
    let models = source.root.find_any(&["Models", "Physics"]);
    for (group, reason) in TABLES {
        let groups = [Some(source.root), models].into_iter().flatten();
        for entry in groups.filter_map(|entry| entry.find(group)) {
            entry.refuse(reason);
        }
    }
    let all = [
        body.tables,
        sets.tables(),
        materials,
        conditions,
        vec![solver.table],
        output,
    ];
    Ok(all.into_iter().flatten().collect())
}

/// Returns the names in a text, separated by blanks or commas.
fn names(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| c == ',' || c.is_whitespace())
        .filter(|name| !name.is_empty())
}
