//! Nonlinear peridynamics on closed surfaces.
//!
//! Coclite, Coclite, Maddalena, Politi, A numerical framework for nonlinear peridynamics on two-dimensional
//! manifolds based on implicit P-(EC)^k schemes (2022). Unit sphere of 642 vertices, ρ = κ = 1, u₀ = 0 and random
//! velocities unless a row says otherwise.
//!
//! Two presets. **Standard**: the model as written (horizon 0.5, vertex areas, distances along edges); the expected
//! values were recomputed by an independent code. **Calibrated**: area 3 for every vertex and horizon 0.4, two
//! parameters fitted to the three printed periods of figure 2. No consistent reading gives the printed times: the
//! operator of the paper is 80 to 130 times stiffer than the standard one.

mod course;
mod geodesics;
mod modes;

use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("manifolds/geodesics"),
        data!("manifolds/figure-2"),
        data!("manifolds/figure-3"),
        data!("manifolds/figure-4"),
        data!("manifolds/figure-5"),
        data!("manifolds/figure-6"),
        data!("manifolds/convergence"),
    ],
    measures: &[
        ("mesh", geodesics::mesh),
        ("distances", geodesics::distances),
        ("distances-of-levels", geodesics::of_levels),
        ("breathing", modes::breathing),
        ("highest-frequency", modes::highest),
        ("quotient", modes::quotient),
        ("run", course::run),
        ("half-step", course::half_step),
        ("linearity", course::linearity),
    ],
};
