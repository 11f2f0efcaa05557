//! What a run tells while it goes on.

use std::path::Path;

use crate::report::Report;

/// News of a run. Texts are whole sentences without a full stop, in the words of the program.
#[derive(Debug)]
#[non_exhaustive]
pub enum Event<'a> {
    /// Something about the cache, while the model is built.
    CacheNote(&'a str),
    /// The run is about to begin or to go on: what is known of it, its warnings among that, and where its results go.
    Opening {
        /// The report as it stands.
        report: &'a Report,
        /// The folder of the results.
        folder: &'a Path,
    },
    /// The time loop begins.
    LoopBegins {
        /// The step it begins at.
        first: u64,
        /// The last step of the run.
        steps: u64,
    },
    /// A step has been made, and it was not the last.
    Step {
        /// Its number.
        step: u64,
        /// The time reached, s.
        t: f64,
    },
    /// A warning about the run.
    Warning(&'a str),
    /// The time loop has ended, for whatever reason.
    LoopEnds,
}

/// The callback that receives events.
pub type Tell<'a> = &'a mut dyn FnMut(Event<'_>);
