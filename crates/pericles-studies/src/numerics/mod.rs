//! Studies of the program's own numerics, against references computed by other means.

mod highest_frequency;

use crate::study::{Topic, data};

/// The studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[data!("numerics/highest-frequency")],
    measures: &[("highest-frequency", highest_frequency::highest_frequency)],
};
