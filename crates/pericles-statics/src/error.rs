//! What can go wrong on the way to a static state.

use pericles::PericlesError;
use pericles::units::significant;

/// Why a static state is not found.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StaticsError {
    /// Rigid-body motions that no support prevents.
    #[error(
        "nothing prevents the {} of {}: a static state is not unique; prescribe displacements that prevent it, or use rigid_modes = \"fix\" for loads that are in balance",
        list(motions), piece(*points, *of)
    )]
    Unconstrained {
        /// Names of the motions.
        motions: Vec<&'static str>,
        /// Points of the part of the body that can move.
        points: usize,
        /// Points of the body.
        of: usize,
    },
    /// Loads on a free body that are not in balance.
    #[error(
        "the loads at t = {t} s are not in balance: their resultant along rigid-body motions is {} of their size, and no support takes it up; loads on a free body must add up to no force and no moment",
        significant(*.part, 3)
    )]
    Unbalanced {
        /// Time, s.
        t: f64,
        /// Resultant along rigid-body motions over the norm of the loads.
        part: f64,
    },
    /// A system whose natural modes cannot be found.
    #[error("the natural modes of this body cannot be found: {reason}")]
    NoModes {
        /// Why, and what can be done.
        reason: &'static str,
    },
    /// A run that cannot be followed from event to event.
    #[error("breaking = \"event\" cannot be used: {reason}; use \"worst-first\" otherwise")]
    NoEvents {
        /// Why.
        reason: &'static str,
    },
    /// The modes do not converge.
    #[error("the natural modes do not reach a residual of {} within {iterations} iterations; allow more of them, or ask for fewer modes", significant(*.tolerance, 3))]
    ModesNotFound {
        /// Iterations made.
        iterations: u32,
        /// The residual asked for.
        tolerance: f64,
    },
    /// Newton's method does not converge, however short the load step.
    #[error(
        "no static state found at t = {t} s: after {} of the load step the residual is {} of the loads and reactions (tolerance {}){}; \
         the body may be unstable under this load (buckling, softening, a part that comes loose), or the tolerance below rounding",
        significant(*.fraction, 3), significant(*.residual, 3), significant(*.tolerance, 3),
        if *.indefinite { ", and the tangent is not positive definite" } else { "" }
    )]
    NoEquilibrium {
        /// Time, s.
        t: f64,
        /// Part of the load step up to which static states were found.
        fraction: f64,
        /// Residual over loads and reactions.
        residual: f64,
        /// The residual allowed.
        tolerance: f64,
        /// Whether a direction without positive stiffness was met.
        indefinite: bool,
    },
}

impl From<StaticsError> for PericlesError {
    fn from(error: StaticsError) -> Self {
        Self::Extension(Box::new(error))
    }
}

fn list(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_string(),
        [some @ .., last] => format!("{} and {last}", some.join(", ")),
    }
}

fn piece(points: usize, of: usize) -> String {
    if points == of {
        "the body".into()
    } else {
        format!("a part of the body ({points} of {of} points)")
    }
}
