//! Studies of static solvers, compared with tables of an independent implementation in another language.

mod bodies;
mod kirsch;
mod notched;
mod solver;

use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("statics/solver"),
        data!("statics/notched-plate"),
        data!("statics/kirsch"),
    ],
    measures: &[
        ("products", solver::products),
        ("newton", solver::newton),
        ("times", solver::times),
        ("path", notched::path),
        ("hole", kirsch::hole),
    ],
};
