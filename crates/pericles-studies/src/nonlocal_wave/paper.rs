//! The paper of the topic.

/// Its authors and title, or its short name.
pub(super) const PAPER: &str = "Coclite et al. 2020, Appl. Numer. Math.";
