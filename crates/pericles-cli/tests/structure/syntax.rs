//! A minimal parser for the imports of a Rust file: tokens, `use` declarations, paths.

/// A token with its line number, from 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Token {
    pub text: String,
    pub line: usize,
}

impl Token {
    fn is(&self, text: &str) -> bool {
        self.text == text
    }

    fn is_name(&self) -> bool {
        self.text
            .starts_with(|c: char| c.is_alphabetic() || c == '_')
    }
}

/// A path in the text, such as `crate::grid::Block` or, of `use super::*`, `super` with `glob`.
#[derive(Clone, Debug, PartialEq)]
pub struct Import {
    pub path: Vec<String>,
    /// The name under which a `use` declaration at the top level of the file imports the item; empty for a glob.
    pub name: Option<String>,
    pub line: usize,
}

impl Import {
    pub fn is_glob(&self) -> bool {
        self.name.as_deref() == Some("")
    }
}

/// Returns the tokens of `text` without comments, visibilities, string and character literals, lifetimes, and items
/// with `#[cfg(test)]`.
pub fn tokens(text: &str) -> Vec<Token> {
    without_tests(&raw_tokens(text))
}

fn raw_tokens(text: &str) -> Vec<Token> {
    let chars: Vec<char> = text.chars().collect();
    let at = |i: usize| chars.get(i).copied().unwrap_or('\0');
    let (mut found, mut i, mut line) = (Vec::new(), 0, 1);
    while i < chars.len() {
        let start = i;
        let mut token = None;
        match chars[i] {
            '/' if at(i + 1) == '/' => {
                while i < chars.len() && chars[i] != '\n' {
                    i += 1;
                }
            }
            '/' if at(i + 1) == '*' => i = end_of_comment(&chars, i),
            '"' => i = end_of_string(&chars, i),
            '\'' if at(i + 1) == '\\' => {
                i += 3;
                while i < chars.len() && chars[i] != '\'' {
                    i += 1;
                }
                i += 1;
            }
            '\'' if at(i + 2) == '\'' => i += 3,
            '\'' => {
                i += 1;
                while at(i).is_alphanumeric() || at(i) == '_' {
                    i += 1;
                }
            }
            ':' if at(i + 1) == ':' => {
                i += 2;
                token = Some("::".to_owned());
            }
            c if c.is_alphanumeric() || c == '_' => {
                while at(i).is_alphanumeric() || at(i) == '_' {
                    i += 1;
                }
                let word: String = chars[start..i].iter().collect();
                match (word.as_str(), at(i)) {
                    ("r" | "br" | "cr", '"' | '#')
                        if !at(i + 1).is_alphabetic() || at(i) == '"' =>
                    {
                        i = end_of_raw_string(&chars, i);
                    }
                    ("r", '#') => i += 1,
                    ("b" | "c", '"') | ("b", '\'') => {}
                    _ => token = Some(word),
                }
            }
            c => {
                i += 1;
                token = (!c.is_whitespace()).then(|| c.to_string());
            }
        }
        i = i.min(chars.len());
        found.extend(token.map(|text| Token { text, line }));
        line += chars[start..i].iter().filter(|&&c| c == '\n').count();
    }
    found
}

fn end_of_comment(chars: &[char], mut i: usize) -> usize {
    let mut depth = 0;
    while i + 1 < chars.len() {
        match (chars[i], chars[i + 1]) {
            ('/', '*') => (depth, i) = (depth + 1, i + 2),
            ('*', '/') => (depth, i) = (depth - 1, i + 2),
            _ => i += 1,
        }
        if depth == 0 {
            return i;
        }
    }
    chars.len()
}

fn end_of_string(chars: &[char], mut i: usize) -> usize {
    i += 1;
    while i < chars.len() && chars[i] != '"' {
        i += if chars[i] == '\\' { 2 } else { 1 };
    }
    i + 1
}

/// Returns the end of the raw string whose first `#` or quotation mark is at `i`.
fn end_of_raw_string(chars: &[char], mut i: usize) -> usize {
    let hashes = chars[i..].iter().take_while(|&&c| c == '#').count();
    i += hashes + 1;
    while i < chars.len() {
        if chars[i] == '"'
            && chars[i + 1..]
                .iter()
                .take(hashes)
                .filter(|&&c| c == '#')
                .count()
                == hashes
        {
            return i + 1 + hashes;
        }
        i += 1;
    }
    i
}

/// Returns the index after the bracket that closes the one at `i`.
fn behind_bracket(tokens: &[Token], i: usize) -> usize {
    let mut depth = 0;
    for (k, token) in tokens.iter().enumerate().skip(i) {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return k + 1;
        }
    }
    tokens.len()
}

fn without_tests(tokens: &[Token]) -> Vec<Token> {
    let (mut kept, mut i) = (Vec::new(), 0);
    while i < tokens.len() {
        let next = |k: usize| tokens.get(i + k).map_or("", |token| token.text.as_str());
        match (next(0), next(1), next(2)) {
            ("#", "[", "cfg") if is_cfg_test(&tokens[i..]) => {
                i = behind_item(tokens, behind_bracket(tokens, i + 1));
            }
            ("pub", "(", "crate" | "super" | "self" | "in") => i = behind_bracket(tokens, i + 1),
            _ => {
                kept.push(tokens[i].clone());
                i += 1;
            }
        }
    }
    kept
}

fn is_cfg_test(tokens: &[Token]) -> bool {
    let words = ["#", "[", "cfg", "(", "test", ")", "]"];
    words.len() <= tokens.len() && words.iter().zip(tokens).all(|(word, token)| token.is(word))
}

