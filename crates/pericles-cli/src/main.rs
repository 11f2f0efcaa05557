//! The program `pericles`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(pericles_cli::command(std::env::args_os()))
}
