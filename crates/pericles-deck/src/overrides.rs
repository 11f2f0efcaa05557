//! `--set key=value`: changes to a deck before it is read.
//!
//! The key is a dotted path with indices from zero, such as `time.dt`, `crack.0.ends` or `load.0.traction`.
//! The value is TOML if it parses as TOML, otherwise a string. A key replaces its synonyms and mutually
//! exclusive keys: `material.K=…` replaces a deck's `youngs_modulus`. Missing tables are created. The value `unset`
//! removes the key, table or entry of a list.

use crate::document::{self, Entry, Node, Value};
use crate::error::DeckError;
use crate::fault::Fault;
use crate::finding::Problem;
use crate::source::{Place, Sources};
use crate::vocabulary::{canonical, replaces};

/// The value that removes a key. In quotes it is a text.
const UNSET: &str = "unset";

/// Larger than the nesting depth of any deck.
const DEEPEST: usize = 16;

/// Applies one override to the document.
pub(crate) fn apply(root: &mut Node, text: &str, sources: &mut Sources) -> Result<(), DeckError> {
    // Messages name the key to identify the override.
    let key = text.split('=').next().unwrap_or_default().trim();
    let source = sources.add(&format!("--set {key}"), text);
    set(root, text, source).map_err(|rejection| {
        let fault = Fault::BadOverride {
            text: text.into(),
            reason: rejection.reason,
            allowed: rejection.allowed,
        };
        let place = Place {
            source,
            start: rejection.start,
            end: rejection.end,
        };
        DeckError::rejected(vec![Problem::new(fault, sources.locate(place))])
    })
}

struct Rejection {
    reason: String,
    allowed: String,
    start: usize,
    end: usize,
}

fn set(root: &mut Node, text: &str, source: usize) -> Result<(), Rejection> {
    let whole = |reason: &str| Rejection {
        reason: reason.into(),
        allowed: "allowed: key=value with a dotted key, such as time.dt=auto or crack.0.ends=open"
            .into(),
        start: 0,
        end: text.len(),
    };
    let Some((path, written)) = text.split_once('=') else {
        return Err(whole("it has no `=`"));
    };
    let steps = steps(path);
    if steps.iter().any(|(step, _)| step.is_empty()) {
        return Err(whole("its key has an empty part"));
    }
    if steps.len() > DEEPEST {
        return Err(whole("its key has too many parts"));
    }
    if written.trim() == UNSET {
        return unset(root, &steps);
    }
    let new = value(written, source, path.len() + 1);
    let mut node = root;
    for (k, (step, start)) in steps.iter().enumerate() {
        let place = Place {
            source,
            start: *start,
            end: start + step.len(),
        };
        let last = k + 1 == steps.len();
        node = match &mut node.value {
            Value::Table(entries) => descend(entries, step, place, last),
            Value::Array(items) => {
                let index = index(items, step, *start)?;
                &mut items[index]
            }
            other => return Err(no_part(other, step, *start)),
        };
    }
    *node = new;
    Ok(())
}

/// Removes the key, table or entry of a list with these steps.
fn unset(root: &mut Node, steps: &[(&str, usize)]) -> Result<(), Rejection> {
    let mut node = root;
    for (k, &(step, start)) in steps.iter().enumerate() {
        let last = k + 1 == steps.len();
        node = match &mut node.value {
            Value::Table(entries) => {
                let known = |entry: &Entry| canonical(&entry.key) == canonical(step);
                let Some(found) = entries.iter().position(known) else {
                    let keys: Vec<String> =
                        (entries.iter().map(|entry| format!("`{}`", entry.key))).collect();
                    let table = match k {
                        0 => "the deck".into(),
                        _ => {
                            let above: Vec<&str> =
                                steps[..k].iter().map(|(step, _)| *step).collect();
                            format!("[{}]", above.join("."))
                        }
                    };
                    return Err(Rejection {
                        reason: format!("{table} does not set `{step}`"),
                        allowed: match keys.is_empty() {
                            true => "the table is empty".into(),
                            false => format!("keys that can be removed: {}", keys.join(", ")),
                        },
                        start,
                        end: start + step.len(),
                    });
                };
                if last {
                    entries.remove(found);
                    return Ok(());
                }
                &mut entries[found].node
            }
            Value::Array(items) => {
                let index = index(items, step, start)?;
                if last {
                    items.remove(index);
                    return Ok(());
                }
                &mut items[index]
            }
            other => return Err(no_part(other, step, start)),
        };
    }
    Ok(())
}

/// Returns the index of an entry of a list.
fn index(items: &[Node], step: &str, start: usize) -> Result<usize, Rejection> {
    let count = items.len();
    let index = step.parse::<usize>().ok().filter(|&index| index < count);
    index.ok_or_else(|| Rejection {
        reason: format!("`{step}` is not the index of an entry"),
        allowed: match count {
            0 => "the list is empty".into(),
            1 => "allowed: 0, the list has one entry".into(),
            _ => format!("allowed: 0 to {}", count - 1),
        },
        start,
        end: start + step.len(),
    })
}

/// Returns the rejection of a key within a value that has no keys.
fn no_part(value: &Value, step: &str, start: usize) -> Rejection {
    Rejection {
        reason: format!("`{step}` cannot be a key of {}", value.kind()),
        allowed: "only tables and lists have parts".into(),
        start,
        end: start + step.len(),
    }
}

/// Splits a dotted key into its parts with their offsets.
fn steps(path: &str) -> Vec<(&str, usize)> {
    let mut start = 0;
    path.split('.')
        .map(|part| {
            let leading = part.len() - part.trim_start().len();
            let at = start + leading;
            start += part.len() + 1;
            (part.trim(), at)
        })
        .collect()
}

fn value(written: &str, source: usize, offset: usize) -> Node {
    let leading = written.len() - written.trim_start().len();
    let trimmed = written.trim();
    let start = offset + leading;
    document::parse_value(trimmed, source, start).unwrap_or_else(|| Node {
        place: Place {
            source,
            start,
            end: start + trimmed.len(),
        },
        value: Value::Text(trimmed.into()),
    })
}

/// Returns the value of a key of a table, inserting it if it is missing.
fn descend<'n>(entries: &'n mut Vec<Entry>, name: &str, place: Place, last: bool) -> &'n mut Node {
    let known = entries
        .iter()
        .position(|entry| canonical(&entry.key) == canonical(name));
    if last {
        entries.retain(|entry| !replaces(name, &entry.key));
    } else if let Some(known) = known {
        return &mut entries[known].node;
    }
    let at = entries.len();
    entries.push(Entry {
        key: name.into(),
        key_place: place,
        node: Node {
            place,
            value: Value::Table(Vec::new()),
        },
    });
    &mut entries[at].node
}
