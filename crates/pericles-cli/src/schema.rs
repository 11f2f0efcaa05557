//! `schema`: print the JSON Schema of decks, or their reference as Markdown.

use crate::args::SchemaArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// Prints the schema.
///
/// # Errors
/// Output cannot be written.
pub(crate) fn schema(args: &SchemaArgs) -> Result<Exit, CliError> {
    let text = if args.markdown {
        pericles_deck::reference()
    } else {
        serde_json::to_string_pretty(&pericles_deck::json_schema())?
    };
    console::print(format_args!("{}", text.trim_end()))?;
    Ok(Exit::Done)
}
