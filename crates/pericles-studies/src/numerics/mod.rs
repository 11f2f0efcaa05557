//! Studies of the program's numerical methods, compared with independent references.

mod highest_frequency;

use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[data!("numerics/highest-frequency")],
    measures: &[("highest-frequency", highest_frequency::highest_frequency)],
};
