//! `new`: list or copy the built-in example decks.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::{fs, str};

use pericles_io::IoError;
use pericles_run::RunError;

use crate::args::NewArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// A file under `examples/`.
struct File {
    topic: &'static str,
    name: &'static str,
    content: &'static [u8],
}

/// All files except pages and expected values, by topic and name.
const FILES: &[File] = include!(concat!(env!("OUT_DIR"), "/examples.rs"));

/// An example deck.
struct Example {
    file: &'static File,
    text: &'static str,
}

impl Example {
    fn all() -> impl Iterator<Item = Self> {
        FILES.iter().filter_map(|file| {
            let text = str::from_utf8(file.content).ok()?;
            file.name.ends_with(".toml").then_some(Self { file, text })
        })
    }

    /// Returns `topic/name` without the extension.
    fn id(&self) -> String {
        let name = self.file.name.trim_end_matches(".toml");
        format!("{}/{name}", self.file.topic)
    }

    /// Returns the first line of the deck, which describes it.
    fn sentence(&self) -> &'static str {
        let first = self.text.lines().next().unwrap_or_default();
        first.trim_start_matches(['#', ' '])
    }

    /// Returns the files that the deck reads: meshes, points, tables.
    fn companions(&self) -> impl Iterator<Item = &'static File> {
        let (topic, text) = (self.file.topic, self.text);
        FILES.iter().filter(move |file| {
            file.topic == topic && !file.name.ends_with(".toml") && text.contains(file.name)
        })
    }
}

/// Lists the examples, or copies one with the files it reads.
///
/// # Errors
/// The example is unknown, or a file already exists or cannot be written.
pub(crate) fn new(args: &NewArgs) -> Result<Exit, CliError> {
    let Some(id) = &args.example else {
        return list();
    };
    let example = find(id)?;
    if args.file.as_deref() == Some(Path::new("-")) {
        console::print(format_args!("{}", example.text.trim_end()))?;
        return Ok(Exit::Done);
    }
    let deck = match &args.file {
        Some(path) => path.clone(),
        None => PathBuf::from(example.file.name),
    };
    let folder = deck.parent().unwrap_or(Path::new(""));
    let companions: Vec<_> = example
        .companions()
        .map(|file| (folder.join(file.name), file.content))
        .collect();
    // All or nothing: the deck needs its files.
    let taken = companions.iter().map(|(path, _)| path).chain([&deck]);
    if let Some(path) = taken.into_iter().find(|path| path.exists()) {
        return Err(CliError::FileExists { path: path.clone() });
    }
    for (path, content) in &companions {
        write(path, content)?;
    }
    write(&deck, example.text.as_bytes())?;
    let deck = deck.display();
    console::print(format_args!(
        "{deck}: {}\nEdit it, then run `pericles check {deck}` and `pericles run {deck}`.",
        example.sentence()
    ))?;
    Ok(Exit::Done)
}

fn list() -> Result<Exit, CliError> {
    let width = Example::all().map(|example| example.id().len()).max();
    let mut text = String::new();
    for example in Example::all() {
        let (id, width) = (example.id(), width.unwrap_or_default());
        text += &format!("{id:<width$}  {}\n", example.sentence());
    }
    console::print(format_args!(
        "{text}\nCopy one to the current folder with `pericles new NAME`, such as `pericles new {}`.",
        Example::all().next().map(|e| e.id()).unwrap_or_default()
    ))?;
    Ok(Exit::Done)
}

/// Returns the example that a path may refer to.
pub(crate) fn id_of(path: &str) -> Option<String> {
    let wanted = path.trim_start_matches("examples/");
    find(wanted).ok().map(|example| example.id())
}

fn find(id: &str) -> Result<Example, RunError> {
    let wanted = id.trim_end_matches(".toml");
    // The name alone suffices if it is unique.
    let named = |example: &Example| {
        example.id() == wanted || example.file.name.trim_end_matches(".toml") == wanted
    };
    let mut found: Vec<Example> = Example::all().filter(named).collect();
    let all = "list all examples with `pericles new`";
    if found.len() > 1 {
        let ids: Vec<String> = found.iter().map(Example::id).collect();
        return Err(RunError::Unknown {
            kind: "unique example",
            name: id.to_owned(),
            hint: format!("did you mean {}? {all}", ids.join(" or ")),
        });
    }
    if let Some(example) = found.pop() {
        return Ok(example);
    }
    let ids = Example::all().map(|example| example.id());
    Err(RunError::unknown("example", id, ids, all))
}

/// Writes a new file.
fn write(path: &Path, content: &[u8]) -> Result<(), CliError> {
    let written = fs::OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(path)
        .and_then(|mut file| file.write_all(content));
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => CliError::FileExists { path: path.into() },
        _ => IoError::writing(path, error).into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_deck_is_built_in_and_starts_with_a_description() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
        let mut decks = 0;
        for topic in fs::read_dir(&root).unwrap() {
            let topic = topic.unwrap().path();
            if !topic.is_dir() {
                continue;
            }
            for file in fs::read_dir(topic).unwrap() {
                let path = file.unwrap().path();
                let name = path.file_name().unwrap().to_str().unwrap();
                if name.ends_with(".toml") && name != "expected.toml" {
                    let inside = Example::all().find(|example| {
                        path.ends_with(Path::new(example.file.topic).join(example.file.name))
                    });
                    let example = inside.unwrap_or_else(|| panic!("{}", path.display()));
                    assert_eq!(fs::read(&path).unwrap(), example.file.content);
                    assert!(example.text.starts_with("# "), "{}", example.id());
                    decks += 1;
                }
            }
        }
        assert_eq!(Example::all().count(), decks);
        assert!(decks >= 13);
    }

    #[test]
    fn examples_are_found_with_and_without_topic_and_typos_lead_to_suggestions() {
        assert_eq!(
            find("fracture/branching").map(|e| e.id()).unwrap(),
            "fracture/branching"
        );
        assert_eq!(
            find("branching.toml").map(|e| e.id()).unwrap(),
            "fracture/branching"
        );
        let Err(RunError::Unknown { hint, .. }) = find("fracture/brancing") else {
            panic!("found");
        };
        assert!(hint.contains("fracture/branching"), "{hint}");
    }
}
