//! Arguments of `fit`.

use std::path::PathBuf;

use clap::Args;
use pericles_run::fit::Wanted;

use super::shared::{Overrides, RunOptions};
use super::values::positive;

#[derive(Debug, Args)]
pub(crate) struct FitArgs {
    /// The deck, a TOML file
    pub(crate) deck: PathBuf,
    /// The measured curve: a CSV table whose first line has names with units, such as `CMOD [mm],force [kN]`
    pub(crate) curve: PathBuf,
    /// The column of the run's tables that is the horizontal axis, such as CMOD; a measured table with more than two columns
    /// has a column of this name
    #[arg(long, value_name = "COLUMN")]
    pub(crate) x: String,
    /// The column that is compared, such as reaction.top.y
    #[arg(long, value_name = "COLUMN")]
    pub(crate) y: String,
    /// Comma-separated keys of the deck, each with optional bounds: KEY or KEY=LOW:HIGH [default bounds: a tenth of the
    /// value in the deck and ten times this value]
    #[arg(long, value_name = "KEYS", value_delimiter = ',', required = true)]
    pub(crate) keys: Vec<Wanted>,
    /// Relative change of a value by which derivatives are computed
    #[arg(long, value_name = "FRACTION", default_value_t = 0.01, value_parser = positive)]
    pub(crate) step: f64,
    /// The fit ends when no value changes by more than this fraction of its value in the deck
    #[arg(long, value_name = "FRACTION", default_value_t = 1e-3, value_parser = positive)]
    pub(crate) tolerance: f64,
    /// Maximum number of runs
    #[arg(long, value_name = "N", default_value_t = 60)]
    pub(crate) runs: usize,
    /// Folder for the results, which must not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    #[command(flatten)]
    pub(crate) options: RunOptions,
}
