//! What the tables of `[materials]` and `[[interface]]` take over from the first material, before a deck is read.
//!
//! The keys are copied into these tables, so that every table is read by itself and messages point to where a key was written.

use crate::document::{Entry, Node, Value};
use crate::vocabulary::{FAILURE_RULES, OWN_CONSTANTS, canonical, replaces};

/// Copies what is said of all bonds of a body into the tables of its materials, and how limits follow from a fracture energy into those and the interfaces.
///
/// It is taken from [material]. If that has constants of its own, it is the material of the body; otherwise [materials.default] is, or the first of [materials], and what it says of all bonds is taken as well.
pub(crate) fn inherit(root: &mut Node) {
    let Value::Table(entries) = &mut root.value else {
        return;
    };
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

/// Whether a rule of failure has a meaning in a table: with a fracture energy, and the definition of the critical stretch with the criterion it belongs to.
fn counts(own: &[Entry], rule: &Entry) -> bool {
    let has = |key: &str| own.iter().any(|entry| canonical(&entry.key) == key);
    has("fracture_energy") && (rule.key != "stretch_definition" || !has("failure"))
}

/// Adds entries of another table that are no constants of one material and that this one does not give itself.
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

/// The entries of a table of the deck.
fn table<'n>(entries: &'n mut [Entry], key: &str) -> Option<&'n mut Vec<Entry>> {
    let found = entries.iter_mut().find(|entry| entry.key == key)?;
    match &mut found.node.value {
        Value::Table(entries) => Some(entries),
        _ => None,
    }
}
