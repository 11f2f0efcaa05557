//! Fields of structs and variants: reading and checking their keys.

use proc_macro2::{Span, TokenStream};
use quote::{format_ident, quote_spanned};
use syn::{Error, Fields, GenericArgument, Ident, PathArguments, Result, Type};

use crate::attributes::{Attributes, Fallback, OF_FIELD};

/// A field with its key.
pub(crate) struct Field {
    /// The name of the field, or of a variable for a field without a name.
    pub(crate) name: Ident,
    pub(crate) key: String,
    pub(crate) attributes: Attributes,
    /// The type, without `Option`.
    ty: Type,
    is_optional: bool,
    is_list: bool,
}

/// The span of the code: its variables are not visible in expressions of attributes.
pub(crate) fn here() -> Span {
    Span::mixed_site()
}

/// The variable `scope`, which expressions of attributes see.
pub(crate) fn scope() -> Ident {
    Ident::new("scope", Span::call_site())
}

/// Returns all fields of a struct or variant.
pub(crate) fn fields(fields: &Fields) -> Result<Vec<Field>> {
    fields
        .iter()
        .enumerate()
        .map(|(number, field)| {
            let attributes = Attributes::of(&field.attrs, OF_FIELD)?;
            let name = match &field.ident {
                Some(name) => name.clone(),
                None => format_ident!("value{number}"),
            };
            let key = attributes.name.clone().unwrap_or_else(|| name.to_string());
            // With a default, `None` is a value like others, unless it has a word.
            let is_value = attributes.default.is_some() && attributes.none.is_none();
            let inner = inside(&field.ty, "Option").filter(|_| !is_value);
            if attributes.with.is_some() && attributes.quantity.is_some() {
                let message = "a field has a quantity or a reader of its own (`with`), not both";
                return Err(Error::new_spanned(field, message));
            }
            Ok(Field {
                name,
                key,
                is_optional: inner.is_some(),
                is_list: inside(&field.ty, "Vec").is_some() && !attributes.required,
                attributes,
                ty: inner.unwrap_or(&field.ty).clone(),
            })
        })
        .collect()
}

/// Returns T of `Wrapper<T>`.
fn inside<'a>(ty: &'a Type, wrapper: &str) -> Option<&'a Type> {
    let Type::Path(path) = ty else { return None };
    let last = path.path.segments.last()?;
    match &last.arguments {
        PathArguments::AngleBracketed(arguments) if last.ident == wrapper => {
            match arguments.args.first()? {
                GenericArgument::Type(inner) => Some(inner),
                _ => None,
            }
        }
        _ => None,
    }
}

impl Field {
    /// Returns the type of a value whose keys are keys of the table.
    pub(crate) fn flattened(&self) -> Option<&Type> {
        self.attributes.flatten.then_some(&self.ty)
    }

    /// Returns the variable of the value that was read, an option.
    fn read_name(&self) -> Ident {
        format_ident!("read_{}", self.name, span = here())
    }

