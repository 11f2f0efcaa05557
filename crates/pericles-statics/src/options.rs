//! How static states are found.

use crate::breaking::BreakingRule;

/// When a state counts as static, and how it is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticOptions {
    /// Norm of the residual over that of loads or reactions, the larger; the largest so far.
    pub tolerance: f64,
    /// The most steps of Newton's method for one state.
    pub newton_steps: u32,
    /// The most products of one linear problem.
    pub products: u32,
    /// Whether rigid-body motions that nothing prevents are taken out; else they are refused.
    pub fix_rigid_modes: bool,
    /// Which over-stretched bonds break at a static state.
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
