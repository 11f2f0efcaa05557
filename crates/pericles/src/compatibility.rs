//! What schemes need of the system they step: one list per scheme, from which refusals and the table of the book are made.

use crate::error::{PericlesError, Result};
use crate::system::System;

/// Something that a scheme may need of a system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// Forces in double precision.
    DoublePrecision,
    /// Forces of finite reach, which can be evaluated on a part of the body.
    FiniteReach,
    /// Forces that are sums over bonds, whose parts can be summed up alone.
    SumOverBonds,
    /// No boundaries that keep a state of their own.
    NoBoundaries,
    /// No boundaries with a memory: none, or such that depend on the state of a stage alone.
    NoMemory,
    /// Boundaries that act linearly within a step whose end is an unknown.
    BoundariesWithinStep,
}

/// A need of a scheme, and why it has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Requirement {
    /// What it needs.
    pub need: Need,
    /// Why, and what to use where the need is not met.
    pub reason: &'static str,
}

impl Requirement {
    /// For schemes that solve equations.
    pub const IN_DOUBLES: Self = Self {
        need: Need::DoublePrecision,
        reason: "it solves equations to more digits than forces in single precision have; use forces in double precision",
    };
}

impl Need {
    /// Whether a system meets it.
    pub fn is_met_by(self, system: &System) -> bool {
        let force = system.operator();
        match self {
            Self::DoublePrecision => !force.capabilities().single_precision,
            Self::FiniteReach => force.as_local().is_some(),
            Self::SumOverBonds => force.as_split().is_some(),
            Self::NoBoundaries => !system.has_boundaries(),
            Self::NoMemory => !system.boundaries().any(|one| one.has_memory()),
            Self::BoundariesWithinStep => {
                system.boundaries().all(|one| one.within_step().is_some())
            }
        }
    }
}

/// Refuses a system that does not meet the requirements of a scheme; the first that is not met is named.
///
/// # Errors
/// [`PericlesError::SchemeNotUsable`].
pub fn require(scheme: &'static str, requirements: &[Requirement], system: &System) -> Result<()> {
    match requirements.iter().find(|one| !one.need.is_met_by(system)) {
        None => Ok(()),
        Some(Requirement { reason, .. }) => Err(PericlesError::SchemeNotUsable { scheme, reason }),
    }
}
