//! Keys that `[materials]` and `[[interface]]` inherit from the first material, and `[[body.piece]]` from `[body]`.
//!
//! The keys are copied into these tables before a deck is read, so that every table is read by itself and
//! messages point to the original key.

use crate::document::{Entry, Node, Value};
use crate::vocabulary::{BY_STATE, FAILURE_RULES, OWN_CONSTANTS, canonical, replaces};

/// Copies the keys shared by all bonds into the tables of materials, and failure rules into those of
/// materials and interfaces.
///
/// The keys come from `[material]`. If it has constants of its own, it is the body's material; otherwise
/// `[materials.default]` or the first of `[materials]` is, and its shared keys are copied as well.
pub(crate) fn inherit(root: &mut Node) {
    let Value::Table(entries) = &mut root.value else {
        return;
    };
    if let Some(body) = table(entries, "body") {
        inherit_in_pieces(body);
    }
    let given = match table(entries, "material") {
        Some(given) => given.clone(),
        None => Vec::new(),
    };
    let Some(materials) = table(entries, "materials").filter(|named| !named.is_empty()) else {
        return;
    };
    let mut shared = given;
    if !shared.iter().any(|entry| is_one_of(OWN_CONSTANTS, entry)) {
        let by_name = materials.iter().position(|entry| entry.key == "default");
        if let Value::Table(own) = &mut materials[by_name.unwrap_or(0)].node.value {
            take_over(own, &shared, |_, _| true);
            shared.clone_from(own);
        }
    }
    for material in materials {
        if let Value::Table(own) = &mut material.node.value {
            take_over(own, &shared, |own, entry| {
                !is_one_of(FAILURE_RULES, entry) || counts(own, entry)
            });
        }
    }
    let interfaces = entries.iter_mut().find(|entry| entry.key == "interface");
    if let Some(Value::Array(interfaces)) = interfaces.map(|entry| &mut entry.node.value) {
        for interface in interfaces {
            if let Value::Table(own) = &mut interface.value {
                take_over(own, &shared, |own, entry| {
                    is_one_of(FAILURE_RULES, entry) && counts(own, entry)
                });
            }
        }
    }
}

/// Copies the keys shared by all pieces of a body into the tables of its pieces.
fn inherit_in_pieces(body: &mut [Entry]) {
    const SHARED: [&str; 4] = ["spacing", "thickness", "area", "plane"];
    let shared = body.iter().filter(|entry| is_one_of(&SHARED, entry));
    let shared: Vec<Entry> = shared.cloned().collect();
    let pieces = body.iter_mut().find(|entry| entry.key == "piece");
    let Some(Value::Array(pieces)) = pieces.map(|entry| &mut entry.node.value) else {
        return;
    };
    for piece in pieces {
        if let Value::Table(own) = &mut piece.value {
            let is_mesh = own.iter().any(|entry| {
                entry.key == "shape"
                    && matches!(&entry.node.value, Value::Text(shape) if shape == "mesh")
            });
            // The spacing of a mesh follows from its elements.
            take_over(own, &shared, |_, entry| {
                !is_mesh || canonical(&entry.key) != "spacing"
            });
        }
    }
}

/// Returns whether a failure rule applies to a table: it needs the key that the criterion requires, a fracture energy
/// or the key of [`BY_STATE`]; `stretch_definition` also its failure criterion.
fn counts(own: &[Entry], rule: &Entry) -> bool {
    let has = |key: &str| own.iter().any(|entry| canonical(&entry.key) == key);
    let by_state = BY_STATE.iter().find(|(word, _)| {
        rule.key == "failure" && matches!(&rule.node.value, Value::Text(text) if text == word)
    });
    match by_state {
        Some((_, required)) => has(required),
        None => has("fracture_energy") && (rule.key != "stretch_definition" || !has("failure")),
    }
}

/// Adds entries of another table, except for constants of one material and keys that the table already has.
fn take_over(own: &mut Vec<Entry>, from: &[Entry], wanted: impl Fn(&[Entry], &Entry) -> bool) {
    let missing = from.iter().filter(|entry| {
        let given = own.iter().any(|one| replaces(&one.key, &entry.key));
        !given && !is_one_of(OWN_CONSTANTS, entry) && wanted(own, entry)
    });
    let missing: Vec<Entry> = missing.cloned().collect();
    own.extend(missing);
}

fn is_one_of(keys: &[&str], entry: &Entry) -> bool {
    keys.contains(&canonical(&entry.key))
}

/// Returns the entries of a table of the deck.
fn table<'n>(entries: &'n mut [Entry], key: &str) -> Option<&'n mut Vec<Entry>> {
    let found = entries.iter_mut().find(|entry| entry.key == key)?;
    match &mut found.node.value {
        Value::Table(entries) => Some(entries),
        _ => None,
    }
}
