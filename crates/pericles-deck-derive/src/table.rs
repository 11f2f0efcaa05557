//! Tables: structs whose fields are keys.

use proc_macro2::TokenStream;
use quote::{format_ident, quote_spanned};
use syn::{Data, DeriveInput, Error, Fields, Ident, Path, Result};

use crate::attributes::{Attributes, OF_STRUCT};
use crate::fields::{Field, fields, here, scope};

pub(crate) fn derive(input: DeriveInput) -> Result<TokenStream> {
    let attributes = Attributes::of(&input.attrs, OF_STRUCT)?;
    let fields = match &input.data {
        Data::Struct(data) if matches!(data.fields, Fields::Named(_)) => fields(&data.fields)?,
        _ => {
            let message = "a table is a struct with named fields";
            return Err(Error::new_spanned(&input.ident, message));
        }
    };
    let names: Vec<_> = fields.iter().map(|field| &field.name).collect();
    let values = fields.iter().map(Field::value);
    let checks = fields.iter().map(Field::check);
    let reads = fields
        .iter()
        .map(Field::read)
        .collect::<Result<Vec<TokenStream>>>()?;
    let counts = attributes.groups.iter();
    let counts =
        counts.map(|(function, keys)| quote_spanned!(here()=> table.#function(&[#(#keys),*]);));
    let target = target(&input, &attributes);
    let scope = scope();
    let verify = attributes
        .verify
        .as_ref()
        .map(|verify| quote_spanned!(here()=> #verify(table, &value, #scope)?;));
    let read = quote_spanned!(here()=>
        #(#reads)*
        #(#counts)*
        let value = #target { #(#names: #values),* };
        #verify
        Some(value)
    );
    let check = quote_spanned!(here()=>
        let #target { #(#names),* } = self;
        #(#checks)*
    );
    let keys = fields.iter().map(Field::keys);
    let groups = fields
        .iter()
        .map(|field| field.groups(&quote_spanned!(here()=> word)));
    let keys = quote_spanned!(here()=>
        fn keys() -> ::std::vec::Vec<&'static str> {
            [#(#keys),*].concat()
        }

        fn groups(word: &str) -> ::std::vec::Vec<crate::declaration::Group> {
            [#(#groups),*].concat()
        }
    );
    let mut code = implementation(&attributes, &target, &keys, &read, &check);
    code.extend(defaults(&input, &attributes, &fields)?);
    Ok(code)
}

/// Returns the functions of the defaults, and `Default` if it is requested.
fn defaults(input: &DeriveInput, attributes: &Attributes, fields: &[Field]) -> Result<TokenStream> {
    let name = &input.ident;
    // Defaults do not depend on fields above, unless these are given.
    let unknown: Vec<_> = fields.iter().map(|field| &field.name).collect();
    let own = fields.iter().enumerate().filter_map(|(k, field)| {
        let (value, ty) = field.own_default()?;
        let function = format_ident!("default_{}", field.name);
        let above = fields[..k].iter().map(Field::unknown);
        Some(quote_spanned!(here()=>
            #[allow(dead_code, unused_variables)]
            pub(crate) fn #function() -> #ty {
                #(#above)*
                #value
            }
        ))
    });
    let own: Vec<TokenStream> = own.collect();
    let mut code = match own.is_empty() {
        true => TokenStream::new(),
        false => quote_spanned!(here()=> impl #name { #(#own)* }),
    };
    if attributes.default.is_some() {
        let values = fields
            .iter()
            .map(|field| match (field.own_default(), field.fallback()) {
                (Some(_), _) => {
                    let function = format_ident!("default_{}", field.name);
                    Ok(quote_spanned!(here()=> Self::#function()))
                }
                (None, Some(value)) => Ok(value),
                (None, None) => {
                    let message = "`Default` needs a default of this field";
                    Err(Error::new_spanned(&field.name, message))
                }
            })
            .collect::<Result<Vec<TokenStream>>>()?;
        code.extend(quote_spanned!(here()=>
            impl ::core::default::Default for #name {
                fn default() -> Self {
                    Self { #(#unknown: #values),* }
                }
            }
        ));
    }
    Ok(code)
}

/// Returns the type that is declared.
pub(crate) fn target(input: &DeriveInput, attributes: &Attributes) -> Path {
    let own = || Path::from(input.ident.clone());
    attributes.remote.clone().unwrap_or_else(own)
}

/// Returns the generic parameters of implementations, and the type of the scope.
pub(crate) fn scoped(attributes: &Attributes) -> (TokenStream, TokenStream) {
    match &attributes.scope_type {
        Some(ty) => (quote_spanned!(here()=> <'s>), quote_spanned!(here()=> #ty)),
        None => (
            quote_spanned!(here()=> <S: ::core::marker::Copy>),
            quote_spanned!(here()=> S),
        ),
    }
}

/// Implements `DeckKeys` by the code of its functions, of which `keys` are complete, and from it the other traits of tables.
pub(crate) fn implementation(
    attributes: &Attributes,
    target: &Path,
    keys: &TokenStream,
    read: &TokenStream,
    check: &TokenStream,
) -> TokenStream {
    let (about, scope) = (&attributes.about, scope());
    let word = attributes.word.as_ref().map(|(word, value)| {
        quote_spanned!(here()=> if item.is_keyword(#word) {
            return Some(#value);
        })
    });
    let unique = attributes.unique.as_ref().map(|(key, table)| {
        let field = Ident::new(key, scope.span());
        let reason = format!("another {table} has this {key}");
        let allowed = format!("allowed: a unique {key} per {table}");
        quote_spanned!(here()=>
            const UNIQUE: ::core::option::Option<crate::declaration::Unique> =
                Some(crate::declaration::Unique { key: #key, reason: #reason, allowed: #allowed });

            fn unique_text(&self) -> ::core::option::Option<&str> {
                Some(&self.#field)
            }
        )
    });
    let definition = attributes.define.as_ref().map(|name| {
        quote_spanned!(here()=>
            const DEFINITION: ::core::option::Option<&'static str> = Some(#name);
        )
    });
    let (generics, ty) = scoped(attributes);
    quote_spanned!(here()=>
        impl crate::declaration::Keyed for #target {
            #definition

            #keys
        }

        #[allow(unused_variables)]
        impl #generics crate::declaration::DeckKeys<#ty> for #target {
            fn read_keys(table: &crate::reader::Table<'_>, #scope: #ty) -> ::core::option::Option<Self> {
                #read
            }

            fn check_keys(
                &self,
                path: &crate::key_path::KeyPath,
                #scope: #ty,
                check: &mut crate::declaration::Check,
            ) {
                #check
            }
        }

        impl #generics crate::declaration::DeckTable<#ty> for #target {
            const ABOUT: &'static str = #about;
            #unique
        }

        impl #generics crate::declaration::DeckValue<#ty> for #target {
            fn read(item: &crate::reader::Item<'_>, #scope: #ty) -> ::core::option::Option<Self> {
                #word
                crate::declaration::DeckTable::read_table(item.table()?, #scope)
            }

            fn check(
                &self,
                path: crate::key_path::KeyPath,
                #scope: #ty,
                check: &mut crate::declaration::Check,
            ) {
                crate::declaration::DeckKeys::check_keys(self, &path, #scope, check);
            }
        }
    )
}
