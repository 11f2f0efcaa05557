//! Options of the static solver.

use crate::breaking::BreakingRule;

/// Options of the static solver: tolerance, limits, rigid-body motions and bond failure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticOptions {
    /// Tolerance of the norm of the residual relative to the largest norm of loads or reactions so far.
    pub tolerance: f64,
    /// Largest number of Newton steps per state.
    pub newton_steps: u32,
    /// Largest number of products with the tangent per linear problem.
    pub products: u32,
    /// Whether unconstrained rigid-body motions are projected out; otherwise they are an error.
    pub fix_rigid_modes: bool,
    /// Rule that selects the bonds that break at a static state.
    pub breaking: BreakingRule,
}

impl Default for StaticOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-6,
            newton_steps: 25,
            products: 2000,
            fix_rigid_modes: false,
            breaking: BreakingRule::default(),
        }
    }
}
