//! `import`: make a deck from an input file of another code.

use std::io::Write;
use std::path::Path;

use pericles_deck::Deck;
use pericles_io::write_atomically;

use crate::args::ImportArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// Imports an input file, writes the deck and lists entries without exact translation.
///
/// # Errors
/// The input file cannot be read or is wrong; the deck exists, cannot be written, or has errors.
pub(crate) fn import(args: &ImportArgs) -> Result<Exit, CliError> {
    let beside = args.file.with_extension("toml");
    let out = args.out.as_deref().unwrap_or(&beside);
    let is_printed = out == Path::new("-");
    if !is_printed && !args.force && out.symlink_metadata().is_ok() {
        return Err(CliError::DeckExists { path: out.into() });
    }
    let folder = out.parent().unwrap_or(Path::new(""));
    let imported =
        pericles_import::import(&args.file, folder, &args.units.clone().unwrap_or_default())?;
    let (file, name) = (args.file.display(), out.display());
    for remark in &imported.remarks {
        let kind = if remark.is_translated {
            "translated with a difference"
        } else {
            "not translated"
        };
        console::note(format_args!(
            "{file}:{}: {kind}: {}",
            remark.line,
            remark.text()
        ));
    }
    if is_printed {
        console::print(format_args!("{}", imported.deck.trim_end()))?;
    } else {
        write_atomically(out, |file| file.write_all(imported.deck.as_bytes()))?;
        console::print(format_args!(
            "{name}: check it with `pericles check {name}`, then run it with `pericles run {name}`."
        ))?;
    }
    let name = if is_printed {
        "deck".to_owned()
    } else {
        name.to_string()
    };
    Deck::parse(&imported.deck, &name, &[])?;
    Ok(Exit::Done)
}
