//! Enums as keys of a table: a tag with the keys of its variants, or exclusive keys.

use proc_macro2::{Literal, TokenStream};
use quote::quote_spanned;
use syn::{Data, DeriveInput, Error, Fields, Ident, LitStr, Path, Result, Type};

use crate::attributes::{Attributes, Fallback, OF_ENUM, OF_VARIANT};
use crate::fields::{Field, fields, here, scope};
use crate::table::{implementation, scoped, target};
use crate::words::{spelt, what};

/// A variant with its keys.
struct Variant<'a> {
    name: &'a Ident,
    attributes: Attributes,
    fields: Vec<Field>,
    is_named: bool,
}

pub(crate) fn derive(input: DeriveInput) -> Result<TokenStream> {
    let attributes = Attributes::of(&input.attrs, OF_ENUM)?;
    let Data::Enum(data) = &input.data else {
        let message = "derive `DeckTable` for structs";
        return Err(Error::new_spanned(&input.ident, message));
    };
    let variants = data
        .variants
        .iter()
        .map(|variant| {
            Ok(Variant {
                name: &variant.ident,
                attributes: Attributes::of(&variant.attrs, OF_VARIANT)?,
                fields: fields(&variant.fields)?,
                is_named: matches!(variant.fields, Fields::Named(_)),
            })
        })
        .collect::<Result<Vec<Variant<'_>>>>()?;
    let target = target(&input, &attributes);
    let all = variants
        .iter()
        .flat_map(|variant| &variant.fields)
        .map(Field::keys);
    let (keys, read, check) = match (&attributes.tag, attributes.exclusive) {
        (Some(tag), false) => (
            tagged_keys(tag, all, &variants),
            tagged(&input, &attributes, &tag.value(), &variants)?,
            check(&target, Some(&tag.value()), &variants),
        ),
        (None, true) => {
            let further = variants.iter().flat_map(Variant::further).map(Field::keys);
            let keys = quote_spanned!(here()=>
                fn keys() -> ::std::vec::Vec<&'static str> {
                    [<Self as crate::declaration::Exclusive>::choices().to_vec(), #(#further),*].concat()
                }
            );
            let read = exclusive(&target, &attributes, &variants);
            let mut code = choice(&target, &attributes, &variants)?;
            let check = check(&target, None, &variants);
            code.extend(implementation(&attributes, &target, &keys, &read, &check));
            return Ok(code);
        }
        _ => {
            let message = "add #[deck(tag = \"…\")] or #[deck(exclusive)]";
            return Err(Error::new_spanned(&input.ident, message));
        }
    };
    Ok(implementation(&attributes, &target, &keys, &read, &check))
}

