//! What plane waves and tuning refuse.

/// Why a lattice has no plane waves, or coefficients cannot be tuned.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DispersionError {
    /// Plane waves were asked for on a body without a grid.
    #[error("the points lie on no regular grid: plane waves are known for grids only")]
    NoLattice,
    /// The bonds of a lattice cannot carry waves that are equally fast in all directions.
    #[error(
        "the {classes} class(es) of bonds within {ratio} spacings cannot give an isotropic medium: the long waves' speeds miss theirs by {miss:e} \
         (relative); a horizon ratio of at least √2 is needed in two and three dimensions, and the Poisson's ratio of the model"
    )]
    Anisotropic {
        /// Classes of bonds.
        classes: usize,
        /// Horizon over spacing.
        ratio: f64,
        /// Relative residual of the constraints.
        miss: f64,
    },
    /// A lower bound that leaves no solution.
    #[error(
        "no coefficients of at least {bound} give the right wave speeds; with {classes} classes of bonds the largest possible bound is {largest}"
    )]
    InfeasibleBound {
        /// The bound asked for.
        bound: f64,
        /// Classes of bonds.
        classes: usize,
        /// The largest bound for which there is a solution.
        largest: f64,
    },
    /// A combination of choices for tuning that does not exist.
    #[error("{choice} cannot be had {with}; {allowed}")]
    TuningChoice {
        /// What was asked for.
        choice: &'static str,
        /// Together with what.
        with: &'static str,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A tuning problem without a unique solution.
    #[error(
        "the tuning problem has no unique solution: {rank} independent equations for {unknowns} unknowns; another method or a smaller horizon helps"
    )]
    Undetermined {
        /// Rank of the equations.
        rank: usize,
        /// Free unknowns.
        unknowns: usize,
    },
}

impl From<DispersionError> for pericles::PericlesError {
    fn from(error: DispersionError) -> Self {
        Self::Extension(Box::new(error))
    }
}
