//! Reading of the deck given on the command line.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use pericles_deck::{Deck, DeckError};

use crate::error::CliError;
use crate::new;

/// Reads a deck with overrides.
///
/// # Errors
/// The file cannot be read (with a suggestion), or the deck is invalid.
pub(crate) fn deck(path: &Path, overrides: &[String]) -> Result<Deck, CliError> {
    Deck::read(path, overrides).map_err(|error| match error {
        DeckError::Unreadable { path, reason } => CliError::NoDeck {
            hint: hint(&path, reason.kind()),
            reason: match reason.kind() {
                ErrorKind::NotFound => "there is no such file".into(),
                ErrorKind::IsADirectory => "it is a folder".into(),
                _ => reason.to_string(),
            },
            path,
        },
        rejected => rejected.into(),
    })
}

fn hint(path: &Path, kind: ErrorKind) -> Option<String> {
    let shown = path.display();
    match kind {
        ErrorKind::IsADirectory if path.join("run.json").exists() => Some(format!(
            "the folder contains the results of a run: show them with `pericles info {shown}`, or resume the run with `pericles resume {shown}`"
        )),
        ErrorKind::IsADirectory => beside(&path.join("deck.toml"), 0.0)
            .map(|found| format!("did you mean {}?", found.display())),
        ErrorKind::NotFound => {
            /// Names with a lower similarity are not suggested.
            const LEAST_SIMILARITY: f64 = 0.8;
            let example = new::id_of(&path.to_string_lossy());
            let found = beside(path, LEAST_SIMILARITY)
                .map(|found| format!("did you mean {}?", found.display()));
            found.or_else(|| {
                Some(format!(
                    "an example has this name; copy it here with `pericles new {}`",
                    example?
                ))
            })
        }
        _ => None,
    }
}

/// Returns the deck in the same folder with the most similar name.
fn beside(path: &Path, least: f64) -> Option<PathBuf> {
    let folder = path.parent()?;
    let name = path.file_stem()?.to_string_lossy().into_owned();
    let listed = match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    };
    let likeness = |other: &Path| {
        let stem = other.file_stem().unwrap_or_default();
        strsim::jaro_winkler(&name, &stem.to_string_lossy())
    };
    let decks = std::fs::read_dir(listed).ok()?.flatten();
    let decks = decks.map(|entry| folder.join(entry.file_name()));
    let alike = decks
        .filter(|other| other.extension().is_some_and(|ending| ending == "toml"))
        .map(|other| (likeness(&other), other))
        .filter(|(likeness, _)| *likeness >= least);
    alike
        .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
        .map(|(_, path)| path)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(path: &Path) -> String {
        use miette::Diagnostic;
        let error = deck(path, &[]).unwrap_err();
        format!(
            "{error}; {}",
            error
                .help()
                .map(|help| help.to_string())
                .unwrap_or_default()
        )
    }

    #[test]
    fn missing_decks_lead_to_suggestions() {
        let place = tempfile::tempdir().unwrap();
        for name in ["mode-one.toml", "other.toml", "notes.txt"] {
            std::fs::write(place.path().join(name), "").unwrap();
        }
        let says = |name: &str, words: &str| {
            let message = message(&place.path().join(name));
            assert!(message.contains(words), "{message}");
        };
        says("mode-on.toml", "mode-one.toml?");
        says("mode-one", "mode-one.toml?");
        says("mode_one.tml", "mode-one.toml?");
        says("", "it is a folder; did you mean");
        says("nothing/like/it.toml", "there is no such file; ");
        let alone = message(Path::new("fracture/branching"));
        assert!(alone.contains("pericles new fracture/branching"), "{alone}");
        std::fs::write(place.path().join("run.json"), "{}").unwrap();
        says("", "contains the results of a run");
    }
}
