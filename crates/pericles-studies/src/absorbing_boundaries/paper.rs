//! The paper of the topic.

/// Its authors and title, or its short name.
pub(super) const PAPER: &str = "Ji, Pang, Zhang, Yang, Perdikaris, Exact artificial boundary conditions of 1D semi-discretized peridynamics";
