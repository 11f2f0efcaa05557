//! Events of a run.

use std::path::Path;

use pericles::IterationProgress;

use crate::report::Report;

/// An event of a run. Texts are messages without a final full stop.
#[derive(Debug)]
#[non_exhaustive]
pub enum Event<'a> {
    /// A note about the cache while the model is built.
    CacheNote(&'a str),
    /// The run is about to start or to be resumed.
    Opening {
        /// The current report, including warnings.
        report: &'a Report,
        /// The output folder.
        folder: &'a Path,
    },
    /// The time loop begins.
    LoopBegins {
        /// The step at which it begins.
        first: u64,
        /// The last step of the run.
        steps: u64,
    },
    /// A step other than the last one was completed.
    Step {
        /// The step number.
        step: u64,
        /// The time reached, s.
        t: f64,
    },
    /// An iteration within a step has been made, by a scheme that reports its iterations: a step of Newton's method in a load step.
    Iteration(IterationProgress),
    /// A warning about the run.
    Warning(&'a str),
    /// The time loop has ended.
    LoopEnds,
}

/// The callback that receives events.
pub type Tell<'a> = &'a mut dyn FnMut(Event<'_>);
