//! Force kernels and the features they do not support.

use super::limits::{Feature, Features, Limit};
use crate::error::Result;
use crate::neighbourhood::NO_LATTICE;

/// Force kernels, by the way bonds are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BondForm {
    /// Grid if the points fill enough of a lattice, otherwise list.
    #[default]
    Fastest,
    /// One stencil for all nodes of a lattice ([`GridForce`](super::GridForce),
    /// [`LinearSolidGrid`](super::LinearSolidGrid)).
    Grid,
    /// A stencil with forces and bond failure in single precision
    /// ([`GridForce::in_floats`](super::GridForce::in_floats)).
    FloatGrid,
    /// Neighbour list ([`BondForce`](super::BondForce), [`LinearSolidForce`](super::LinearSolidForce)).
    List,
}

const OF_GRID: &[Limit] = &[
    Limit::CORRESPONDENCE,
    Limit::SEVERAL_SPACINGS,
    Limit::new(Feature::NoLattice, NO_LATTICE),
    Limit::new(Feature::GaussNodes, NO_LATTICE),
    Limit::BOND_ENERGY,
    Limit::STRESS_FAILURE,
    Limit::SOFTENING,
    Limit::ACTIVATION,
];

/// State-based materials and thermal expansion are not supported in single precision.
const OF_FLOAT_GRID: &[Limit] = &preceded::<{ OF_GRID.len() + 2 }>(
    Limit::STATE_BASED,
    &preceded::<{ OF_GRID.len() + 1 }>(Limit::THERMAL_EXPANSION, OF_GRID),
);

/// Returns a limit followed by others.
const fn preceded<const N: usize>(first: Limit, others: &[Limit]) -> [Limit; N] {
    let mut limits = [first; N];
    let mut k = 0;
    while k < others.len() {
        limits[k + 1] = others[k];
        k += 1;
    }
    limits
}

impl BondForm {
    /// Returns the name in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fastest => "fastest",
            Self::Grid => "grid",
            Self::FloatGrid => "grid-f32",
            Self::List => "list",
        }
    }

    /// Returns the features that the kernel does not support. The first one that a body has is the reason of
    /// the error. The fastest kernel is a list if a grid is not possible.
    pub fn limits(self) -> &'static [Limit] {
        match self {
            Self::Fastest | Self::List => &[],
            Self::Grid => OF_GRID,
            Self::FloatGrid => OF_FLOAT_GRID,
        }
    }

    /// Checks that the kernel supports a body with these features.
    ///
    /// # Errors
    /// [`FormNotUsable`](crate::PericlesError::FormNotUsable) with the reason.
    pub fn check(self, features: Features) -> Result<()> {
        Limit::check(self.limits(), self.name(), features)
    }
}
