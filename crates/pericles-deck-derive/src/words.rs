//! Words: enums of variants without fields.

use proc_macro2::TokenStream;
use quote::quote_spanned;
use syn::{Data, DeriveInput, Error, Fields, Result};

use crate::attributes::{Attributes, OF_ENUM, OF_VARIANT};
use crate::fields::here;

pub(crate) fn derive(input: DeriveInput) -> Result<TokenStream> {
    let attributes = Attributes::of(&input.attrs, OF_ENUM)?;
    let Data::Enum(data) = &input.data else {
        let message = "words are an enum";
        return Err(Error::new_spanned(&input.ident, message));
    };
    let mut words = Vec::new();
    for variant in &data.variants {
        if !matches!(variant.fields, Fields::Unit) {
            let message = "a word has no fields; derive `DeckKeys` for variants with keys";
            return Err(Error::new_spanned(variant, message));
        }
        let (own, name) = (Attributes::of(&variant.attrs, OF_VARIANT)?, &variant.ident);
        let word = own.name.unwrap_or_else(|| spelt(&name.to_string(), '-'));
        words.push(quote_spanned!(here()=> (#word, Self::#name)));
    }
    let (name, what) = (&input.ident, what(&input, &attributes)?);
    Ok(quote_spanned!(here()=>
        impl crate::words::Worded for #name {
            const WHAT: &'static str = #what;

            fn words() -> ::std::vec::Vec<(&'static str, Self)> {
                ::std::vec![#(#words),*]
            }
        }
    ))
}

/// Returns what a word is, in messages.
pub(crate) fn what(input: &DeriveInput, attributes: &Attributes) -> Result<String> {
    match &attributes.what {
        Some(what) => Ok(what.value()),
        None => {
            let message = "add #[deck(what = \"…\")]: what the word is, in messages";
            Err(Error::new_spanned(&input.ident, message))
        }
    }
}

/// Returns the name of a variant in lower case, with a mark between its words.
pub(crate) fn spelt(name: &str, mark: char) -> String {
    let mut spelt = String::new();
    for (k, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && k > 0 {
            spelt.push(mark);
        }
        spelt.extend(letter.to_lowercase());
    }
    spelt
}
