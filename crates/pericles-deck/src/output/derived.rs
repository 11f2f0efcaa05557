//! `[[output.quantity]]`: quantities derived from columns of the tables.

use pericles_deck_derive::DeckTable;
use serde::{Deserialize, Serialize};

use crate::expression::{FUNCTIONS, SignalExpression};
use crate::fault::Fault;
use crate::reader::Item;

/// Quantities derived from columns of the tables, such as a crack mouth opening: the columns of quantities.csv, with the
/// rows of the history. Any number of tables. Stop conditions, charts, sweeps and convergence studies refer to them by
/// name.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(unique("name", "quantity"))]
pub struct DerivedQuantity {
    /// The name, which is also the name of the column: a letter, then letters, digits and `_`.
    #[deck(with = name)]
    pub name: String,
    /// The value: an expression of columns of history.csv, probes.csv, reactions.csv and impactors.csv by their names
    /// without unit, of the tips of cracks `crack_1_tip_x` and `crack_1_advance`, of `time`, and of the quantities above
    /// it, such as "mouth_right.u_x - mouth_left.u_x". Dots may separate the probe, set or impactor from its component,
    /// and the word `probe`, `reaction` or `impactor` from both: `tip.u_x`, `reaction.top.y`. Names with other characters
    /// than letters, digits and `_` are written in single quotes. Values and numbers are in SI units, unless they have a unit
    /// in single quotes: "reaction.top.y / '10 mm2'".
    #[deck(with = expression)]
    pub expression: SignalExpression,
    /// Unit of the column. Default: the SI unit that follows from the expression; required if none follows.
    #[serde(default)]
    #[deck(with = unit)]
    pub unit: Option<String>,
}

/// Names that have another meaning in expressions or tables.
const RESERVED: [&str; 4] = ["e", "pi", "step", "time"];

fn expression<S>(item: &Item<'_>, _: S) -> Option<SignalExpression> {
    let text = item.text()?;
    match SignalExpression::parse(&text) {
        Ok(expression) => Some(expression),
        Err(malformed) => {
            item.report(Fault::BadExpression {
                text,
                reason: malformed.reason,
                allowed: SignalExpression::ALLOWED,
            });
            None
        }
    }
}

fn unit<S>(item: &Item<'_>, _: S) -> Option<String> {
    let unit = item.text()?;
    let wrong = |c: char| c.is_control() || matches!(c, '[' | ']' | ',' | '"');
    if unit.trim().is_empty() || unit.len() > 40 || unit.contains(wrong) {
        item.out_of_range("a unit such as \"N/m\" of at most 40 characters, without brackets, commas and quotation marks");
        return None;
    }
    Some(unit)
}

/// Reads a name of a column, which is also the name of a variable of expressions.
fn name<S>(item: &Item<'_>, _: S) -> Option<String> {
    let name = item.text()?;
    let usable = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
    let reason = if !begins || name.len() > 60 || !name.chars().all(usable) {
        "it is a variable of expressions"
    } else if RESERVED.contains(&name.as_str()) || FUNCTIONS.contains(&name.as_str()) {
        "it has another meaning in expressions"
    } else {
        return Some(name);
    };
    item.report(Fault::BadName {
        name,
        reason,
        allowed: "allowed: a letter, then at most 59 letters, digits and `_`; a name of its own for each \
                  quantity; not the name of a function, nor e, pi, step or time",
    });
    None
}
