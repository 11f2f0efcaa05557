//! Errors of static solvers and of natural modes.

use pericles::PericlesError;
use pericles::units::{quantity, significant};

/// Largest number of unknowns of a body divided among processes: the preconditioner of the whole body is then stored by every
/// process, about 10 GB in space.
pub const MOST_REPLICATED: usize = 4_000_000;

/// Errors of static solvers and of natural modes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StaticsError {
    /// Unconstrained rigid-body motions.
    #[error(
        "no constraint prevents the {} of {}, so that the static state is not unique; prescribe displacements with [[constraint]] that prevent it, or set rigid_modes = \"fix\" if the loads are in balance",
        list(motions), piece(*points, *of)
    )]
    Unconstrained {
        /// Names of the motions.
        motions: Vec<&'static str>,
        /// Number of points of the free part of the body.
        points: usize,
        /// Number of points of the body.
        of: usize,
    },
    /// Loads on a free body that are not in balance.
    #[error(
        "the loads on a free body are not in balance at t = {}: their resultant along rigid-body motions is {} times their norm; the resultant force and moment must be zero; change the loads, or add a constraint with [[constraint]]",
        quantity(*.t, "s"), significant(*.part, 3)
    )]
    Unbalanced {
        /// Time, s.
        t: f64,
        /// Resultant along rigid-body motions over the norm of the loads.
        part: f64,
    },
    /// Loads on a part of the body that no longer has a connection to constraints.
    #[error(
        "at t = {} loads act on a part of the body ({points} of {of} points) that bonds no longer connect to a constraint, so that it has no static state; \
         end the run before with [[time.stop_when]], or prescribe displacements with [[constraint]] instead of loads",
        quantity(*.t, "s")
    )]
    Separated {
        /// Time, s.
        t: f64,
        /// Number of points of the part.
        points: usize,
        /// Number of points of the body.
        of: usize,
    },
    /// A divided body with too many unknowns for a preconditioner that every process stores.
    #[error(
        "every process stores the preconditioner of the whole body, about 2.5 kB per unknown in space: a divided body may have {} unknowns, this one has {unknowns}; run it on one process with threads, or use scheme = \"adaptive-dynamic-relaxation\" or \"fire\"",
        MOST_REPLICATED
    )]
    TooManyUnknowns {
        /// Displacement components of all points.
        unknowns: usize,
    },
    /// Natural modes are not supported for the system.
    #[error("natural modes are not available for this body: {reason}")]
    NoModes {
        /// Reason and suggested change.
        reason: &'static str,
    },
    /// Event-by-event analysis is not supported for the system.
    #[error(
        "breaking = \"event\" cannot be used: {reason}; the alternative is breaking = \"worst-first\""
    )]
    NoEvents {
        /// Reason and suggested change.
        reason: &'static str,
    },
    /// Control of the load factor is not supported for the system.
    #[error("`control` cannot be used: {reason}")]
    NoControl {
        /// Reason and suggested change.
        reason: &'static str,
    },
    /// The load factor at which a controlled quantity has its value was not found.
    #[error(
        "no static state found at t = {}: at the fraction {} of the step the controlled quantity is {} m (wanted {} m), the relative residual {} (tolerance {}); \
         the quantity must grow along the path of states: choose one that opens with the crack; or use shorter steps, a larger tolerance, or stop the run before by [[time.stop_when]]",
        quantity(*.t, "s"), significant(*.fraction, 3), significant(*.value, 6), significant(*.wanted, 6),
        significant(*.residual, 3), significant(*.tolerance, 3)
    )]
    NotControlled {
        /// Time, s.
        t: f64,
        /// Fraction of the step up to which static states were found.
        fraction: f64,
        /// Value of the quantity in the last iteration, m.
        value: f64,
        /// Its value at the end of the step, m.
        wanted: f64,
        /// Residual relative to loads and reactions.
        residual: f64,
        /// Tolerance of the relative residual.
        tolerance: f64,
    },
    /// The iteration of natural modes does not converge.
    #[error("the natural modes did not converge to a residual of {} within {iterations} iterations; allow more iterations or compute fewer modes", significant(*.tolerance, 3))]
    ModesNotFound {
        /// Number of iterations.
        iterations: u32,
        /// Tolerance of the residual.
        tolerance: f64,
    },
    /// Newton's method does not converge for the shortest load step.
    #[error(
        "no static state found at t = {}: at the fraction {} of the load step the relative residual is {} (tolerance {}){}; \
         the body may be unstable under this load (buckling, softening, a part that separates), or the tolerance may be below \
         round-off; use shorter load steps, breaking = \"event\" (no load step to choose), scheme = \"fire\", a larger tolerance, or stop the run before by [[time.stop_when]]",
        quantity(*.t, "s"), significant(*.fraction, 3), significant(*.residual, 3), significant(*.tolerance, 3),
        if *.indefinite { ", and the tangent is not positive definite" } else { "" }
    )]
    NoEquilibrium {
        /// Time, s.
        t: f64,
        /// Fraction of the load step up to which static states were found.
        fraction: f64,
        /// Residual relative to loads and reactions.
        residual: f64,
        /// Tolerance of the relative residual.
        tolerance: f64,
        /// Whether a direction without positive stiffness was found.
        indefinite: bool,
    },
}

impl From<StaticsError> for PericlesError {
    fn from(error: StaticsError) -> Self {
        Self::Extension(Box::new(error))
    }
}

/// Returns an error of this crate within one of the engine.
fn of_statics(error: &PericlesError) -> Option<&StaticsError> {
    match error {
        PericlesError::Extension(inner) => inner.downcast_ref(),
        _ => None,
    }
}

/// Returns whether an error is that of Newton's method without a static state.
pub(crate) fn is_no_equilibrium(error: &PericlesError) -> bool {
    matches!(of_statics(error), Some(StaticsError::NoEquilibrium { .. }))
}

/// Returns whether an error is that of a controlled state that was not found.
pub(crate) fn is_not_controlled(error: &PericlesError) -> bool {
    matches!(of_statics(error), Some(StaticsError::NotControlled { .. }))
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
        format!("a disconnected part of the body ({points} of {of} points)")
    }
}