    fn scope(&self) -> TokenStream {
        let scope = scope();
        match &self.attributes.scope {
            Some(expression) => quote_spanned!(here()=> #expression),
            None => quote_spanned!(here()=> #scope),
        }
    }

    /// Returns whether the value is a number or vector of a quantity.
    fn is_measured(&self) -> bool {
        self.attributes.quantity.is_some() || self.attributes.range.is_some()
    }

    fn range(&self) -> TokenStream {
        match &self.attributes.range {
            Some(range) => quote_spanned!(here()=> {
                #[allow(unused_imports)]
                use crate::range::*;
                #range
            }),
            None => quote_spanned!(here()=> crate::range::ANY),
        }
    }

    /// Returns the code that reads `item`.
    pub(crate) fn rule(&self) -> TokenStream {
        let (mut rule, name, scope) = (self.simple_rule(), &self.name, self.scope());
        if let Some(accept) = &self.attributes.accept {
            rule = quote_spanned!(here()=>
                (#rule).filter(|value| item.accept(#accept(value, #scope)).is_some())
            );
        }
        for (condition, words) in &self.attributes.allowed {
            rule = quote_spanned!(here()=> (#rule).filter(|value| {
                let #name = Some(value);
                let is_allowed = #condition;
                if !is_allowed {
                    item.out_of_range(#words);
                }
                is_allowed
            }));
        }
        rule
    }

    fn simple_rule(&self) -> TokenStream {
        let (ty, scope) = (&self.ty, self.scope());
        if let Some(with) = &self.attributes.with {
            return quote_spanned!(here()=> #with(&item, #scope));
        }
        if self.is_measured() {
            let quantity = match &self.attributes.quantity {
                Some(quantity) => quote_spanned!(here()=> {
                    #[allow(unused_imports)]
                    use crate::quantity::Quantity::*;
                    #quantity
                }),
                None => quote_spanned!(here()=> crate::quantity::Quantity::Number),
            };
            let range = self.range();
            return match &self.attributes.none {
                Some(word) => quote_spanned!(here()=>
                    <#ty as crate::declaration::Measured<_>>::read_or(
                        &item, #word, #quantity, #range, #scope,
                    )
                ),
                None => quote_spanned!(here()=> <#ty as crate::declaration::Measured<_>>::read(
                    &item, #quantity, #range, #scope,
                )),
            };
        }
        let read = quote_spanned!(here()=>
            <#ty as crate::declaration::DeckValue<_>>::read(&item, #scope)
        );
        match &self.attributes.none {
            Some(word) => quote_spanned!(here()=> match item.is_keyword(#word) {
                true => Some(None),
                false => #read.map(Some),
            }),
            None => read,
        }
    }

    /// Returns the default of a missing key.
    pub(crate) fn fallback(&self) -> Option<TokenStream> {
        match &self.attributes.default {
            Some(Fallback::Value(value)) => Some(quote_spanned!(here()=> #value)),
            None if !self.is_optional && !self.is_list => None,
            _ => Some(quote_spanned!(here()=> ::core::default::Default::default())),
        }
    }

    /// Returns the expression of a default that is not the default of the type, and the type.
    pub(crate) fn own_default(&self) -> Option<(TokenStream, TokenStream)> {
        match &self.attributes.default {
            Some(Fallback::Value(value)) => Some((quote_spanned!(here()=> #value), self.whole())),
            _ => None,
        }
    }

    /// Declares the variable of the field as one whose value is not known.
    pub(crate) fn unknown(&self) -> TokenStream {
        let (name, whole) = (&self.name, self.whole());
        quote_spanned!(here()=> let #name: ::core::option::Option<&#whole> = None;)
    }

    /// Returns the type of the field.
    fn whole(&self) -> TokenStream {
        let ty = &self.ty;
        match self.is_optional {
            true => quote_spanned!(here()=> ::core::option::Option<#ty>),
            false => quote_spanned!(here()=> #ty),
        }
    }

    /// Returns the code that reads the key and declares the variable of the field.
    pub(crate) fn read(&self) -> Result<TokenStream> {
        let (key, about) = (&self.key, &self.attributes.about);
        let mut reading = match self.attributes.flatten {
            true => self.read_flattened(),
            false => self.read_key(),
        };
        for (condition, reason) in self.attributes.forbidden.iter().rev() {
            let Some(value) = self.fallback() else {
                let message = "a key that may be forbidden needs a default or the type `Option`";
                return Err(Error::new_spanned(condition, message));
            };
            let keys = self.keys();
            reading = quote_spanned!(here()=> if #condition {
                for key in #keys {
                    table.forbid(key, #reason);
                }
                Some(#value)
            } else {
                #reading
            });
        }
        // Lists of tables have descriptions, unless several keys share them, and so have the keys of a flattened value,
        // unless its one key is named.
        let entry = inside(&self.ty, "Vec").filter(|_| self.attributes.with.is_none());
        let describe = match (self.attributes.flatten, entry) {
            _ if about.is_empty() => TokenStream::new(),
            (true, _) if self.attributes.name.is_none() => TokenStream::new(),
            (false, Some(entry)) => quote_spanned!(here()=>
                if <#entry as crate::declaration::Keyed>::DEFINITION.is_some() {
                    table.describe(#key, #about);
                }
            ),
            _ => quote_spanned!(here()=> table.describe(#key, #about);),
        };
        let bound = self.bound(&reading);
        Ok(quote_spanned!(here()=> #describe #bound))
    }

    /// Returns an expression of the keys of the field, a vector.
    pub(crate) fn keys(&self) -> TokenStream {
        let (ty, key, keys) = (&self.ty, &self.key, &self.attributes.keys);
        match (keys, self.has_inner_keys()) {
            (Some(keys), _) => quote_spanned!(here()=> ::std::vec![#(#keys),*]),
            (None, true) => quote_spanned!(here()=> <#ty as crate::declaration::Keyed>::keys()),
            (None, false) => quote_spanned!(here()=> ::std::vec![#key]),
        }
    }

    /// Returns an expression of the groups of keys of the field that a word of a tag selects, a vector.
    pub(crate) fn groups(&self, word: &TokenStream) -> TokenStream {
        let (ty, keys) = (&self.ty, self.keys());
        match &self.attributes.otherwise {
            Some(reason) => quote_spanned!(here()=> ::std::vec![(#keys, Some(#reason))]),
            None if self.has_inner_keys() && self.attributes.keys.is_none() => {
                quote_spanned!(here()=> <#ty as crate::declaration::Keyed>::groups(#word))
            }
            None => quote_spanned!(here()=> ::std::vec![(#keys, None)]),
        }
    }

    /// Returns whether the type of the field has the keys.
    fn has_inner_keys(&self) -> bool {
        let is_named = self.attributes.name.is_some() || self.attributes.with.is_some();
        self.attributes.flatten && !is_named
    }

    fn read_flattened(&self) -> TokenStream {
        let (ty, scope) = (&self.ty, self.scope());
        match &self.attributes.with {
            Some(with) => quote_spanned!(here()=> #with(table, #scope)),
            None => quote_spanned!(here()=>
                <#ty as crate::declaration::DeckKeys<_>>::read_keys(table, #scope)
            ),
        }
    }

    fn read_key(&self) -> TokenStream {
        let (key, ty, scope) = (&self.key, &self.ty, self.scope());
        let (rule, fallback) = (self.rule(), self.fallback());
        let is_bare = self.is_optional && self.attributes.none.is_none();
        let required = quote_spanned!(here()=> table.required(#key).and_then(|item| #rule));
        if self.attributes.or_empty {
            return quote_spanned!(here()=> match table.optional(#key) {
                Some(item) => #rule,
                None => table.table_or_empty(#key).and_then(|table| {
                    <#ty as crate::declaration::DeckTable<_>>::read_table(table, #scope)
                }),
            });
        }
        let Some(value) = fallback else {
            return required;
        };
        let missing = match (&self.attributes.default, &self.attributes.none) {
            (Some(_), Some(word)) => quote_spanned!(here()=> {
                let value = #value;
                table.record_or(#key, value, #word);
                Some(value)
            }),
            (Some(_), None) => quote_spanned!(here()=>
                <#ty as crate::declaration::Fallback<_>>::missing(#value, table, #key, #scope)
            ),
            (None, _) => quote_spanned!(here()=> Some(#value)),
        };
        let wrap = is_bare.then(|| quote_spanned!(here()=> .map(Some)));
        let optional = quote_spanned!(here()=> match table.optional(#key) {
            Some(item) => (#rule) #wrap,
            None => #missing,
        });
        match &self.attributes.required_if {
            Some(condition) => quote_spanned!(here()=> match #condition {
                true => #required #wrap,
                false => #optional,
            }),
            None => optional,
        }
    }

    /// Declares the variables of a value from the code that reads it.
    pub(crate) fn bound(&self, reading: &TokenStream) -> TokenStream {
        let (name, read, whole) = (&self.name, self.read_name(), self.whole());
        quote_spanned!(here()=>
            let #read: ::core::option::Option<#whole> = #reading;
            let #name = #read.as_ref();
        )
    }

    /// Returns the value that was read, or leaves the function.
    pub(crate) fn value(&self) -> TokenStream {
        let read = self.read_name();
        quote_spanned!(here()=> #read?)
    }

    /// Returns the code that checks the value in the variable of the field, a reference.
    pub(crate) fn check(&self) -> TokenStream {
        self.check_as(&self.key)
    }

    /// Returns the code that checks the value as one of the key `key`.
    pub(crate) fn check_as(&self, key: &str) -> TokenStream {
        let (name, ty, scope) = (&self.name, &self.ty, self.scope());
        let own = if let Some(check) = &self.attributes.check {
            quote_spanned!(here()=> #check(value, path, #scope, check);)
        } else if self.attributes.with.is_some() && self.attributes.range.is_none() {
            TokenStream::new()
        } else if self.attributes.flatten {
            quote_spanned!(here()=> crate::declaration::DeckKeys::check_keys(value, path, #scope, check);)
        } else if self.is_measured() {
            let range = self.range();
            quote_spanned!(here()=> <#ty as crate::declaration::Measured<_>>::check(
                value, path.key(#key), #range, #scope, check,
            );)
        } else {
            quote_spanned!(here()=> <#ty as crate::declaration::DeckValue<_>>::check(
                value, path.key(#key), #scope, check,
            );)
        };
        let allowed = self.attributes.allowed.iter().map(|(condition, words)| {
            quote_spanned!(here()=>
                let is_allowed = { let #name = Some(value); #condition };
                check.allowed(is_allowed, path.key(#key), value, #words);
            )
        });
        let accept = self.attributes.accept.as_ref().map(
            |accept| quote_spanned!(here()=> check.engine(path.key(#key), #accept(value, #scope));),
        );
        let checks = quote_spanned!(here()=> #own #(#allowed)* #accept);
        let checks = match (checks.is_empty(), self.is_optional) {
            (true, _) => checks,
            (false, true) => quote_spanned!(here()=> if let Some(value) = #name { #checks }),
            (false, false) => quote_spanned!(here()=> { let value = #name; #checks }),
        };
        quote_spanned!(here()=> #checks let #name = Some(#name);)
    }
}
