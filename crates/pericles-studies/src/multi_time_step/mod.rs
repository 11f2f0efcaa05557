//! Multirate schemes: orders, stability, failure, conservation and cost.
//!
//! Liu, Sun, Tian, Don, Ju, A high-order multi-time-step scheme for bond-based peridynamics, arXiv 2401.04966
//! (2024). The paper does not print its interface formulas and most of its parameters; the bodies follow its text,
//! and the expected values were computed by an independent code (`validation/multi-time-step/`). `structured` and
//! `hermite` are the predictor and the interpolant of [`pericles::time`] unless a row says otherwise.

mod convergence;
mod cost;
mod crack;
mod energy;
mod problem;
mod stability;
mod turns;
mod two_grid;

use crate::study::{Topic, data};

/// Studies of this topic.
pub(super) const TOPIC: Topic = Topic {
    studies: &[
        data!("multi-time-step/plate"),
        data!("multi-time-step/plate-nonlinear"),
        data!("multi-time-step/block"),
        data!("multi-time-step/crack"),
        data!("multi-time-step/stability"),
        data!("multi-time-step/energy"),
        data!("multi-time-step/cost"),
        data!("multi-time-step/inclusion"),
        data!("multi-time-step/two-grid"),
    ],
    measures: &[
        ("largest-displacement", convergence::largest_displacement),
        ("error", convergence::error),
        ("order", convergence::order),
        ("equal-steps", convergence::equal_steps),
        ("before-failure", crack::before_failure),
        ("fine-step", crack::fine_step),
        ("failure", crack::failure),
        ("limit", stability::limit),
        ("growth", stability::growth),
        ("growth-rates", stability::rates),
        ("kept", energy::kept),
        ("kept-orders", energy::orders),
        ("evaluations", cost::evaluations),
        ("evaluations-of-set", cost::evaluations_of_set),
        ("speed-up", cost::speed_up),
        ("speed-up-of-fractions", cost::of_fractions),
        ("speed-up-model", cost::model),
        ("speed-up-of-set", cost::of_set),
        ("errors-of-set", convergence::errors_of_set),
        ("patch-test", two_grid::patch_test),
        ("patch-test-ratio", two_grid::patch_test_ratio),
        ("frequencies", two_grid::frequencies),
    ],
};
