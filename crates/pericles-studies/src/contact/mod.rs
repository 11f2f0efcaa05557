//! Studies of contact and impact, compared with closed forms and with tables of an independent implementation in another
//! language.

mod bars;
mod rigid;

use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("contact/bars"),
        data!("contact/wall"),
        data!("contact/rigid"),
    ],
    measures: &[
        ("bars", bars::bars),
        ("wall", bars::wall),
        ("ball", rigid::ball),
    ],
};
