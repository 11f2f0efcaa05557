//! Options of a study run.

use std::path::{Path, PathBuf};

use pericles_run::Event;

/// Options of a study run.
pub struct Context<'a> {
    /// Include rows that take long.
    pub full: bool,
    /// Folder for figures; `None` for no figures.
    pub figures: Option<&'a Path>,
    /// Receives the progress of long runs.
    pub tell: &'a dyn Fn(Event<'_>),
}

impl Context<'_> {
    /// Path of a figure; `None` if no figures are requested.
    pub(crate) fn figure(&self, name: &str) -> Option<PathBuf> {
        self.figures.map(|folder| folder.join(name))
    }
}
