//! `[output] fields`: when fields are written, which, and in which formats.

use pericles::observe::{Field, Schedule};
use serde::{Deserialize, Serialize};

use super::{is_never, names, schedule};
use crate::reader::Table;

/// A format of fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FieldFormat {
    /// A VTU file for each output, and a PVD file that lists them.
    Vtu,
    /// One Exodus II file.
    Exodus,
    /// One VTKHDF file.
    Vtkhdf,
}

impl FieldFormat {
    /// The formats that are written unless others are asked for.
    pub(super) fn usual() -> Vec<Self> {
        vec![Self::Vtu]
    }
}

/// What the blocks of a file with blocks are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FieldBlocks {
    /// The groups of a mesh, or the blocks of listed points.
    #[default]
    Groups,
    /// The materials of the points.
    Materials,
}

/// `[output] fields`.
pub(super) struct Fields {
    pub(super) schedule: Schedule,
    pub(super) names: Vec<Field>,
    pub(super) formats: Vec<FieldFormat>,
    pub(super) cells: bool,
    pub(super) blocks: FieldBlocks,
}

/// When field files are written, which fields, and how.
pub(super) fn fields(
    table: &Table<'_>,
    dimension: Option<usize>,
    usual: Vec<Field>,
    mesh: bool,
) -> Option<Fields> {
    if is_never(table, "fields") {
        return Some(Fields {
            schedule: Schedule::Never,
            names: usual,
            formats: FieldFormat::usual(),
            cells: false,
            blocks: FieldBlocks::Groups,
        });
    }
    let table = table.table_or_empty("fields")?;
    let schedule = schedule(&table, Schedule::Count(20));
    let names = match table.optional("names") {
        None => Some(usual),
        Some(item) => names(&item, dimension),
    };
    let formats = formats(&table);
    let cells = if mesh {
        table.or("cells", false, |item| item.boolean())
    } else {
        table.forbid(
            "cells",
            "only a mesh (shape = \"mesh\") has cells of its own",
        );
        Some(false)
    };
    let blocks = table.choice_or_first(
        "blocks",
        "choice of blocks",
        &[
            ("groups", FieldBlocks::Groups),
            ("materials", FieldBlocks::Materials),
        ],
    );
    table.finish();
    Some(Fields {
        schedule: schedule?,
        names: names?,
        formats: formats?,
        cells: cells?,
        blocks: blocks?,
    })
}

/// A format, or a list of formats.
fn formats(table: &Table<'_>) -> Option<Vec<FieldFormat>> {
    const WORDS: [(&str, FieldFormat); 3] = [
        ("vtu", FieldFormat::Vtu),
        ("exodus", FieldFormat::Exodus),
        ("vtkhdf", FieldFormat::Vtkhdf),
    ];
    let Some(item) = table.optional("format") else {
        table.record("format", WORDS[0].0);
        return Some(FieldFormat::usual());
    };
    if !item.is_list() {
        return Some(vec![item.choice("format", &WORDS)?]);
    }
    let items = item.list("a list of formats")?;
    if items.is_empty() {
        item.wrong_length("at least one format; fields = \"never\" writes none");
        return None;
    }
    let mut formats = Vec::new();
    for item in &items {
        let format = item.choice("format", &WORDS)?;
        if formats.contains(&format) {
            item.out_of_range("each format once");
            return None;
        }
        formats.push(format);
    }
    Some(formats)
}
