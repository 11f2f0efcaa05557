//! Errors of plane-wave analysis and tuning.

/// Reason why plane waves or tuned coefficients are not available.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DispersionError {
    /// Plane waves were requested for a body without a grid.
    #[error(
        "plane waves are available for regular grids only, but the points are not on one; use a grid shape such \
        as bar, plate or block"
    )]
    NoLattice,
    /// The bonds of the lattice cannot represent an isotropic medium.
    #[error(
        "the {classes} bond class(es) within {ratio} spacings cannot represent an isotropic medium: the relative \
        error of the long-wave speeds is {error:.1e}; in two and three dimensions use a horizon ratio of at least √2 \
        and the Poisson's ratio of the bond-based model"
    )]
    Anisotropic {
        /// Number of bond classes.
        classes: usize,
        /// Horizon divided by spacing.
        ratio: f64,
        /// Relative residual of the constraints.
        error: f64,
    },
    /// The lower bound is too large for a solution.
    #[error(
        "no coefficients of at least {bound} give the exact long-wave speeds; with {classes} bond classes the \
        largest feasible bound is {largest}"
    )]
    InfeasibleBound {
        /// Requested bound.
        bound: f64,
        /// Number of bond classes.
        classes: usize,
        /// Largest feasible bound.
        largest: f64,
    },
    /// An unsupported combination of tuning options.
    #[error("{choice} is not available {with}; {allowed}")]
    TuningChoice {
        /// Requested option.
        choice: &'static str,
        /// Option with which it cannot be combined.
        with: &'static str,
        /// Allowed alternatives.
        allowed: &'static str,
    },
    /// The tuning problem has no unique solution.
    #[error(
        "the tuning problem has no unique solution: {rank} independent equations for {unknowns} unknowns; use \
        another method or a smaller horizon"
    )]
    Undetermined {
        /// Rank of the equations.
        rank: usize,
        /// Number of free unknowns.
        unknowns: usize,
    },
}

impl From<DispersionError> for pericles::PericlesError {
    fn from(error: DispersionError) -> Self {
        Self::Extension(Box::new(error))
    }
}
