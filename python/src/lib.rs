//! The compiled part of the Python package `pericles`.
//!
//! Arrays, runs and results cross the border here; names, messages for people, and everything without numbers are written
//! in Python (`python/pericles`). A computation runs without the interpreter's lock. Arrays inside callbacks are copies,
//! arrays of results are views that keep their owner alive.

mod arrays;
mod callback;
mod deck;
mod entry;
mod errors;
mod files;
mod model;
mod recorder;
mod simulation;
mod studies;
mod values;

use pyo3::prelude::*;

#[pymodule(gil_used = false)]
mod _pericles {
    use super::*;
    #[pymodule_export]
    use crate::callback::{Snapshot, field_components, field_unit};
    #[pymodule_export]
    use crate::deck::{Deck, in_unit, is_quantity, seconds};
    #[pymodule_export]
    use crate::entry::{after_fork, set_threads, threads};
    #[pymodule_export]
    use crate::files::{
        OutputFile, command_line, compare, export_fields, export_formats, read_table,
    };
    #[pymodule_export]
    use crate::model::Model;
    #[pymodule_export]
    use crate::recorder::Recording;
    #[pymodule_export]
    use crate::simulation::Simulation;
    #[pymodule_export]
    use crate::studies::{Sweep, fit, run_steps};

    /// Sets the version and the commit.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        #[cfg(feature = "command-line")]
        pericles_run::set_commit(pericles_cli::COMMIT);
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
