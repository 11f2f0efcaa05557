//! Attributes `#[deck(…)]` and documentation of types, variants and fields.

use proc_macro2::{TokenStream, TokenTree};
use quote::ToTokens;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{
    Attribute, Expr, Ident, Lit, LitStr, Meta, Path, Result, Token, Type, meta::ParseNestedMeta,
    parenthesized,
};

/// An expression, up to the next comma; the compiler checks it where it is used.
#[derive(Clone)]
pub(crate) struct Code(TokenStream);

impl Parse for Code {
    fn parse(input: ParseStream<'_>) -> Result<Self> {
        let mut code = TokenStream::new();
        while !input.is_empty() && !input.peek(Token![,]) {
            code.extend([input.parse::<TokenTree>()?]);
        }
        match code.is_empty() {
            true => Err(input.error("expected an expression")),
            false => Ok(Self(code)),
        }
    }
}

impl ToTokens for Code {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        self.0.to_tokens(tokens);
    }
}

/// What a default is.
pub(crate) enum Fallback {
    /// The default of the type.
    OfType,
    /// The value of an expression.
    Value(Code),
}

/// All attributes of a type, variant or field.
#[derive(Default)]
pub(crate) struct Attributes {
    /// The first paragraph of the documentation.
    pub(crate) about: String,
    pub(crate) quantity: Option<Code>,
    pub(crate) range: Option<Code>,
    pub(crate) default: Option<Fallback>,
    /// The key or word.
    pub(crate) name: Option<String>,
    pub(crate) with: Option<Code>,
    pub(crate) check: Option<Path>,
    /// A function of the value and the scope whose error is reported.
    pub(crate) accept: Option<Path>,
    pub(crate) flatten: bool,
    /// The keys that a reader of the table reads.
    pub(crate) keys: Option<Vec<LitStr>>,
    /// The word for `None`.
    pub(crate) none: Option<Code>,
    /// Whether a missing table is read as an empty one.
    pub(crate) or_empty: bool,
    pub(crate) required: bool,
    pub(crate) required_if: Option<Code>,
    /// The scope of a value, an expression.
    pub(crate) scope: Option<Code>,
    /// The type of the scope.
    pub(crate) scope_type: Option<Type>,
    /// Conditions under which a key is not allowed, with the reasons.
    pub(crate) forbidden: Vec<(Code, Code)>,
    /// Conditions that a value satisfies, with what is allowed.
    pub(crate) allowed: Vec<(Code, Code)>,
    /// Why other variants do not have the key.
    pub(crate) otherwise: Option<Code>,
    /// The type that a struct or enum declares, if it is not the struct or enum itself.
    pub(crate) remote: Option<Path>,
    /// The name of the definition of the table, or of the value of a variant's key.
    pub(crate) define: Option<LitStr>,
    /// A function that checks the values of a table together.
    pub(crate) verify: Option<Path>,
    /// A word that may replace a table, with its value.
    pub(crate) word: Option<(Code, Code)>,
    /// Groups of keys, with the function of a table that reads which of them are given.
    pub(crate) groups: Vec<(Ident, Vec<LitStr>)>,
    /// The key whose texts are unique in a list of tables, with what a table is called.
    pub(crate) unique: Option<(String, String)>,
    pub(crate) tag: Option<LitStr>,
    /// The description of a tag, if it is not the documentation of the enum.
    pub(crate) tag_about: Option<LitStr>,
    pub(crate) what: Option<LitStr>,
    pub(crate) exclusive: bool,
    pub(crate) table: bool,
}

/// Names of the attributes of fields.
pub(crate) const OF_FIELD: &[&str] = &[
    "quantity",
    "range",
    "default",
    "none",
    "or_empty",
    "required",
    "required_if",
    "key",
    "with",
    "check",
    "accept",
    "flatten",
    "keys",
    "scope",
    "forbid_if",
    "allow_if",
    "otherwise",
];
/// Names of the attributes of variants.
pub(crate) const OF_VARIANT: &[&str] = &["word", "key", "table", "define", "allow_if"];
/// Names of the attributes of structs.
pub(crate) const OF_STRUCT: &[&str] = &[
    "scope",
    "remote",
    "default",
    "define",
    "at_least_one",
    "at_most_one",
    "exactly_one",
    "unique",
    "verify",
    "word_for",
];
/// Names of the attributes of enums.
pub(crate) const OF_ENUM: &[&str] = &[
    "scope",
    "remote",
    "default",
    "define",
    "tag",
    "tag_about",
    "what",
    "exclusive",
];

