//! Arguments of `converge`.

use std::path::PathBuf;

use clap::Args;

use super::shared::{Overrides, RunOptions};
use super::values::{Length, length, ratio, time_step};

#[derive(Debug, Args)]
pub(crate) struct ConvergeArgs {
    /// The deck, a TOML file
    pub(crate) deck: PathBuf,
    /// Comma-separated ratios m of horizon to spacing, at least 1
    #[arg(long, value_name = "NUMBERS", value_delimiter = ',', required_unless_present = "dt", conflicts_with = "dt", value_parser = ratio)]
    pub(crate) m: Vec<f64>,
    /// Comma-separated spacings, such as "2 mm,1 mm,0.5 mm"
    #[arg(long, value_name = "LENGTHS", value_delimiter = ',', required_unless_present_any = ["horizon", "dt"], conflicts_with_all = ["horizon", "dt"], value_parser = length)]
    pub(crate) dx: Vec<Length>,
    /// A fixed horizon for all m
    #[arg(long, value_name = "LENGTH", value_parser = length, conflicts_with = "dt")]
    pub(crate) horizon: Option<Length>,
    /// Comma-separated time steps on the grid of the deck, such as "1 us,0.5 us,0.25 us"
    #[arg(long, value_name = "TIMES", value_delimiter = ',', value_parser = time_step)]
    pub(crate) dt: Vec<String>,
    /// The scalar whose convergence is studied
    #[arg(long, value_name = "NAME")]
    pub(crate) scalar: String,
    /// Reference value of the scalar, in SI units
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    pub(crate) reference: Option<f64>,
    /// Folder for the results, which must not exist
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) overrides: Overrides,
    #[command(flatten)]
    pub(crate) options: RunOptions,
}
