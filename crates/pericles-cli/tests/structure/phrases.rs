//! Phrases that the texts of the project avoid: messages, documentation and comments use the terms of the glossary.

use std::fs;
use std::path::{Path, PathBuf};

/// A phrase and what to write instead. Phrases are compared in lower case and at word boundaries.
const PHRASES: &[(&str, &str)] = &[
    ("bonds that are none", "not available"),
    ("but for", "except, to within"),
    ("by the clock", "wall-clock time"),
    ("cannot be had", "is not available"),
    ("cells longer along one axis", "anisotropic spacing"),
    ("course of time", "time function, time history"),
    ("dear to compute", "expensive to compute"),
    ("decide alike", "reach the same decision"),
    ("drawn again", "re-rendered"),
    ("energy account", "energy balance"),
    ("energy from nowhere", "spurious energy"),
    ("exists already", "already exists"),
    ("for ever", "infinite, semi-infinite"),
    ("for people", "name the reader, or delete"),
    ("go on with", "resume, continue"),
    ("goes on with", "resumes, continues"),
    ("going on", "in progress"),
    ("gone on", "continued"),
    ("hang together", "connected"),
    ("hangs together", "connected"),
    ("has no place in", "is not allowed in"),
    ("how the two talk", "coupling"),
    ("in letters", "terminal plot"),
    ("in masses", "most bonds"),
    ("in pieces", "disconnected"),
    ("is no number", "is not a number, NaN"),
    ("is no state", "is not saved"),
    ("it pays", "net speed-up"),
    ("knows no", "does not contain, has no"),
    ("knows nothing", "is independent of"),
    ("let waves leave", "absorbing boundary"),
    ("lets waves leave", "absorbing boundary"),
    ("mirror image but", "mirror symmetry"),
    ("nobody", "name the subject"),
    ("numbers that are none", "NaN or infinity"),
    ("out of balance", "residual"),
    ("seed of strange", "random seed"),
    ("slip of the pen", "typo"),
    ("slips of the pen", "typos"),
    ("the loop, written once", "time loop"),
    ("told", "reported, printed, returned"),
    (
        "turn over triangles",
        "fix inconsistent triangle orientation",
    ),
    ("what is out of", "name the quantity"),
    ("what there is says", "name the command"),
    ("what there is", "name the thing"),
];

/// Files that name the phrases.
const LEFT_OUT: &[&str] = &[
    "CONTRIBUTING.md",
    "book/src/reference/glossary.md",
    "crates/pericles-cli/tests/structure/phrases.rs",
];

/// Returns a line for each phrase found in the texts below `root`.
pub(crate) fn found(root: &Path) -> Vec<String> {
    let mut files = Vec::new();
    for part in ["README.md", "ARCHITECTURE.md", "book", "crates", "examples"] {
        collect(&root.join(part), &mut files);
    }
    files.sort();
    let mut findings = Vec::new();
    for file in files {
        let name = file.strip_prefix(root).unwrap_or(&file).display();
        let name = name.to_string().replace('\\', "/");
        // Pages with tables are generated from data, which are checked themselves.
        if LEFT_OUT.contains(&name.as_str()) || name.starts_with("book/src/verification/") {
            continue;
        }
        let Ok(content) = fs::read_to_string(&file) else {
            continue;
        };
        for (number, line) in content.lines().enumerate() {
            let text = match name.ends_with(".rs") {
                true => texts_of_rust(line),
                false => line.to_owned(),
            };
            let text = text.to_lowercase();
            for (phrase, instead) in PHRASES {
                if contains(&text, phrase) {
                    findings.push(format!(
                        "{name}:{}: \"{phrase}\"; write: {instead}",
                        number + 1
                    ));
                }
            }
        }
    }
    findings
}

fn collect(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_dir() && !path.is_symlink() {
        let entries = fs::read_dir(path).into_iter().flatten().flatten();
        for entry in entries {
            collect(&entry.path(), files);
        }
        return;
    }
    let ending = path.extension().unwrap_or_default();
    if ["rs", "md", "toml"].iter().any(|known| ending == *known) {
        files.push(path.to_owned());
    }
}

/// Returns the string literals and comments of a line of Rust; literals over several lines count as text from their first
/// quotation mark on.
fn texts_of_rust(line: &str) -> String {
    let mut texts = String::new();
    let (mut in_text, mut before) = (false, ' ');
    for (place, c) in line.char_indices() {
        if !in_text && c == '/' && line[place..].starts_with("//") {
            texts += &line[place..];
            break;
        }
        if c == '"' && before != '\\' && before != '\'' {
            in_text = !in_text;
            texts.push(' ');
        } else if in_text {
            texts.push(c);
        }
        before = if before == '\\' && c == '\\' { ' ' } else { c };
    }
    texts
}

/// Returns whether a phrase occurs at word boundaries.
fn contains(text: &str, phrase: &str) -> bool {
    text.match_indices(phrase).any(|(place, _)| {
        let is_word = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
        // `{told}` is a variable.
        let before = text[..place].chars().next_back().map(|c| match c {
            '{' => '_',
            other => other,
        });
        let after = text[place + phrase.len()..].chars().next();
        !is_word(before) && !is_word(after)
    })
}

#[test]
fn phrases_are_found_in_texts_and_comments_only_at_word_boundaries() {
    let line = r#"    let told = format!("is told {x}"); // nobody"#;
    let texts = texts_of_rust(line);
    assert!(contains(&texts, "told") && contains(&texts, "nobody"));
    assert!(!contains(&texts_of_rust("let told = 1;"), "told"));
    assert!(!contains("the threshold is untold_x", "told"));
    assert!(contains(&texts_of_rust(r#"say("a \" told")"#), "told"));
}
