//! `[[boundary]]`: ends through which waves leave.

use pericles::boundary::absorbing::Side;

use crate::reader::Table;

/// A boundary with memory.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum BoundaryCondition {
    /// An exact absorbing end of a bar.
    Absorbing {
        /// The end.
        side: Side,
        /// How its history is kept.
        history: HistoryForm,
    },
}

/// How the history of an absorbing end is kept.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum HistoryForm {
    /// By blocks with Fourier transforms: exact.
    Blocked,
    /// By direct sums: exact, and slow.
    Direct,
}

#[derive(Clone, Copy)]
enum Kind {
    Absorbing,
}

pub(crate) fn read(table: Table<'_>) -> Option<BoundaryCondition> {
    let kind = table
        .required("kind")
        .and_then(|item| item.choice("kind of boundary", &[("absorbing", Kind::Absorbing)]));
    let sides = [Side::Left, Side::Right].map(|side| (side.name(), side));
    let side = table
        .required("side")
        .and_then(|item| item.choice("side", &sides));
    let history = table.choice_or_first(
        "history",
        "history",
        &[
            ("blocked", HistoryForm::Blocked),
            ("direct", HistoryForm::Direct),
        ],
    );
    table.finish();
    let Kind::Absorbing = kind?;
    Some(BoundaryCondition::Absorbing {
        side: side?,
        history: history?,
    })
}
