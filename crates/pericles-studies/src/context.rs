//! What a study is run with.

use std::path::{Path, PathBuf};

use pericles_run::Event;

/// What a study is run with.
pub struct Context<'a> {
    /// Whether rows that take long are wanted.
    pub full: bool,
    /// The folder for figures; none if no figures are wanted.
    pub figures: Option<&'a Path>,
    /// Receives the progress of long runs.
    pub tell: &'a dyn Fn(Event<'_>),
}

impl Context<'_> {
    /// The file of a figure; none if no figures are wanted.
    pub(crate) fn figure(&self, name: &str) -> Option<PathBuf> {
        self.figures.map(|folder| folder.join(name))
    }
}
