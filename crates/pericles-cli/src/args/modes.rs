//! Arguments of `modes`.

use std::path::PathBuf;

use clap::Args;

use super::shared::{Caching, Execution, Memory, Overrides};
use super::values::tolerance;

#[derive(Debug, Args)]
pub(crate) struct ModesArgs {
    /// The deck, a TOML file
    pub(crate) deck: PathBuf,
    /// Number of modes, rigid-body motions not included
    #[arg(long = "count", value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) modes: u32,
    /// Largest residual |K x - w^2 M x| over w^2 |M x|; the relative error of a frequency is of the order of its square
    #[arg(long, value_name = "RATIO", default_value_t = 1e-6, value_parser = tolerance)]
    pub(crate) tolerance: f64,
    /// Run the deck first, which must be static, and compute the modes about its last state
    #[arg(long)]
    pub(crate) prestress: bool,
    /// Also write an animation of one period of each mode
    #[arg(long)]
    pub(crate) animation: bool,
    /// Write the results as JSON to a file; `-` is the standard output, which then holds nothing else
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<PathBuf>,
    /// Folder for the results; must not exist
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
