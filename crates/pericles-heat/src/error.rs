//! Errors of diffusing fields.

use pericles::PericlesError;
use pericles::units::{quantity, significant};
use pericles_statics::MOST_REPLICATED;

/// Errors of diffusing fields.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HeatError {
    /// An influence function with negative values.
    #[error(
        "the influence function is negative for some bonds, which would conduct heat from cold to hot; heat conduction requires a non-negative influence function"
    )]
    NegativeInfluence,
    /// A lattice whose bonds cannot conduct the same along all axes.
    #[error(
        "no conductivity per bond conducts exactly {} W/(m K) along all axes of this lattice, whose cells are {} times longer along one axis than along another; allowed: a horizon of at least two cells along every axis",
        significant(*conductivity, 4), significant(*ratio, 3)
    )]
    Anisotropic {
        /// Conductivity, W/(m K).
        conductivity: f64,
        /// Ratio of the longest and the shortest side of a cell.
        ratio: f64,
    },
    /// A steady state that is not unique.
    #[error(
        "the steady state of {} is not unique: no prescribed temperature, convection or radiation determines the temperature of {points} of {of} points; add such a condition, or use an unsteady scheme",
        if points == of { "the body" } else { "a part of the body" }
    )]
    Undetermined {
        /// Number of points without such a condition.
        points: usize,
        /// Number of points of the body.
        of: usize,
    },
    /// A system of equations that was not solved.
    #[error(
        "the implicit thermal step to t = {} did not converge after {products} products (relative residual {residual:.1e}); use a smaller thermal step or the explicit scheme",
        quantity(*.t, "s")
    )]
    NotConverged {
        /// Time at the end of the step, s.
        t: f64,
        /// Number of products.
        products: u64,
        /// Relative residual.
        residual: f64,
    },
    /// A value of a condition that is not finite.
    #[error(
        "the {what} at point {point} is NaN or infinite at t = {}; it must be finite at every point and time",
        quantity(*.t, "s")
    )]
    NotFinite {
        /// The quantity.
        what: &'static str,
        /// Number of the point in output files.
        point: usize,
        /// Time, s.
        t: f64,
    },
    /// A divided body with too many points for a preconditioner that every process stores.
    #[error(
        "every process stores the preconditioner of implicit and steady schemes for the whole body, about 3 kB per point in space: a divided body may have {} points, this one has {points}; run it on one process with threads, or use scheme = \"explicit\"",
        MOST_REPLICATED
    )]
    TooManyPoints {
        /// Number of points of the body.
        points: usize,
    },
    /// A share of the dissipated energy outside of its range.
    #[error(
        "the share of dissipated energy that becomes heat is {share}; allowed: a number from 0 to 1"
    )]
    Share {
        /// The share.
        share: f64,
    },
    /// Heat from dissipated energy in steady states.
    #[error(
        "a steady state stores no heat, and heat from dissipated energy needs a heat content that it adds to; use an unsteady scheme"
    )]
    SteadyDissipation,
    /// Two prescribed values at a point.
    #[error(
        "the temperature of point {point} is prescribed by two conditions; allowed: one prescribed temperature per point"
    )]
    PrescribedTwice {
        /// Number of the point in output files.
        point: usize,
    },
}

impl From<HeatError> for PericlesError {
    fn from(error: HeatError) -> Self {
        Self::Extension(Box::new(error))
    }
}
