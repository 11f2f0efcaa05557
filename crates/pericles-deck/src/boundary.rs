//! `[[boundary]]`: ends through which waves leave.

use pericles::boundary::absorbing::Side;

use crate::quantity::Quantity;
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
    /// By sums of exponentials: memory for any number of steps in a few numbers.
    Exponentials {
        /// Error of a ghost's displacement, relative to displacements.
        tolerance: f64,
    },
}

#[derive(Clone, Copy)]
enum Form {
    Blocked,
    Direct,
    Exponentials,
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
    let form = table.choice_or_first(
        "history",
        "history",
        &[
            ("blocked", Form::Blocked),
            ("direct", Form::Direct),
            ("exponentials", Form::Exponentials),
        ],
    );
    let history = match form {
        Some(Form::Exponentials) => {
            tolerance(&table).map(|tolerance| HistoryForm::Exponentials { tolerance })
        }
        other => {
            table.forbid(
                "tolerance",
                "a tolerance belongs to history = \"exponentials\"; the others are exact",
            );
            other.map(|form| match form {
                Form::Direct => HistoryForm::Direct,
                _ => HistoryForm::Blocked,
            })
        }
    };
    table.finish();
    let Kind::Absorbing = kind?;
    Some(BoundaryCondition::Absorbing {
        side: side?,
        history: history?,
    })
}

fn tolerance(table: &Table<'_>) -> Option<f64> {
    const TOLERANCE: f64 = 1e-9;
    table.or("tolerance", TOLERANCE, |item| {
        item.within(
            Quantity::Number,
            "a number above 1e-14 and below 1",
            |tolerance| tolerance > 1e-14 && tolerance < 1.0,
        )
    })
}