/// Returns the functions of the keys of all variants, and of the groups of keys that a word selects.
fn tagged_keys(
    tag: &LitStr,
    all: impl Iterator<Item = TokenStream>,
    variants: &[Variant<'_>],
) -> TokenStream {
    let arms = variants.iter().map(|variant| {
        let word = variant.named('-');
        let groups = variant
            .fields
            .iter()
            .map(|field| field.groups(&quote_spanned!(here()=> word)));
        quote_spanned!(here()=> #word => ::std::vec![#(#groups),*])
    });
    let fields = variants.iter().flat_map(|variant| &variant.fields);
    let every = fields.map(|field| field.groups(&quote_spanned!(here()=> word)));
    quote_spanned!(here()=>
        fn keys() -> ::std::vec::Vec<&'static str> {
            [::std::vec![#tag], #(#all),*].concat()
        }

        fn groups(word: &str) -> ::std::vec::Vec<crate::declaration::Group> {
            let groups: ::std::vec::Vec<::std::vec::Vec<crate::declaration::Group>> = match word {
                #(#arms,)*
                // The word of another tag.
                _ => ::std::vec![::std::vec![(::std::vec![#tag], None)], #(#every),*],
            };
            groups.concat()
        }
    )
}

/// Reads the word of a tag, then the keys of its variant.
fn tagged(
    input: &DeriveInput,
    attributes: &Attributes,
    tag: &str,
    variants: &[Variant<'_>],
) -> Result<TokenStream> {
    let own = attributes.tag_about.as_ref().map(syn::LitStr::value);
    let (about, what) = (
        own.as_ref().unwrap_or(&attributes.about),
        what(input, attributes)?,
    );
    let words: Vec<String> = variants.iter().map(|variant| variant.named('-')).collect();
    let numbers = (0..variants.len()).map(Literal::usize_suffixed);
    let usual = variants
        .iter()
        .position(|variant| variant.attributes.default.is_some());
    let found = match (&attributes.default, usual) {
        (Some(Fallback::Value(word)), _) => quote_spanned!(here()=> {
            let word: ::core::option::Option<&str> = #word;
            if let Some(word) = word {
                table.record(#tag, word);
            }
            WORDS.iter().find(|(known, _)| Some(*known) == word).map(|(_, number)| *number)
        }),
        (_, Some(number)) => {
            let (word, number) = (&words[number], Literal::usize_suffixed(number));
            quote_spanned!(here()=> {
                table.record(#tag, #word);
                Some(#number)
            })
        }
        (_, None) => quote_spanned!(here()=> None),
    };
    let is_required = attributes.default.is_none() && usual.is_none();
    let selector = format!("{tag} = ");
    let request = Ident::new(if is_required { "required" } else { "optional" }, here());
    let arms = variants
        .iter()
        .enumerate()
        .map(|(number, variant)| {
            let reads = variant
                .fields
                .iter()
                .map(Field::read)
                .collect::<Result<Vec<_>>>()?;
            let conditions = variant.attributes.allowed.iter().map(|(condition, words)| {
                quote_spanned!(here()=> if !(#condition) {
                    if let Some(item) = &item {
                        item.out_of_range(#words);
                    }
                    table.know(&<Self as crate::declaration::Keyed>::keys());
                    return None;
                })
            });
            let number = Literal::usize_suffixed(number);
            let made = variant.made(&target(input, attributes));
            Ok(quote_spanned!(here()=> Some(#number) => {
                #(#conditions)*
                table.forbid_others(#selector, #number, &alternatives);
                #(#reads)*
                Some(#made)
            }))
        })
        .collect::<Result<Vec<TokenStream>>>()?;
    let count = words.len();
    let alternatives = variants.iter().map(|variant| {
        let word = variant.named('-');
        let name = format!("{word:?}");
        quote_spanned!(here()=> crate::reader::Alternative {
            name: #name,
            groups: <Self as crate::declaration::Keyed>::groups(#word),
        })
    });
    Ok(quote_spanned!(here()=>
        const WORDS: [(&str, usize); #count] = [#((#words, #numbers)),*];
        let alternatives = [#(#alternatives),*];
        table.describe(#tag, #about);
        let item = table.#request(#tag);
        let found = match &item {
            Some(item) => item.choice(#what, &WORDS),
            None => #found,
        };
        match found {
            #(#arms)*
            _ => {
                table.know(&<Self as crate::declaration::Keyed>::keys());
                None
            }
        }
    ))
}

/// Reads the one key that is given.
fn exclusive(target: &Path, attributes: &Attributes, variants: &[Variant<'_>]) -> TokenStream {
    let scope = scope();
    let found = match &attributes.default {
        None => quote_spanned!(here()=> table.exactly_one(keys)),
        Some(usual) => {
            let usual = match usual {
                Fallback::OfType => quote_spanned!(here()=> ::core::default::Default::default()),
                Fallback::Value(value) => quote_spanned!(here()=> #value),
            };
            let record = variants.iter().map(|variant| {
                let (name, key) = (variant.name, variant.named('_'));
                match (variant.fields.len(), variant.is_named) {
                    (1, false) => quote_spanned!(here()=> #target::#name(value) => {
                        crate::declaration::Fallback::missing(value, table, #key, #scope)
                            .map(#target::#name)
                    }),
                    // Several keys have no default.
                    _ => quote_spanned!(here()=> usual @ #target::#name { .. } => Some(usual)),
                }
            });
            quote_spanned!(here()=> match table.at_most_one(keys) {
                Some(None) => {
                    let usual: #target = #usual;
                    return match usual { #(#record),* };
                }
                Some(found) => found,
                None => None,
            })
        }
    };
    quote_spanned!(here()=>
        let keys = <Self as crate::declaration::Exclusive>::choices();
        <Self as crate::declaration::DeckChoice<_>>::prepare(table, #scope);
        match #found {
            Some((key, item)) => {
                crate::declaration::DeckChoice::read_choice(table, key, &item, #scope)
            }
            None => {
                table.know(&<Self as crate::declaration::Keyed>::keys());
                None
            }
        }
    )
}

/// Implements `Exclusive` and `DeckChoice`, which read the value of the key that is given, then further keys of its
/// variant.
fn choice(target: &Path, attributes: &Attributes, variants: &[Variant<'_>]) -> Result<TokenStream> {
    let scope = scope();
    let keys = with_keys(variants).map(|variant| match variant.inner() {
        Some(ty) => {
            quote_spanned!(here()=> <#ty as crate::declaration::Exclusive>::choices().to_vec())
        }
        None => {
            let key = variant.named('_');
            quote_spanned!(here()=> ::std::vec![#key])
        }
    });
    let prepared = with_keys(variants).map(|variant| {
        if let Some(ty) = variant.inner() {
            return quote_spanned!(here()=>
                <#ty as crate::declaration::DeckChoice<_>>::prepare(table, #scope);
            );
        }
        let (key, about) = (variant.named('_'), variant.about());
        // A definition has its own description.
        let describe = match &variant.attributes.define {
            Some(_) => TokenStream::new(),
            None => quote_spanned!(here()=> table.describe(#key, #about);),
        };
        let conditions = variant
            .attributes
            .allowed
            .iter()
            .map(|(condition, reason)| {
                quote_spanned!(here()=> if !(#condition) {
                    table.forbid(#key, #reason);
                })
            });
        quote_spanned!(here()=> #describe #(#conditions)*)
    });
    let arms = with_keys(variants)
        .enumerate()
        .map(|(number, variant)| {
            let (name, key) = (variant.name, variant.named('_'));
            if let Some(ty) = variant.inner() {
                return Ok(quote_spanned!(here()=>
                    key if <#ty as crate::declaration::Exclusive>::choices().contains(&key) => {
                        crate::declaration::DeckChoice::read_choice(table, key, item, #scope)
                            .map(#target::#name)
                    }
                ));
            }
            let define = variant.attributes.define.as_ref().map(|name| {
                let about = variant.about();
                quote_spanned!(here()=> item.define(#name, #about);)
            });
            let body = variant.read_value(target)?;
            Ok(quote_spanned!(here()=> #key => {
                #define
                table.forbid_others("", #number, &alternatives);
                #body
            }))
        })
        .collect::<Result<Vec<TokenStream>>>()?;
    let alternatives = with_keys(variants).map(|variant| {
        let name = format!("`{}`", variant.named('_'));
        let groups = variant.further().map(|field| field.groups(&quote_spanned!(here()=> "")));
        quote_spanned!(here()=> crate::reader::Alternative {
            name: #name,
            groups: ::std::vec::Vec::<::std::vec::Vec<crate::declaration::Group>>::from([#(#groups),*])
                .concat(),
        })
    });
    let (generics, ty) = scoped(attributes);
    Ok(quote_spanned!(here()=>
        impl crate::declaration::Exclusive for #target {
            fn choices() -> &'static [&'static str] {
                static KEYS: ::std::sync::OnceLock<::std::vec::Vec<&'static str>> =
                    ::std::sync::OnceLock::new();
                KEYS.get_or_init(|| [#(#keys),*].concat())
            }
        }

        #[allow(unused_variables)]
        impl #generics crate::declaration::DeckChoice<#ty> for #target {
            fn prepare(table: &crate::reader::Table<'_>, #scope: #ty) {
                #(#prepared)*
            }

            fn read_choice(
                table: &crate::reader::Table<'_>,
                key: &'static str,
                item: &crate::reader::Item<'_>,
                #scope: #ty,
            ) -> ::core::option::Option<Self> {
                let alternatives = [#(#alternatives),*];
                match key {
                    #(#arms)*
                    _ => None,
                }
            }
        }
    ))
}

/// Returns the variants with a key: those with a value, and those without one that name a key.
fn with_keys<'a, 'b>(variants: &'a [Variant<'b>]) -> impl Iterator<Item = &'a Variant<'b>> {
    let has_key =
        |variant: &&Variant<'_>| !variant.fields.is_empty() || variant.attributes.name.is_some();
    variants.iter().filter(has_key)
}

/// Checks the keys of a variant. Without a tag, the key of the first field is named after the variant.
fn check(target: &Path, tag: Option<&str>, variants: &[Variant<'_>]) -> TokenStream {
    let arms = variants.iter().map(|variant| {
        let name = variant.name;
        let pattern = variant.pattern();
        if tag.is_none() && variant.attributes.table {
            let (key, checks) = (variant.named('_'), variant.fields.iter().map(Field::check));
            return quote_spanned!(here()=> #target::#name #pattern => {
                let path = &path.key(#key);
                #(#checks)*
            });
        }
        let checks =
            variant
                .fields
                .iter()
                .enumerate()
                .map(|(k, field)| match k == 0 && tag.is_none() {
                    true => field.check_as(&variant.named('_')),
                    false => field.check(),
                });
        let (word, key) = match tag {
            Some(tag) => (variant.named('-'), tag.to_owned()),
            None => (variant.named('_'), variant.named('_')),
        };
        let conditions = variant.attributes.allowed.iter().map(|(condition, words)| {
            quote_spanned!(here()=>
                let allowed = ::std::format!("allowed: {}", #words);
                check.within(#condition, path.key(#key), #word, &allowed);
            )
        });
        quote_spanned!(here()=> #target::#name #pattern => { #(#conditions)* #(#checks)* })
    });
    quote_spanned!(here()=> match self { #(#arms)* })
}

impl Variant<'_> {
    /// Returns the word or key of the variant.
    fn named(&self, mark: char) -> String {
        let own = self.attributes.name.clone();
        own.unwrap_or_else(|| spelt(&self.name.to_string(), mark))
    }

    /// Returns the description of the key of an exclusive variant.
    fn about(&self) -> &str {
        match self.fields.first() {
            Some(first) if !self.attributes.table && !first.attributes.about.is_empty() => {
                &first.attributes.about
            }
            _ => &self.attributes.about,
        }
    }

    /// Returns the type of exclusive keys that are keys of this variant.
    fn inner(&self) -> Option<&Type> {
        let first = self.fields.first();
        first.and_then(Field::flattened)
    }

    /// Returns the code that reads the value of an exclusive key, then further keys.
    fn read_value(&self, target: &Path) -> Result<TokenStream> {
        let made = self.made(target);
        if self.attributes.table {
            let reads = self
                .fields
                .iter()
                .map(Field::read)
                .collect::<Result<Vec<_>>>()?;
            return Ok(quote_spanned!(here()=>
                let inner = item.table()?;
                let table = &inner;
                #(#reads)*
                inner.finish();
                Some(#made)
            ));
        }
        let Some(first) = self.fields.first() else {
            return Ok(quote_spanned!(here()=> match item.boolean()? {
                true => Some(#made),
                false => {
                    item.out_of_range("true; remove the key for another choice");
                    None
                }
            }));
        };
        let value = first.bound(&first.rule());
        let reads = self
            .further()
            .map(Field::read)
            .collect::<Result<Vec<_>>>()?;
        Ok(quote_spanned!(here()=> #value #(#reads)* Some(#made)))
    }

    /// Returns the fields in the table of the variant except the first one.
    fn further(&self) -> impl Iterator<Item = &Field> {
        let fields = match self.attributes.table {
            true => &[],
            false => &self.fields[..],
        };
        fields.iter().skip(1)
    }

    /// Returns the pattern of the fields.
    fn pattern(&self) -> TokenStream {
        let names = self.fields.iter().map(|field| &field.name);
        match (self.is_named, self.fields.is_empty()) {
            (true, _) => quote_spanned!(here()=> { #(#names),* }),
            (false, true) => TokenStream::new(),
            (false, false) => quote_spanned!(here()=> ( #(#names),* )),
        }
    }

    /// Returns the variant of the values that were read.
    fn made(&self, target: &Path) -> TokenStream {
        let (name, names) = (self.name, self.fields.iter().map(|field| &field.name));
        let values = self.fields.iter().map(Field::value);
        match (self.is_named, self.fields.is_empty()) {
            (true, _) => quote_spanned!(here()=> #target::#name { #(#names: #values),* }),
            (false, true) => quote_spanned!(here()=> #target::#name),
            (false, false) => quote_spanned!(here()=> #target::#name( #(#values),* )),
        }
    }
}
