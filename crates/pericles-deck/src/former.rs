//! Deprecated tables, replaced by their present form before a deck is read.
//!
//! | deprecated | present |
//! |---|---|
//! | `[[material.part]]` with `name`, `set` | `[materials.NAME]`, `[[assign]]` with `set`, `material` |
//! | `[[material.part]]` with `block` | the same, with a set of the block |
//! | `[[material.inclusion]]` | `[[assign]]` with `set`, `stiffness` |
//! | `[material.interface]` with `rule`, `pair` | `[[interface]]` without and with `between` |
//!
//! The new tables keep their locations in the text. Tables of another form are left unchanged and refused by
//! the reader.

use crate::document::{Entry, Node, Value};
use crate::source::{Place, Sources};

/// The deprecated tables of a deck.
#[derive(Debug, Clone)]
pub(crate) struct Former {
    /// Location of the first one.
    pub(crate) place: Place,
    /// Their headings.
    pub(crate) tables: Vec<&'static str>,
    /// The equivalent present tables, as text.
    pub(crate) text: String,
}

/// Replaces the deprecated tables of a deck; none if it has none.
pub(crate) fn rewrite(root: &mut Node, sources: &Sources) -> Option<Former> {
    let Value::Table(entries) = &mut root.value else {
        return None;
    };
    let material = entries.iter_mut().find(|entry| entry.key == "material")?;
    let Value::Table(keys) = &mut material.node.value else {
        return None;
    };
    let mut found = Rewritten::default();
    let mut former = Vec::new();
    for (key, written, rewrite) in FORMER {
        let Some(at) = keys.iter().position(|entry| entry.key == *key) else {
            continue;
        };
        if rewrite(&keys[at].node, &mut found).is_some() {
            former.push((keys[at].key_place, *written));
            keys.remove(at);
        }
    }
    former.sort_by_key(|(place, _)| (place.source, place.start));
    let (place, _) = *former.first()?;
    let text = found.text(sources);
    found.add_to(entries);
    Some(Former {
        place,
        tables: former.into_iter().map(|(_, written)| written).collect(),
        text,
    })
}

type Rewrite = fn(&Node, &mut Rewritten) -> Option<()>;

const FORMER: &[(&str, &str, Rewrite)] = &[
    ("part", "[[material.part]]", parts),
    ("inclusion", "[[material.inclusion]]", inclusions),
    ("interface", "[material.interface]", interface),
];

/// Tables in the present form.
#[derive(Default)]
struct Rewritten {
    sets: Vec<Entry>,
    materials: Vec<Entry>,
    assign: Vec<Node>,
    interface: Vec<Node>,
}

/// Converts `[[material.part]]`; none if a table has another form.
fn parts(node: &Node, rewritten: &mut Rewritten) -> Option<()> {
    let mut made = Rewritten::default();
    for part in tables(node)? {
        let entry = |key: &str| part.entries.iter().find(|entry| entry.key == key);
        let name = entry("name")?;
        let Value::Text(text) = &name.node.value else {
            return None;
        };
        if made.materials.iter().any(|known| known.key == *text) {
            return None;
        }
        let set = match (entry("set"), entry("block")) {
            (Some(set), None) => set.clone(),
            (None, Some(block)) => made.set_of(block),
            _ => return None,
        };
        let constants = part.entries.iter();
        let constants =
            constants.filter(|entry| !["name", "set", "block"].contains(&entry.key.as_str()));
        made.materials.push(Entry {
            key: text.clone(),
            key_place: name.node.place,
            node: part.with(constants.cloned().collect()),
        });
        let material = Entry {
            key: "material".into(),
            ..name.clone()
        };
        made.assign.push(part.with(vec![set, material]));
    }
    rewritten.sets.append(&mut made.sets);
    rewritten.materials.append(&mut made.materials);
    rewritten.assign.append(&mut made.assign);
    Some(())
}

fn inclusions(node: &Node, rewritten: &mut Rewritten) -> Option<()> {
    tables(node)?;
    let Value::Array(inclusions) = &node.value else {
        return None;
    };
    rewritten.assign.extend(inclusions.iter().cloned());
    Some(())
}

fn interface(node: &Node, rewritten: &mut Rewritten) -> Option<()> {
    let Value::Table(entries) = &node.value else {
        return None;
    };
    let mut made = Vec::new();
    for entry in entries {
        match entry.key.as_str() {
            "rule" => made.push(Node {
                place: entry.node.place,
                value: Value::Table(vec![entry.clone()]),
            }),
            "pair" => {
                tables(&entry.node)?;
                if let Value::Array(pairs) = &entry.node.value {
                    made.extend(pairs.iter().cloned());
                }
            }
            _ => return None,
        }
    }
    rewritten.interface.append(&mut made);
    Some(())
}

