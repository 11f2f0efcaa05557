//! Names that a format can store: of at most 32 bytes in Exodus, without slashes in HDF5.

use std::collections::BTreeSet;

use crate::results::FieldSpec;

/// Maximum length of a name in Exodus, without its terminating byte.
pub(super) const NAME: usize = 32;

/// Returns the name of a block, set or scalar field in an Exodus file, if no other name becomes equal to it.
pub fn name_in_exodus(name: &str) -> &str {
    cut(name, NAME)
}

/// Returns the name of a field in a VTKHDF file, if no other name becomes equal to it: a slash separates groups in HDF5.
fn name_in_vtkhdf(name: &str) -> String {
    match name {
        "" | "." => "_".to_owned(),
        name => name.replace(['/', '\0'], "_"),
    }
}

/// Returns unique names of fields in a VTKHDF file.
pub(super) fn hdf5_names<'a>(given: impl Iterator<Item = &'a str>) -> Vec<String> {
    let names: Vec<String> = given.map(name_in_vtkhdf).collect();
    unique(names.iter().map(|name| (name.as_str(), usize::MAX)))
}

/// Returns the longest prefix of a name with at most `most` bytes.
fn cut(name: &str, most: usize) -> &str {
    let mut end = name.len().min(most);
    while !name.is_char_boundary(end) {
        end -= 1;
    }
    &name[..end]
}

/// Makes names unique, each with a maximum number of bytes.
fn unique<'a>(given: impl Iterator<Item = (&'a str, usize)>) -> Vec<String> {
    let mut taken = BTreeSet::new();
    let one = |(name, most): (&str, usize)| {
        let mut short = cut(name, most).to_owned();
        let mut number = 2;
        while !taken.insert(short.clone()) {
            let ending = format!("_{number}");
            short = cut(name, most.saturating_sub(ending.len())).to_owned() + &ending;
            number += 1;
        }
        short
    };
    given.map(one).collect()
}

/// Returns unique names of blocks, sets and global values.
pub(super) fn names<'a>(given: impl Iterator<Item = &'a str>) -> Vec<String> {
    unique(given.map(|name| (name, NAME)))
}

/// Returns the suffixes of component names, which viewers combine to vectors and tensors.
fn endings(columns: usize) -> Vec<String> {
    let words: &[&str] = match columns {
        1 => &[""],
        3 => &["X", "Y", "Z"],
        6 => &["XX", "YY", "ZZ", "XY", "YZ", "XZ"],
        _ => return (1..=columns).map(|k| format!("_{k}")).collect(),
    };
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Returns the names of all columns of all fields. Field names are shortened so that the suffixes are kept.
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
    // A field name may equal a column name of another field.
    let columns: Vec<String> = columns.collect();
    names(columns.iter().map(String::as_str))
}
