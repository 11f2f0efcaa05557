//! Definition of a study.

use pericles_run::RunError;

use crate::context::Context;
use crate::data::{Measure, StudyData, rows};
use crate::row::Row;

/// Study that reproduces published results.
pub struct Study {
    /// Name, `topic/name`.
    pub id: &'static str,
    /// Short reference of the paper.
    pub paper: &'static str,
    /// Subject of the study.
    pub title: &'static str,
    data: StudyData,
    measures: &'static [Measure],
}

/// Studies of a topic: their names and data, and the functions that these call.
pub(crate) struct Topic {
    pub(crate) studies: &'static [(&'static str, &'static str)],
    pub(crate) measures: &'static [Measure],
}

/// Name of a study and its data, a file in the folder `data`.
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
    /// Parses the studies, which are kept as long as the program runs.
    ///
    /// # Panics
    /// If the data do not follow the format. They are part of the program, and a test parses all of them.
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
    /// Returns unknown functions and figures in the data, and rows that are not judged by exactly one rule.
    #[cfg(test)]
    pub(crate) fn faults(&self) -> Vec<String> {
        self.data.faults(self.measures)
    }

    /// Computes the rows and draws the figures.
    ///
    /// # Errors
    /// Figures that cannot be written, and errors of runs.
    pub fn run(&self, context: &Context<'_>) -> Result<Vec<Row>, RunError> {
        rows(&self.data, self.measures, context)
    }
}
