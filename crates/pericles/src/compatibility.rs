//! Requirements of time integrators on systems: one list per scheme, from which error messages and the
//! compatibility table of the book are made.

use crate::error::{PericlesError, Result};
use crate::system::System;

/// A requirement of a scheme on a system.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// Forces in double precision.
    DoublePrecision,
    /// Forces of finite reach, which can be evaluated on a subset of the points.
    FiniteReach,
    /// Forces that are sums over bonds and can be split into partial sums.
    SumOverBonds,
    /// No boundaries with a state of their own.
    NoBoundaries,
    /// No boundaries with memory; boundaries that depend only on the state of a stage are allowed.
    NoMemory,
    /// Boundaries that act linearly within an implicit step.
    BoundariesWithinStep,
    /// No contact.
    NoInteractions,
    /// Contact without dampers and friction.
    ConservativeInteractions,
    /// No rigid bodies that move under the forces of the points.
    NoFreeBodies,
    /// A body that is not divided among several processes.
    WholeBody,
    /// No points that become active during the run.
    NoActivation,
}

/// A requirement of a scheme, with its reason.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Requirement {
    /// The requirement.
    pub need: Need,
    /// The reason, and what to use if the requirement is not met.
    pub reason: &'static str,
}

impl Requirement {
    /// The requirement of schemes that solve equations.
    pub const IN_DOUBLES: Self = Self {
        need: Need::DoublePrecision,
        reason: "it solves equations to more digits than forces in single precision have; use forces in double precision",
    };

    /// The requirement of schemes that evaluate forces between the ends of steps.
    pub const CONSERVATIVE_CONTACT: Self = Self {
        need: Need::ConservativeInteractions,
        reason: "dampers and friction of contact act on the mean velocity of a step, which this scheme does not have; use velocity-verlet, or contact without damping and friction",
    };

    /// The requirement of schemes that know the bonds of zones from the start.
    pub const NO_ACTIVATION: Self = Self {
        need: Need::NoActivation,
        reason: "its zones are those of the bonds at the start of the run, but points become active later; use velocity-verlet, or remove [[activation]]",
    };

    /// The requirement of schemes that move the points only.
    pub const NO_FREE_BODIES: Self = Self {
        need: Need::NoFreeBodies,
        reason: "rigid bodies that move freely advance by the steps of velocity-verlet; use it, or prescribe their motion",
    };
}

impl Need {
    /// Returns whether a system meets the requirement.
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
            Self::NoInteractions => !system.has_interactions(),
            Self::ConservativeInteractions => {
                system.interactions().all(|one| one.is_conservative())
            }
            Self::NoActivation => !system.has_activation(),
            Self::WholeBody => !system.domain().is_divided(),
            Self::NoFreeBodies => !system.interactions().any(|one| one.has_free_bodies()),
        }
    }
}

/// Checks that a system meets the requirements of a scheme; the error names the first one that it does not meet.
///
/// # Errors
/// [`PericlesError::SchemeNotUsable`].
pub fn require(scheme: &'static str, requirements: &[Requirement], system: &System) -> Result<()> {
    match requirements.iter().find(|one| !one.need.is_met_by(system)) {
        None => Ok(()),
        Some(Requirement { reason, .. }) => Err(PericlesError::SchemeNotUsable { scheme, reason }),
    }
}
