//! `[[step]]`: a run of several steps, each with its own scheme, conditions and output.
//!
//! A step is the deck with some tables replaced. The tables of the step take their places in the document before it is
//! read, so that every step is read as a deck of its own, and messages point to the table that was written.

use serde_json::{Map, Value as Json, json};

use crate::document::{Entry, Node, Value};
use crate::error::DeckError;
use crate::fault::Fault;
use crate::finding::Problem;
use crate::nearest::nearest;
use crate::source::{Place, Sources};

const STEP: &str = "step";
const NAME: &str = "name";

/// The tables that a step may replace: all that do not describe the body, whose state is handed over.
const TABLES: [&str; 14] = [
    "time",
    "initial",
    "constraint",
    "load",
    "boundary",
    "probe",
    "exact",
    "contact",
    "impactor",
    "thermal",
    "damping",
    "output",
    "checkpoint",
    "run",
];

/// Tables of the deck that belong to the first step only: they describe how the run starts.
const OF_FIRST: [&str; 3] = ["initial", "exact", "impactor"];

const DESCRIPTION: &str = "Steps of the run, one after another, each with its own tables; a table that a step does not \
have is that of the deck. Displacement, velocity, broken bonds, variables of softening and plastic flow and the temperature \
are handed over; time starts at zero in every step. `initial`, `exact` and `impactor` of the deck belong to the first step.";
const OF_NAME: &str =
    "Name of the step in the names of its results. Default: none; steps are numbered from 1.";

/// Returns the names of the steps, numbered if they have none; empty for a deck without steps.
pub(crate) fn names(root: &Node, sources: &Sources) -> Result<Vec<String>, DeckError> {
    let mut names: Vec<String> = Vec::new();
    for (k, step) in steps(root, sources)?.into_iter().enumerate() {
        let name = step.iter().find(|entry| entry.key == NAME);
        let text = match name.map(|entry| (&entry.node.value, entry.node.place)) {
            None => (k + 1).to_string(),
            Some((Value::Text(text), place)) => {
                let is_plain = |c: char| c.is_alphanumeric() || "-_".contains(c);
                if text.is_empty() || !text.chars().all(is_plain) {
                    let allowed = "allowed: letters, digits, - and _".into();
                    let value = format!("\"{text}\"");
                    return Err(problem(
                        Fault::OutOfRange { value, allowed },
                        place,
                        sources,
                    ));
                }
                format!("{}-{text}", k + 1)
            }
            Some((other, place)) => return Err(wrong_kind("a string", other, place, sources)),
        };
        names.push(text);
    }
    Ok(names)
}

/// Replaces the tables of the document by those of a step, and removes the steps.
///
/// # Errors
/// The steps are not tables, or have keys other than [`TABLES`] and `name`.
pub(crate) fn select(root: &mut Node, number: usize, sources: &Sources) -> Result<(), DeckError> {
    let chosen = steps(root, sources)?.get(number).map(|step| step.to_vec());
    let (Some(step), Value::Table(entries)) = (chosen, &mut root.value) else {
        return Ok(());
    };
    if let Some(unknown) = step
        .iter()
        .find(|entry| entry.key != NAME && !TABLES.contains(&entry.key.as_str()))
    {
        let allowed = std::iter::once(NAME).chain(TABLES);
        let fault = Fault::UnknownKey {
            key: unknown.key.clone(),
            table: format!("[[{STEP}]]"),
            nearest: nearest(&unknown.key, allowed.clone()).map(str::to_owned),
            home: None,
            allowed: allowed.map(str::to_owned).collect(),
        };
        return Err(problem(fault, unknown.key_place, sources));
    }
    let is_replaced = |entry: &Entry| step.iter().any(|own| own.key == entry.key);
    let is_past = |entry: &Entry| number > 0 && OF_FIRST.contains(&entry.key.as_str());
    entries.retain(|entry| entry.key != STEP && !is_replaced(entry) && !is_past(entry));
    entries.extend(step.into_iter().filter(|entry| entry.key != NAME));
    Ok(())
}

/// Returns the tables of the steps.
fn steps<'n>(root: &'n Node, sources: &Sources) -> Result<Vec<&'n [Entry]>, DeckError> {
    let Value::Table(entries) = &root.value else {
        return Ok(Vec::new());
    };
    let Some(entry) = entries.iter().find(|entry| entry.key == STEP) else {
        return Ok(Vec::new());
    };
    let Value::Array(items) = &entry.node.value else {
        return Err(wrong_kind(
            "a list of tables",
            &entry.node.value,
            entry.key_place,
            sources,
        ));
    };
    let table = |item: &'n Node| match &item.value {
        Value::Table(entries) => Ok(&entries[..]),
        other => Err(wrong_kind("a table", other, item.place, sources)),
    };
    items.iter().map(table).collect()
}

fn wrong_kind(expected: &'static str, found: &Value, place: Place, sources: &Sources) -> DeckError {
    let fault = Fault::WrongKind {
        value: sources.locate(place).excerpt().to_owned(),
        found: found.kind(),
        expected: expected.into(),
    };
    problem(fault, place, sources)
}

fn problem(fault: Fault, place: Place, sources: &Sources) -> DeckError {
    DeckError::rejected(vec![Problem::new(fault, sources.locate(place))])
}

/// Adds the steps to the JSON Schema of a deck.
pub(crate) fn add_to_schema(deck: &mut Map<String, Json>) {
    let Some(Json::Object(properties)) = deck.get_mut("properties") else {
        return;
    };
    let known = |table: &&str| Some(((*table).to_owned(), properties.get(*table)?.clone()));
    let mut tables: Map<String, Json> = TABLES.iter().filter_map(known).collect();
    tables.insert(
        NAME.into(),
        json!({ "type": "string", "description": OF_NAME }),
    );
    let step = json!({ "type": "object", "properties": tables, "additionalProperties": false });
    let steps = json!({ "type": "array", "items": step, "description": DESCRIPTION });
    properties.insert(STEP.into(), steps);
    // A required table may be in the steps instead.
    let Some(Json::Array(required)) = deck.get_mut("required") else {
        return;
    };
    let is_of_step = |key: &Json| TABLES.iter().any(|table| key == table);
    let (of_steps, of_deck) = required.drain(..).partition(is_of_step);
    *required = of_deck;
    let of_steps: Vec<Json> = of_steps;
    let either = json!([{ "required": of_steps }, { "required": [STEP] }]);
    deck.insert("anyOf".into(), either);
}

/// Returns the section of the reference.
pub(crate) fn reference() -> String {
    let tables: Vec<String> = (TABLES.iter()).map(|table| format!("`{table}`")).collect();
    format!(
        "\n## [[{STEP}]]\n\n{DESCRIPTION}\n\n| key | value | default | meaning |\n|---|---|---|---|\n\
         | `{NAME}` | text |  | {OF_NAME} |\n| {} | as in the deck |  | Replaces the table of the deck. |\n",
        tables.join(", ")
    )
}
