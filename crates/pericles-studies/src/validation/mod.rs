//! Experiments: decks with parameters of an experiment, compared with what was measured.
//!
//! The parameters are those of the material and the specimen; none is fitted to the measured curve, unless a row says
//! so. A row states whether the computed value lies in the measured range. The variants of a deck, with another
//! spacing, horizon or time step, give its spread; they run with `--full` only.

mod experiment;

use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("validation/half-notched-beam"),
        data!("validation/eccentric-beam"),
        data!("validation/kalthoff-winkler"),
        data!("validation/glass-crack-speed"),
        data!("validation/inclined-crack"),
        data!("validation/taylor-aluminium"),
        data!("validation/taylor-copper"),
        data!("validation/taylor-steel"),
    ],
    measures: &[
        ("scalar", experiment::scalar),
        ("curve", experiment::curve),
        ("damage", experiment::damage),
        ("speed", experiment::speed),
    ],
};