/// Returns the index after the item, field or statement that starts at `i`.
fn behind_item(tokens: &[Token], mut i: usize) -> usize {
    let words = [
        "mod", "fn", "use", "impl", "struct", "enum", "const", "static", "type", "trait",
    ];
    let mut is_item = false;
    while i < tokens.len() {
        match tokens[i].text.as_str() {
            "#" => i = behind_bracket(tokens, i + 1),
            "{" if is_item => return behind_bracket(tokens, i),
            "(" | "[" | "{" => i = behind_bracket(tokens, i),
            ";" => return i + 1,
            "," if !is_item => return i + 1,
            ")" | "]" | "}" => return i,
            word => {
                is_item |= words.contains(&word);
                i += 1;
            }
        }
    }
    i
}

/// Returns the modules that a file declares outside of tests.
pub fn declared_modules(tokens: &[Token]) -> Vec<String> {
    let declarations = tokens
        .windows(3)
        .filter(|w| w[0].is("mod") && w[1].is_name() && w[2].is(";"));
    declarations.map(|w| w[1].text.clone()).collect()
}

/// Returns the imports of `use` declarations and the paths in the code of a file.
pub fn imports(tokens: &[Token]) -> Vec<Import> {
    let (mut found, mut i, mut depth) = (Vec::new(), 0, 0);
    while i < tokens.len() {
        let token = &tokens[i];
        match token.text.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            "use" if !tokens.get(i + 1).is_some_and(|next| next.is("<")) => {
                let first = found.len();
                i = use_tree(tokens, i + 1, &[], &mut found);
                if depth > 0 {
                    found[first..]
                        .iter_mut()
                        .filter(|import| !import.is_glob())
                        .for_each(|import| import.name = None);
                }
                continue;
            }
            _ if token.is_name()
                && !(i > 0 && (tokens[i - 1].is("::") || tokens[i - 1].is("."))) =>
            {
                let mut path = vec![token.text.clone()];
                while i + 2 < tokens.len() && tokens[i + 1].is("::") && tokens[i + 2].is_name() {
                    path.push(tokens[i + 2].text.clone());
                    i += 2;
                }
                found.push(Import {
                    path,
                    name: None,
                    line: token.line,
                });
            }
            _ => {}
        }
        i += 1;
    }
    found
}

/// Parses the `use` tree at `i` below `prefix` and returns the index after it.
fn use_tree(tokens: &[Token], mut i: usize, prefix: &[String], found: &mut Vec<Import>) -> usize {
    let mut path = prefix.to_vec();
    while i < tokens.len() {
        let line = tokens[i].line;
        match tokens[i].text.as_str() {
            "{" => {
                i += 1;
                while i < tokens.len() && !tokens[i].is("}") {
                    i = use_tree(tokens, i, &path, found);
                    i += usize::from(tokens.get(i).is_some_and(|token| token.is(",")));
                }
                return i + 1;
            }
            "*" => {
                found.push(Import {
                    path,
                    name: Some(String::new()),
                    line,
                });
                return i + 1;
            }
            "::" if path.is_empty() => path.push(String::new()),
            "::" => {}
            // `use crate::grid::{self, Block}`
            "self" if !path.is_empty() => {}
            word => path.push(word.to_owned()),
        }
        i += 1;
        let next = |k: usize| tokens.get(i + k).map_or("", |token| token.text.as_str());
        if next(0) == "::" || tokens[i - 1].is("::") {
            continue;
        }
        let (name, behind) = match next(0) {
            "as" => (next(1).to_owned(), i + 2),
            _ => (path.last().cloned().unwrap_or_default(), i),
        };
        found.push(Import {
            path,
            name: Some(name),
            line,
        });
        return behind;
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths(text: &str) -> Vec<String> {
        let found = imports(&tokens(text))
            .into_iter()
            .filter(|import| import.path.len() > 1);
        found.map(|import| import.path.join("::")).collect()
    }

    #[test]
    fn comments_strings_and_visibilities_are_ignored() {
        let text = r##"
            // use crate::a::A;
            /* use crate::b::B; /* crate::c::C */ crate::d::D */
            #[error("crate::e::E", crate::l::L(0))]
            pub(in crate::f) const TEXT: &str = "crate::g::G \" crate::h::H";
            const RAW: &str = r#"crate::i::I" crate::j::J"#;
            const MARK: char = '"'; // "
            fn of<'a>(x: &'a str) -> char { '\'' }
            const LAST: u8 = crate::k::K;
        "##;
        assert_eq!(paths(text), ["crate::l::L", "crate::k::K"]);
    }

    #[test]
    fn use_declarations_are_read_as_trees() {
        let text = "use super::{a::{self, A, B as C}, d::*};\npub use crate::e;";
        let found = imports(&tokens(text));
        let read: Vec<(String, &str, usize)> = found
            .iter()
            .filter_map(|import| {
                Some((import.path.join("::"), import.name.as_deref()?, import.line))
            })
            .collect();
        let expected = [
            ("super::a", "a", 1),
            ("super::a::A", "A", 1),
            ("super::a::B", "C", 1),
            ("super::d", "", 1),
            ("crate::e", "e", 2),
        ];
        assert_eq!(
            read,
            expected.map(|(path, name, line)| (path.to_owned(), name, line))
        );
    }

    #[test]
    fn test_modules_are_ignored() {
        let text = "
            mod a;
            #[cfg(test)]
            mod b;
            #[cfg(test)]
            mod tests { use super::c::C; fn f() { crate::d::D } }
            struct S { #[cfg(test)] visited: crate::e::E, field: crate::f::F }
        ";
        assert_eq!(declared_modules(&tokens(text)), ["a"]);
        assert_eq!(paths(text), ["crate::f::F"]);
    }
}
