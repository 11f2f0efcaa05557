//! Nonlinear peridynamics on closed surfaces.
//!
//! Coclite, Coclite, Maddalena, Politi, A numerical framework for nonlinear peridynamics on two-dimensional manifolds based on implicit P-(EC)^k schemes (2022).
//! Unit sphere of 642 vertices, ρ = κ = 1, u₀ = 0 and random velocities unless a row says otherwise.
//!
//! Two presets. **Standard**: the model as it is written (horizon 0.5, areas of the vertices, distances along edges); the expected numbers were recomputed by
//! an independent code. **Calibrated**: area 3 for every vertex and horizon 0.4, two choices fitted to the three printed periods of figure 2. No consistent reading
//! gives the printed times: the paper's operator is 80 to 130 times stiffer than the standard one.

mod course;
mod geodesics;
mod modes;

use crate::study::{Topic, data};

/// The studies of this topic.
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
