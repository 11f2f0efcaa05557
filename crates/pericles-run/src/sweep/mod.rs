//! Sweeps: one deck at several values of its keys, each run in a folder of its own.
//!
//! ```text
//! plate-sweep/
//!   sweep.json                 the deck and the values, enough to go on
//!   spacing=0.5_mm/  …         one output folder per value, or combination of values
//!   summary.csv                a row per run: values, status, energies, probes at the end
//! ```
//!
//! Runs share the process and the cores: so many at once as the cores allow with the threads each run takes, every one in a pool of its own. A run that fails does not stop the others.

mod axis;
mod record;
mod runner;
mod table;

pub use axis::Axis;
pub use runner::{Plan, Settings, Sweep, SweepEnd, SweepEvent, is_sweep};
pub use table::Table;
