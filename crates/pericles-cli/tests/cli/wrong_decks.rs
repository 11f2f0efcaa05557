//! Complete error output for the invalid decks in `tests/wrong/`.
//!
//! A deck begins with a sentence about its mistake, and with the command line if it is not `pericles check DECK`. The
//! file `.answer` beside it has the exit status and the output. After a change of messages, regenerate these files
//! with `PERICLES_REWRITE=1 cargo test --workspace --test cli wrong_decks` and read them.

use std::fs;
use std::path::Path;

use crate::common::{run, text};

fn answer(folder: &Path, deck: &Path) -> String {
    let name = deck.file_name().unwrap().to_str().unwrap();
    let content = fs::read_to_string(deck).unwrap();
    let line = content.lines().nth(1).unwrap_or_default();
    let check = format!("check {name} --threads 1");
    let arguments = line.strip_prefix("# pericles ").unwrap_or(&check);
    let output = run(folder, arguments);
    let status = output.status.code().unwrap();
    format!("exit status {status}\n{}", text(&output.stderr))
}

#[test]
fn messages_of_invalid_decks_match_the_answer_files() {
    let rewrite = std::env::var_os("PERICLES_REWRITE").is_some();
    let wrong = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/wrong");
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("results")).unwrap();
    let mut decks = Vec::new();
    for entry in fs::read_dir(&wrong).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_owned();
        if path.extension().unwrap() != "answer" {
            fs::copy(&path, folder.path().join(name)).unwrap();
        }
        if path.extension().unwrap() == "toml" {
            decks.push(path);
        }
    }
    assert!(decks.len() >= 20);
    decks.sort();
    let mut different = String::new();
    for deck in decks {
        let path = deck.with_extension("answer");
        let answer = answer(folder.path(), &deck);
        if rewrite {
            fs::write(&path, &answer).unwrap();
            continue;
        }
        let expected = fs::read_to_string(&path).unwrap_or_default();
        if answer != expected {
            different += &format!(
                "{}\n--- expected\n{expected}--- found\n{answer}\n",
                deck.display()
            );
        }
    }
    assert!(different.is_empty(), "{different}");
}
