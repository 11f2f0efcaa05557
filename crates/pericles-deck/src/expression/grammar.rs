//! Parser of expressions with precise errors. Rewrites an expression with every power in parentheses.

use std::fmt::Write;

use super::{FUNCTIONS, LONGEST, Malformed};
use crate::nearest::nearest;

const CONSTANTS: [&str; 2] = ["pi", "e"];

/// Largest nesting depth of parentheses.
const DEEPEST: usize = 60;

#[derive(Debug, Clone, PartialEq)]
enum Token<'a> {
    /// Text and value.
    Number(&'a str, f64),
    Name(&'a str),
    /// A name in single quotes, which may contain any other character, and its component outside of them.
    Quoted(&'a str),
    /// One of `+ - * / ^ ( )`.
    Sign(char),
}

/// Names that an expression may use for its variables.
enum Variables<'t> {
    /// These names.
    Only(&'t [&'t str]),
    /// Any name; the names found so far. The text refers to them as `v0`, `v1` ….
    Any(Vec<String>),
}

/// Returns the expression with `(base)^(exponent)` for every power and `(-(…))` for every sign.
pub(super) fn group_powers(text: &str, variables: &[&str]) -> Result<String, Malformed> {
    grouped(text, Variables::Only(variables)).map(|(text, _)| text)
}

/// Returns the expression as [`group_powers`], with `v0`, `v1` … in place of its variables, which may have any name,
/// and their names in the order of these numbers.
pub(super) fn group_names(text: &str) -> Result<(String, Vec<String>), Malformed> {
    let (text, variables) = grouped(text, Variables::Any(Vec::new()))?;
    Ok(match variables {
        Variables::Any(names) => (text, names),
        Variables::Only(_) => (text, Vec::new()),
    })
}

fn grouped<'t>(
    text: &'t str,
    variables: Variables<'t>,
) -> Result<(String, Variables<'t>), Malformed> {
    if text.len() > LONGEST {
        return reject(format!(
            "it has {} characters; allowed: at most {LONGEST}",
            text.len()
        ));
    }
    let tokens = tokens(text)?;
    if tokens.is_empty() {
        return reject("it is empty".into());
    }
    let mut reader = Reader {
        tokens: &tokens,
        variables,
        depth: 0,
    };
    let grouped = reader.sum()?;
    match reader.tokens.first() {
        None => Ok((grouped, reader.variables)),
        Some(Token::Sign(')')) => reject("a closing parenthesis has no opening one".into()),
        Some(token) => reject(format!("an operator is missing before {}", shown(token))),
    }
}

fn reject<T>(reason: String) -> Result<T, Malformed> {
    Err(Malformed { reason })
}

fn shown(token: &Token<'_>) -> String {
    match token {
        Token::Number(text, _) | Token::Name(text) | Token::Quoted(text) => format!("`{text}`"),
        Token::Sign(sign) => format!("`{sign}`"),
    }
}

fn tokens(text: &str) -> Result<Vec<Token<'_>>, Malformed> {
    let mut tokens = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '0'..='9' | '.' => number_length(rest),
            c if c.is_ascii_alphabetic() => name_length(rest),
            '+' | '-' | '*' | '/' | '^' | '(' | ')' => 1,
            '\'' => match rest[1..].find('\'') {
                Some(0) => return reject("a name in quotes is empty".into()),
                Some(length) => length + 2 + component_length(&rest[length + 2..]),
                None => return reject("a quote is not closed".into()),
            },
            other => {
                return reject(format!(
                    "it contains `{other}`; allowed: numbers, names, + - * / ^ and parentheses"
                ));
            }
        };
        let (token, tail) = rest.split_at(length);
        tokens.push(match first {
            '0'..='9' | '.' => match token.parse::<f64>() {
                Ok(value) if value.is_finite() => Token::Number(token, value),
                _ => return reject(format!("`{token}` is not a number")),
            },
            c if c.is_ascii_alphabetic() => Token::Name(token),
            '\'' => Token::Quoted(token),
            sign => Token::Sign(sign),
        });
        rest = tail.trim_start();
    }
    Ok(tokens)
}

/// Returns the length of a dot and a name at the start of a text; zero if there are none.
fn component_length(text: &str) -> usize {
    match text.strip_prefix('.').map(name_length) {
        Some(length) if length > 0 => length + 1,
        _ => 0,
    }
}

/// Returns the length of the name at the start of a text: letters, digits, `_`, and dots between them.
fn name_length(text: &str) -> usize {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let end = |&(k, c): &(usize, char)| match c {
        '.' => !text[k + 1..].starts_with(is_part),
        c => !is_part(c),
    };
    let mut letters = text.char_indices();
    letters.find(end).map_or(text.len(), |(k, _)| k)
}

