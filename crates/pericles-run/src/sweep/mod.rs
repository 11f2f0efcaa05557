//! Parameter sweeps: one deck with several values of its keys, each run in its own folder.
//!
//! ```text
//! plate-sweep/
//!   sweep.json                 the deck and the values, used to resume
//!   spacing=0.5_mm/  …         one output folder per value, or combination of values
//!   summary.csv                a row per run: values, status, energies, final probe values
//! ```
//!
//! Runs share the process. As many runs at once as the cores allow for the given number of threads per run, each in
//! its own thread pool. A failed run does not stop the others.

mod axis;
mod chart;
mod record;
mod results;
mod runner;
mod table;

pub use axis::Axis;
pub(crate) use chart::value_of;
pub(crate) use record::Member;
pub use results::{SweepResults, is_sweep};
pub use runner::{Plan, Settings, Sweep, SweepEnd, SweepEvent};
pub(crate) use runner::{run_all, worst};
pub use table::Table;
