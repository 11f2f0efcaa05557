//! Studies of contact and impact, compared with closed forms and with tables of an independent implementation in another
//! language.

mod bars;
mod disc;
mod hertz;
mod kalthoff;
mod reference;
mod rigid;

use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("contact/bars"),
        data!("contact/wall"),
        data!("contact/hertz"),
        data!("contact/rigid"),
        data!("contact/reference"),
        data!("contact/impact-disc"),
        data!("contact/kalthoff-winkler"),
    ],
    measures: &[
        ("bars", bars::bars),
        ("wall", bars::wall),
        ("hertz", hertz::ball),
        ("ball", rigid::ball),
        ("points", reference::points),
        ("shapes", reference::shapes),
        ("top", reference::top),
        ("indenter", disc::indenter),
        ("steel ball", disc::ball),
        ("projectile", kalthoff::projectile),
    ],
};
