//! What a study is.

use pericles_run::RunError;

use crate::context::Context;
use crate::data::{Measure, StudyData, rows};
use crate::row::Row;

/// A study of a paper.
pub struct Study {
    /// Its name, `topic/name`.
    pub id: &'static str,
    /// The paper, short.
    pub paper: &'static str,
    /// What it shows.
    pub title: &'static str,
    data: StudyData,
    measures: &'static [Measure],
}

/// The studies of a topic: their names and data, and the functions that these name.
pub(crate) struct Topic {
    pub(crate) studies: &'static [(&'static str, &'static str)],
    pub(crate) measures: &'static [Measure],
}

/// The name of a study and its data, a file in the folder `data`.
macro_rules! data {
    ($id:literal) => {
        (
            $id,
            include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/data/", $id, ".toml")),
        )
    };
}
pub(crate) use data;

impl Topic {
    /// Reads the studies, which are kept as long as the program runs.
    ///
    /// # Panics
    /// Data that do not follow the format: they are part of the program, and a test reads all of them.
    pub(crate) fn read(&'static self) -> impl Iterator<Item = Study> {
        self.studies.iter().map(|(id, text)| {
            let data = StudyData::read(text).unwrap_or_else(|error| panic!("{id}: {error}"));
            Study {
                id,
                paper: data.paper.clone().leak(),
                title: data.title.clone().leak(),
                data,
                measures: self.measures,
            }
        })
    }
}

impl Study {
    /// Functions and figures that the data name and nothing has, and rows whose number or tolerance is missing.
    #[cfg(test)]
    pub(crate) fn unknown_names(&self) -> Vec<String> {
        self.data.unknown_names(self.measures)
    }

    /// Computes the rows and draws the figures.
    ///
    /// # Errors
    /// Figures that cannot be written, and what can go wrong with a run.
    pub fn run(&self, context: &Context<'_>) -> Result<Vec<Row>, RunError> {
        rows(&self.data, self.measures, context)
    }
}
