//! `completions` and `man`: shell completions and the manual page, generated from the argument definitions.

use std::io::{self, Write};
use std::path::Path;

use clap::{Command, CommandFactory};
use clap_mangen::Man;
use pericles_io::{IoError, write_atomically};
use pericles_run::RunError;

use crate::args::{Cli, CompletionsArgs, ManArgs};
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;

/// Prints the completion script for a shell.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn completions(args: &CompletionsArgs) -> Result<Exit, CliError> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "pericles", &mut script);
    print(&script)
}

/// Prints the manual page of the program or of a command, or writes all pages to a folder.
///
/// # Errors
/// The command does not exist, or the output cannot be written.
pub(crate) fn man(args: &ManArgs) -> Result<Exit, CliError> {
    let mut program = Cli::command();
    program.build();
    if let Some(folder) = &args.out {
        return write_pages(&program, folder);
    }
    let page = match &args.command {
        None => whole(&program),
        Some(name) => rendered(&command(&program, name)?),
    };
    let page = page.map_err(|error| IoError::writing(Path::new("standard output"), error))?;
    print(&page)
}

/// Returns a command of the program.
fn command(program: &Command, name: &str) -> Result<Command, RunError> {
    let found = commands(program).find(|command| command.get_name() == name);
    found.cloned().ok_or_else(|| {
        let names: Vec<String> = commands(program)
            .map(|command| command.get_name().to_owned())
            .collect();
        let listing = format!("the commands are {}", names.join(", "));
        RunError::unknown("command", name, &names, &listing)
    })
}

fn commands(program: &Command) -> impl Iterator<Item = &Command> {
    let all = program.get_subcommands();
    all.filter(|command| command.get_name() != "help")
}

/// Writes `pericles.1` and a page per command.
fn write_pages(program: &Command, folder: &Path) -> Result<Exit, CliError> {
    std::fs::create_dir_all(folder).map_err(|error| IoError::writing(folder, error))?;
    for command in std::iter::once(program).chain(commands(program)) {
        let name = command.get_display_name().unwrap_or("pericles");
        let path = folder.join(format!("{name}.1"));
        let page = rendered(command).map_err(|error| IoError::writing(&path, error))?;
        write_atomically(&path, |file| file.write_all(&page))?;
        console::print(format_args!("{}", path.display()))?;
    }
    Ok(Exit::Done)
}

/// Renders the page of one command.
fn rendered(command: &Command) -> io::Result<Vec<u8>> {
    let mut page = Vec::new();
    Man::new(command.clone()).render(&mut page)?;
    Ok(page)
}

/// Renders one page with all commands.
fn whole(program: &Command) -> io::Result<Vec<u8>> {
    let mut page = rendered(program)?;
    for command in commands(program) {
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
