//! What a study is, and what it is run with.

use std::path::{Path, PathBuf};

use pericles_run::{Event, RunError};

use crate::row::Row;

/// A study of a paper.
pub struct Study {
    /// Its name, `topic/name`.
    pub id: &'static str,
    /// The paper, short.
    pub paper: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// Computes the rows and draws the figures.
    pub(crate) run: fn(&Context<'_>) -> Result<Vec<Row>, RunError>,
}

impl Study {
    /// Computes the rows and draws the figures.
    ///
    /// # Errors
    /// Figures that cannot be written, and what can go wrong with a run.
    pub fn run(&self, context: &Context<'_>) -> Result<Vec<Row>, RunError> {
        (self.run)(context)
    }
}

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
    /// For tests.
    #[cfg(test)]
    pub(crate) fn without_figures() -> Self {
        Self {
            full: false,
            figures: None,
            tell: &|_| {},
        }
    }

    /// The file of a figure; none if no figures are wanted.
    pub(crate) fn figure(&self, name: &str) -> Option<PathBuf> {
        self.figures.map(|folder| folder.join(name))
    }
}