impl Attributes {
    /// Reads attributes, of which `allowed` lists the names.
    pub(crate) fn of(attributes: &[Attribute], allowed: &[&str]) -> Result<Self> {
        let mut found = Self {
            about: first_paragraph(attributes),
            ..Self::default()
        };
        for attribute in attributes {
            if attribute.path().is_ident("default") {
                found.default = Some(Fallback::OfType);
            }
            if attribute.path().is_ident("deck") {
                attribute.parse_nested_meta(|meta| found.read(&meta, allowed))?;
            }
        }
        Ok(found)
    }

    fn read(&mut self, meta: &ParseNestedMeta<'_>, allowed: &[&str]) -> Result<()> {
        let name = meta.path.require_ident()?.to_string();
        if !allowed.contains(&name.as_str()) {
            let allowed = allowed.join(", ");
            return Err(meta.error(format!("unknown attribute; allowed here: {allowed}")));
        }
        match name.as_str() {
            "quantity" => self.quantity = Some(value(meta)?),
            "range" => self.range = Some(value(meta)?),
            "default" if meta.input.peek(Token![=]) => {
                self.default = Some(Fallback::Value(value(meta)?));
            }
            "default" => self.default = Some(Fallback::OfType),
            "key" | "word" => self.name = Some(value::<LitStr>(meta)?.value()),
            "none" => self.none = Some(value(meta)?),
            "with" => self.with = Some(value(meta)?),
            "check" => self.check = Some(value(meta)?),
            "accept" => self.accept = Some(value(meta)?),
            "flatten" => self.flatten = true,
            "or_empty" => self.or_empty = true,
            "required" => self.required = true,
            "remote" => self.remote = Some(value(meta)?),
            // Types of scopes have lifetimes, expressions of scopes have calls.
            "scope" if allowed.contains(&"quantity") => self.scope = Some(value(meta)?),
            "scope" => self.scope_type = Some(value(meta)?),
            "otherwise" => self.otherwise = Some(value(meta)?),
            "tag" => self.tag = Some(value(meta)?),
            "tag_about" => self.tag_about = Some(value(meta)?),
            "what" => self.what = Some(value(meta)?),
            "exclusive" => self.exclusive = true,
            "table" => self.table = true,
            "keys" => self.keys = Some(words(meta)?),
            "unique" => match &words(meta)?[..] {
                [key, table] => self.unique = Some((key.value(), table.value())),
                _ => return Err(meta.error("expected unique(\"key\", \"name of the table\")")),
            },
            "at_least_one" | "at_most_one" | "exactly_one" => {
                let function = meta.path.require_ident()?.clone();
                self.groups.push((function, words(meta)?));
            }
            "required_if" => {
                let inner;
                parenthesized!(inner in meta.input);
                self.required_if = Some(inner.parse()?);
            }
            "define" => self.define = Some(value(meta)?),
            "verify" => self.verify = Some(value(meta)?),
            "word_for" => self.word = Some(condition(meta)?),
            "forbid_if" => self.forbidden.push(condition(meta)?),
            _ => self.allowed.push(condition(meta)?),
        }
        Ok(())
    }
}

fn value<T: Parse>(meta: &ParseNestedMeta<'_>) -> Result<T> {
    meta.value()?.parse()
}

/// Reads `("word", "word")`.
fn words(meta: &ParseNestedMeta<'_>) -> Result<Vec<LitStr>> {
    let inner;
    parenthesized!(inner in meta.input);
    let words = Punctuated::<LitStr, Token![,]>::parse_terminated(&inner)?;
    Ok(words.into_iter().collect())
}

/// Reads `(condition, "text")`.
fn condition(meta: &ParseNestedMeta<'_>) -> Result<(Code, Code)> {
    let inner;
    parenthesized!(inner in meta.input);
    let condition = inner.parse()?;
    inner.parse::<Token![,]>()?;
    Ok((condition, inner.parse()?))
}

/// Returns the first paragraph of the documentation, in one line.
fn first_paragraph(attributes: &[Attribute]) -> String {
    let lines = attributes.iter().filter_map(|attribute| {
        let Meta::NameValue(pair) = &attribute.meta else {
            return None;
        };
        let Expr::Lit(literal) = &pair.value else {
            return None;
        };
        match &literal.lit {
            Lit::Str(text) if pair.path.is_ident("doc") => Some(text.value().trim().to_owned()),
            _ => None,
        }
    });
    let lines: Vec<String> = lines.take_while(|line| !line.is_empty()).collect();
    lines.join(" ")
}
