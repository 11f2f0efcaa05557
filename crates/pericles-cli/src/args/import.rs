//! Arguments of `import`.

use std::path::PathBuf;

use clap::Args;
use pericles_import::Units;

/// Text after the help of `import`.
pub(super) const NOTES: &str = "\
Comments in the deck name the entry from which each table comes. Entries without exact translation are listed at the head of
the deck and on standard error, with their lines. The exit status is 3 if the input file is wrong, or if the deck that was
written has errors, which are listed too.
  pericles import DCBmodel.yaml --units mm,MPa,s     DCBmodel.toml in the same folder
  pericles import tensile_test.xml --out deck.toml
  pericles import Dogbone.yaml --out -";

/// Arguments of `import`.
#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// The input file of PeriLab or Peridigm
    pub(crate) file: PathBuf,
    /// The deck to write, which must not exist; `-` for standard output [default: the name of the input file with .toml, in
    /// its folder]
    #[arg(long, short, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Units of length, stress and time of the numbers in the input file and in its mesh, which name none [default: m,Pa,s]
    #[arg(long, value_name = "LENGTH,STRESS,TIME", value_parser = Units::parse)]
    pub(crate) units: Option<Units>,
    /// Replace an existing deck
    #[arg(long)]
    pub(crate) force: bool,
}