/// Returns the length of a number: digits, a point, digits, and an exponent if digits follow it.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        bytes[from..]
            .iter()
            .take_while(|b| b.is_ascii_digit())
            .count()
    };
    let mut length = digits(0);
    if bytes.get(length) == Some(&b'.') {
        length += 1 + digits(length + 1);
    }
    if matches!(bytes.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        let exponent = digits((length + 1 + sign).min(bytes.len()));
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}

struct Reader<'r, 't> {
    tokens: &'r [Token<'t>],
    variables: Variables<'t>,
    depth: usize,
}

impl Reader<'_, '_> {
    fn take_sign(&mut self, signs: &[char]) -> Option<char> {
        match self.tokens {
            [Token::Sign(sign), rest @ ..] if signs.contains(sign) => {
                self.tokens = rest;
                Some(*sign)
            }
            _ => None,
        }
    }

    /// Grammar: term (± term)*
    fn sum(&mut self) -> Result<String, Malformed> {
        let mut text = self.product()?;
        while let Some(sign) = self.take_sign(&['+', '-']) {
            let term = self.product()?;
            let _ = write!(text, "{sign}{term}");
        }
        Ok(text)
    }

    /// Grammar: signed (×÷ signed)*, from left to right
    fn product(&mut self) -> Result<String, Malformed> {
        let mut text = self.signed()?;
        while let Some(sign) = self.take_sign(&['*', '/']) {
            let factor = self.signed()?;
            text = format!("({text}{sign}{factor})");
        }
        Ok(text)
    }

    /// Grammar: ± signed, or a power
    fn signed(&mut self) -> Result<String, Malformed> {
        self.deeper(|reader| match reader.take_sign(&['+', '-']) {
            Some('-') => Ok(format!("(-({}))", reader.signed()?)),
            Some(_) => reader.signed(),
            None => reader.power(),
        })
    }

    /// Grammar: value, or value ^ signed
    fn power(&mut self) -> Result<String, Malformed> {
        let base = self.value()?;
        match self.take_sign(&['^']) {
            None => Ok(base),
            Some(_) => Ok(format!("(({base})^({}))", self.signed()?)),
        }
    }

    fn value(&mut self) -> Result<String, Malformed> {
        let Some((token, rest)) = self.tokens.split_first() else {
            return reject("it ends where a value is expected".into());
        };
        self.tokens = rest;
        match token {
            // Written without an exponent, which exmex does not read in all cases.
            Token::Number(_, value) => Ok(format!("{value}")),
            Token::Name(name) => self.named(name),
            Token::Quoted(text) => self.variable(&text.replace('\'', "")),
            Token::Sign('(') => self.parenthesis(),
            Token::Sign(sign) => reject(format!("a value is missing before `{sign}`")),
        }
    }

    fn parenthesis(&mut self) -> Result<String, Malformed> {
        let inner = self.deeper(Self::sum)?;
        match self.tokens.first() {
            Some(Token::Sign(')')) => {
                self.tokens = &self.tokens[1..];
                Ok(format!("({inner})"))
            }
            Some(token) => reject(format!("an operator is missing before {}", shown(token))),
            None => reject("a parenthesis is not closed".into()),
        }
    }

    fn named(&mut self, name: &str) -> Result<String, Malformed> {
        if FUNCTIONS.contains(&name) {
            return match self.take_sign(&['(']) {
                Some(_) => Ok(format!("{name}{}", self.parenthesis()?)),
                None => reject(format!(
                    "the function `{name}` needs its argument in parentheses"
                )),
            };
        }
        if CONSTANTS.contains(&name) {
            return Ok(name.to_owned());
        }
        self.variable(name)
    }

    fn variable(&mut self, name: &str) -> Result<String, Malformed> {
        let is_called = self.tokens.first() == Some(&Token::Sign('('));
        let allowed = match &mut self.variables {
            Variables::Only(names) if names.contains(&name) => return Ok(name.to_owned()),
            Variables::Only(names) => *names,
            // An unknown function.
            Variables::Any(_) if is_called => &[],
            Variables::Any(names) => {
                let number = names.iter().position(|known| known == name);
                let number = number.unwrap_or_else(|| {
                    names.push(name.to_owned());
                    names.len() - 1
                });
                return Ok(format!("v{number}"));
            }
        };
        let known = allowed.iter().copied().chain(CONSTANTS).chain(FUNCTIONS);
        let hint = nearest(name, known)
            .map_or_else(String::new, |near| format!("; did you mean `{near}`?"));
        let variables = match allowed {
            [] => "none".to_owned(),
            names => names.join(", "),
        };
        reject(format!(
            "unknown name `{name}`{hint} Variables: {variables}; constants: {}; functions: {}",
            CONSTANTS.join(", "),
            FUNCTIONS.join(", ")
        ))
    }

    fn deeper(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<String, Malformed>,
    ) -> Result<String, Malformed> {
        if self.depth == DEEPEST {
            return reject(format!("it is nested more than {DEEPEST} deep"));
        }
        self.depth += 1;
        let read = read(self);
        self.depth -= 1;
        read
    }
}
