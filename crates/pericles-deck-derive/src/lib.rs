//! Derives the reader, the range check and the descriptions of a deck table from one annotated type.
//!
//! The traits are those of the module `declaration` of `pericles-deck`, which is the only user of this crate.
//!
//! | derive | type | in a deck |
//! |---|---|---|
//! | `DeckTable` | a struct | a table; each field is a key |
//! | `DeckKeys` | an enum with `#[deck(tag = "shape")]` | a key whose word selects the variant, and the keys of that variant |
//! | `DeckKeys` | an enum with `#[deck(exclusive)]` | keys of which one is given, which selects the variant; variants without fields have no key, unless they name one, whose value is `true` |
//! | `DeckWords` | an enum of variants without fields | a word |
//!
//! # Attributes of fields
//! | attribute | meaning |
//! |---|---|
//! | `quantity = Length` | a number or vector of this quantity, a variant of `Quantity` or an expression |
//! | `range = at_least(0.0)` | its range, a function or constant of the module `range` |
//! | `default`, `default = 0.5` | value of a missing key, recorded with the deck; without it, keys are required unless the type is an `Option` or a `Vec` |
//! | `key = "file"` | the key, if it is not the name of the field |
//! | `or_empty` | of a table: if it is missing, an empty table is read, whose defaults are recorded |
//! | `none = "auto"` | of an `Option`: the word for `None`, which `default` alone makes the default |
//! | `required` | of a `Vec`: the key is required |
//! | `required_if(condition)` | of an `Option` or with a default: the key is required if the condition holds |
//! | `with = function` | reader of the value: a function, or an expression of one, of the item and the scope; with `flatten` of the table and the scope |
//! | `check = function` | range check of a value with a reader of its own: a function of the value, the path of the table, the scope and the collector; instead, a `range` |
//! | `accept = function` | function of the value and the scope whose error is reported, also by the range check |
//! | `flatten` | the field is a `DeckKeys` enum or `DeckTable` struct whose keys are in this table, or has a reader of the table (`with`); with `key`, the documentation of the field describes this key. In an exclusive enum, the field is one as well, whose keys are further choices |
//! | `keys("cells", "thickness")` | of a field with a reader of the table: the keys that it reads, if not the name of the field |
//! | `scope = expression` | scope of the value, instead of the scope of the table |
//! | `forbid_if(condition, "reason")` | the key, or all keys of a flattened field, are not allowed if the condition holds; the field then has its default |
//! | `allow_if(condition, "allowed values")` | the value is out of range unless the condition, which may use the field itself, holds |
//!
//! Expressions may use `scope` and, as `Option<&T>`, the fields above; these are `None` if their values are invalid.
//! A field without `quantity`, `range` and `with` is read by the `DeckValue` of its type.
//!
//! The first paragraph of the documentation of a field describes the key to users of decks, in the schema and in the
//! book. Further paragraphs are for programmers. Lists of tables are described by the documentation of
//! the type.
//!
//! # Attributes of types and variants
//! | attribute | meaning |
//! |---|---|
//! | `scope = Space<'s>` | type of the scope: what keys depend on in addition to the fields above; without it, any scope |
//! | `remote = Type` | declares a type of another crate, whose fields or variants are repeated |
//! | `define = "function"` | the name of the definition of the table, or of the value of an exclusive key, in the schema, if several keys share it |
//! | `default` | of a struct whose fields all have defaults: implements `Default` |
//! | `at_least_one("mass", "stiffness")`, `at_most_one("rule", "modulus")`, `exactly_one("temperature", "file")` | of a struct: how many of these keys are given |
//! | `verify = function` | of a struct: function of the table, the value and the scope that reports values that do not fit together |
//! | `word_for("never", value)` | of a struct: a word that may replace the table, with its value |
//! | `unique("name", "probe")` | of a struct: texts of the key and field of this name are unique in a list of tables, which are called so |
//! | `what = "contact law"` | of enums of words and tagged enums: what the word is, in messages |
//! | `tag_about = "…"` | description of the tag of an enum that is a table, whose documentation describes the table |
//! | `word = "half-space"`, `key = "at"` | of a variant: its word or key, if not its name in kebab case or snake case |
//! | `otherwise = "reason"` | of a field of a variant: why other variants do not have it |
//! | `#[default]` | of a variant: the variant of a missing tag |
//! | `default`, `default = expression` | of an exclusive enum: its value if none of the keys is given |
//! | `default = expression` | of a tagged enum: the word of a missing tag, an `Option`; none if it depends on an invalid value |
//! | `allow_if(condition, "allowed words")` | of a variant: its word is out of range, its exclusive key is not allowed, unless the condition holds |
//! | `table` | of a variant with an exclusive key: its fields are keys of a table under that key |

mod attributes;
mod fields;
mod keys;
mod table;
mod words;

use proc_macro::TokenStream;
use syn::{DeriveInput, parse_macro_input};

/// Derives `DeckTable` of a struct.
#[proc_macro_derive(DeckTable, attributes(deck))]
pub fn deck_table(input: TokenStream) -> TokenStream {
    finished(table::derive(parse_macro_input!(input as DeriveInput)))
}

/// Derives `DeckKeys` of an enum.
#[proc_macro_derive(DeckKeys, attributes(deck, default))]
pub fn deck_keys(input: TokenStream) -> TokenStream {
    finished(keys::derive(parse_macro_input!(input as DeriveInput)))
}

/// Derives `Worded` of an enum of words.
#[proc_macro_derive(DeckWords, attributes(deck, default))]
pub fn deck_words(input: TokenStream) -> TokenStream {
    finished(words::derive(parse_macro_input!(input as DeriveInput)))
}

fn finished(derived: syn::Result<proc_macro2::TokenStream>) -> TokenStream {
    derived
        .unwrap_or_else(syn::Error::into_compile_error)
        .into()
}
