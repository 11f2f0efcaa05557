//! Names of at most 32 bytes that differ from each other.

use std::collections::BTreeSet;

use crate::results::FieldSpec;

/// The longest name; one byte more ends it.
pub(super) const NAME: usize = 32;

/// The beginning of a name with at most so many bytes.
fn cut(name: &str, most: usize) -> &str {
    let mut end = name.len().min(most);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    &name[..end]
}

/// Names that differ, each with at most so many bytes.
fn unique<'a>(given: impl Iterator<Item = (&'a str, usize)>) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let one = |(name, most): (&str, usize)| {
        let mut short = cut(name, most).to_owned();
        let mut number = 2;
        while !taken.insert(short.clone()) {
            let ending = format!("_{number}");
            short = cut(name, most - ending.len()).to_owned() + &ending;
            number += 1;
        }
        short
    };
    given.map(one).collect()
}

/// Names of blocks, sets and numbers.
pub(super) fn names<'a>(given: impl Iterator<Item = &'a str>) -> Vec<String> {
    unique(given.map(|name| (name, NAME)))
}

/// The endings of the names of components, which viewers join to vectors and tensors.
fn endings(columns: usize) -> Vec<String> {
    let words: &[&str] = match columns {
        1 => &[""],
        3 => &["X", "Y", "Z"],
        6 => &["XX", "YY", "ZZ", "XY", "YZ", "XZ"],
        _ => return (1..=columns).map(|k| format!("_{k}")).collect(),
    };
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Names of all columns of all fields. Fields are shortened so that their endings stay.
pub(super) fn column_names(fields: &[FieldSpec]) -> Vec<String> {
    let rooms = fields.iter().map(|field| {
        let endings = endings(field.columns());
        let longest = endings.iter().map(String::len).max();
        (field.name.as_str(), NAME - longest.unwrap_or(0))
    });
    let columns = unique(rooms)
        .into_iter()
        .zip(fields)
        .flat_map(|(name, field)| {
            let endings = endings(field.columns()).into_iter();
            endings.map(move |ending| format!("{name}{ending}"))
        });
    // One field may be named as the column of another.
    let columns: Vec<String> = columns.collect();
    names(columns.iter().map(String::as_str))
}
