//! Closed surfaces: distances along them and the motion of bodies that are surfaces.
//!
//! Coclite, Coclite, Maddalena, Politi, A numerical framework for nonlinear peridynamics on two-dimensional manifolds based on implicit P-(EC)^k schemes
//! (2022). The paper prints few numbers; the expected ones were computed by separate codes.

mod geodesics;

use super::{Context, Study};

const PAPER: &str = "Coclite et al. 2022";

/// The studies of this topic.
pub(super) const STUDIES: [Study; 1] = [geodesics::STUDY];
