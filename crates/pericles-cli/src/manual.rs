//! `completions` and `man`: what shells and readers of manuals want, made of the command line itself.

use std::io::{self, Write};
use std::path::Path;

use clap::CommandFactory;
use clap_mangen::Man;
use pericles_io::IoError;

use crate::args::{Cli, CompletionsArgs};
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// Writes the completions for a shell.
///
/// # Errors
/// A standard output that cannot be written.
pub(crate) fn completions(args: &CompletionsArgs) -> Result<Exit, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "pericles", &mut script);
    print(&script)
}

/// Writes the manual page: the program, then every command.
///
/// # Errors
/// A standard output that cannot be written.
pub(crate) fn man() -> Result<Exit, CliError> {
    let page = page().map_err(|error| IoError::writing(Path::new("the standard output"), error))?;
    print(&page)
}

fn page() -> io::Result<Vec<u8>> {
    let mut page = Vec::new();
    let mut program = Cli::command();
    program.build();
    Man::new(program.clone()).render(&mut page)?;
    for command in program.get_subcommands().filter(|c| c.get_name() != "help") {
        let (name, about) = (command.get_name().to_uppercase(), command.get_about());
        let about = about.cloned().unwrap_or_default();
        writeln!(page, ".SH PERICLES {name}\n{about}")?;
        let section = Man::new(command.clone());
        section.render_synopsis_section(&mut page)?;
        section.render_options_section(&mut page)?;
    }
    Ok(page)
}

fn print(text: &[u8]) -> Result<Exit, CliError> {
    let text = String::from_utf8_lossy(text);
    console::print(format_args!("{}", text.trim_end()))?;
    Ok(Exit::Done)
}
