//! Studies of static states, against tables computed by an independent implementation in another language.

mod bodies;
mod notched;
mod solver;

use crate::study::{Topic, data};

/// The studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[data!("statics/solver"), data!("statics/notched-plate")],
    measures: &[
        ("products", solver::products),
        ("newton", solver::newton),
        ("times", solver::times),
        ("path", notched::path),
    ],
};
