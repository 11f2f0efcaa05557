//! Arguments of `modes`.

use std::path::PathBuf;

use clap::Args;

use super::shared::{Caching, Execution, Memory, Overrides};
use super::values::tolerance;

#[derive(Debug, Args)]
pub(crate) struct ModesArgs {
    /// The deck, a TOML file
    pub(crate) deck: PathBuf,
    /// Number of modes, rigid-body modes excluded
    #[arg(long = "count", value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) modes: u32,
    /// Largest relative residual |K x - w^2 M x| / (w^2 |M x|) of a mode; the relative error of its frequency is of the
    /// order of the square of the residual
    #[arg(long, value_name = "RATIO", default_value_t = 1e-6, value_parser = tolerance)]
    pub(crate) tolerance: f64,
    /// Run the deck, which must be static, and compute the modes about its final state
    #[arg(long)]
    pub(crate) prestress: bool,
    /// Also write an animation of each mode over one period
    #[arg(long)]
    pub(crate) animation: bool,
    /// Write the results as JSON to a file; `-` writes to standard output and suppresses other output
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Folder for the results, which must not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    #[command(flatten)]
    pub(crate) caching: Caching,
    #[command(flatten)]
    pub(crate) memory: Memory,
    #[command(flatten)]
    pub(crate) execution: Execution,
}