/// An entry of a list of tables.
struct Part<'n> {
    place: Place,
    entries: &'n [Entry],
}

impl Part<'_> {
    /// Returns a table at the same location.
    fn with(&self, entries: Vec<Entry>) -> Node {
        Node {
            place: self.place,
            value: Value::Table(entries),
        }
    }
}

/// Returns the tables of a list of tables; none for other values.
fn tables(node: &Node) -> Option<Vec<Part<'_>>> {
    let Value::Array(items) = &node.value else {
        return None;
    };
    let tables = items.iter().map(|item| match &item.value {
        Value::Table(entries) => Some(Part {
            place: item.place,
            entries,
        }),
        _ => None,
    });
    tables.collect()
}

impl Rewritten {
    /// Returns a key `set` with a new set of the points of some blocks.
    fn set_of(&mut self, block: &Entry) -> Entry {
        let numbers = match &block.node.value {
            Value::Integer(number) => number.to_string(),
            _ => (self.sets.len() + 1).to_string(),
        };
        let mut name = format!("block_{numbers}");
        while self.sets.iter().any(|known| known.key == name) {
            name.push('_');
        }
        let place = block.node.place;
        self.sets.push(Entry {
            key: name.clone(),
            key_place: block.key_place,
            node: Node {
                place,
                value: Value::Table(vec![block.clone()]),
            },
        });
        Entry {
            key: "set".into(),
            key_place: block.key_place,
            node: Node {
                place,
                value: Value::Text(name),
            },
        }
    }

    /// Adds the tables to a deck, assignments and interfaces before its own.
    fn add_to(self, entries: &mut Vec<Entry>) {
        for (key, added) in [("sets", self.sets), ("materials", self.materials)] {
            let Some(first) = added.first() else { continue };
            let value = Value::Table(Vec::new());
            let node = entry_of(entries, key, first.key_place, value);
            if let Value::Table(known) = &mut node.value {
                known.extend(added);
            }
        }
        for (key, added) in [("assign", self.assign), ("interface", self.interface)] {
            let Some(first) = added.first() else { continue };
            let value = Value::Array(Vec::new());
            let node = entry_of(entries, key, first.place, value);
            if let Value::Array(known) = &mut node.value {
                known.splice(0..0, added);
            }
        }
    }

    /// Returns the tables as TOML.
    fn text(&self, sources: &Sources) -> String {
        let mut text = String::new();
        let mut table = |heading: String, entries: &[Entry]| {
            text += &format!("\n{heading}\n");
            for entry in entries {
                text += &format!("{} = {}\n", entry.key, written(&entry.node, sources));
            }
        };
        let entries = |node: &Node| match &node.value {
            Value::Table(entries) => entries.clone(),
            _ => Vec::new(),
        };
        for (kind, named) in [("sets", &self.sets), ("materials", &self.materials)] {
            for one in named {
                table(
                    format!("[{kind}.{}]", quoted(&one.key)),
                    &entries(&one.node),
                );
            }
        }
        for (kind, list) in [("assign", &self.assign), ("interface", &self.interface)] {
            for one in list {
                table(format!("[[{kind}]]"), &entries(one));
            }
        }
        text.trim_start().to_owned()
    }
}

/// Returns the value of a key of the deck, inserting it if it is missing.
fn entry_of<'n>(
    entries: &'n mut Vec<Entry>,
    key: &str,
    place: Place,
    value: Value,
) -> &'n mut Node {
    let known = entries.iter().position(|entry| entry.key == key);
    let at = known.unwrap_or_else(|| {
        entries.push(Entry {
            key: key.into(),
            key_place: place,
            node: Node { place, value },
        });
        entries.len() - 1
    });
    &mut entries[at].node
}

/// Returns a value as written in the deck.
fn written(node: &Node, sources: &Sources) -> String {
    let excerpt = sources.locate(node.place).excerpt().to_owned();
    match &node.value {
        // Generated names are not in the text, and overrides may lack quotes.
        Value::Text(text) if !excerpt.starts_with(['"', '\'']) => format!("{text:?}"),
        _ => excerpt,
    }
}

/// Returns a key, with quotes if needed.
fn quoted(key: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    match !key.is_empty() && key.chars().all(bare) {
        true => key.to_owned(),
        false => format!("{key:?}"),
    }
}
