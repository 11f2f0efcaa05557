//! `[[output.quantity]]`: quantities derived from columns of the tables.

use serde::{Deserialize, Serialize};

use crate::expression::{FUNCTIONS, SignalExpression};
use crate::fault::Fault;
use crate::reader::{Item, Table};

/// A quantity derived from scalars of a run, a column of `quantities.csv`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DerivedQuantity {
    /// Name of the column.
    pub name: String,
    /// Its value.
    pub expression: SignalExpression,
    /// Its unit, if it does not follow from the expression.
    #[serde(default)]
    pub unit: Option<String>,
}

/// Names that have another meaning in expressions or tables.
const RESERVED: [&str; 4] = ["e", "pi", "step", "time"];

/// All quantities of a deck.
pub(super) fn read(tables: Vec<Table<'_>>) -> Option<Vec<DerivedQuantity>> {
    let mut names: Vec<String> = Vec::new();
    let quantities: Vec<Option<DerivedQuantity>> = tables
        .into_iter()
        .map(|table| quantity(table, &mut names))
        .collect();
    quantities.into_iter().collect()
}

fn quantity(table: Table<'_>, names: &mut Vec<String>) -> Option<DerivedQuantity> {
    let name = table.required("name").and_then(|item| name(&item, names));
    let expression = table
        .required("expression")
        .and_then(|item| expression(&item));
    let unit = table.maybe("unit", |item| unit(&item));
    table.finish();
    Some(DerivedQuantity {
        name: name?,
        expression: expression?,
        unit: unit?,
    })
}

fn expression(item: &Item<'_>) -> Option<SignalExpression> {
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

fn unit(item: &Item<'_>) -> Option<String> {
    let unit = item.text()?;
    let wrong = |c: char| c.is_control() || matches!(c, '[' | ']' | ',' | '"');
    if unit.trim().is_empty() || unit.len() > 40 || unit.contains(wrong) {
        item.out_of_range("a unit such as \"N/m\" of at most 40 characters, without brackets, commas and quotation marks");
        return None;
    }
    Some(unit)
}

/// A name that is the name of a column and of a variable of expressions.
fn name(item: &Item<'_>, names: &mut Vec<String>) -> Option<String> {
    let name = item.text()?;
    let usable = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
    let reason = if !begins || name.len() > 60 || !name.chars().all(usable) {
        Some("it is a variable of expressions")
    } else if RESERVED.contains(&name.as_str()) || FUNCTIONS.contains(&name.as_str()) {
        Some("it has another meaning in expressions")
    } else if names.contains(&name) {
        Some("another quantity has it")
    } else {
        None
    };
    names.push(name.clone());
    match reason {
        None => Some(name),
        Some(reason) => {
            item.report(Fault::BadName {
                name,
                reason,
                allowed: "allowed: a letter, then at most 59 letters, digits and `_`; a name of its own for each \
                          quantity; not the name of a function, nor e, pi, step or time",
            });
            None
        }
    }
}
