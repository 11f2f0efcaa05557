//! The forms in which bonds are kept, and what they do not represent.

use super::limits::{Feature, Features, Limit};
use crate::error::Result;

/// How bonds are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BondForm {
    /// The grid where the points fill a lattice well enough, else the list.
    #[default]
    Fastest,
    /// One stencil for all nodes of a lattice ([`GridForce`](super::GridForce), [`LinearSolidGrid`](super::LinearSolidGrid)).
    Grid,
    /// The same with forces and breaking computed in floats ([`GridForce::in_floats`](super::GridForce::in_floats)).
    FloatGrid,
    /// A list of every point's bonds ([`BondForce`](super::BondForce), [`LinearSolidForce`](super::LinearSolidForce)).
    List,
}

const NO_LATTICE: &str = "its points lie on no regular grid; use \"list\"";

const OF_GRID: &[Limit] = &[
    Limit::CORRESPONDENCE,
    Limit::SEVERAL_SPACINGS,
    Limit::new(Feature::NoLattice, NO_LATTICE),
    Limit::new(Feature::GaussNodes, NO_LATTICE),
    Limit::BOND_ENERGY,
    Limit::THERMAL_EXPANSION,
];

/// In floats no state-based material is computed either.
const OF_FLOAT_GRID: &[Limit] = &preceded::<{ OF_GRID.len() + 1 }>(Limit::STATE_BASED, OF_GRID);

/// A limit and others behind it.
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
    /// As written in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fastest => "fastest",
            Self::Grid => "grid",
            Self::FloatGrid => "grid-f32",
            Self::List => "list",
        }
    }

    /// What the form does not represent; the first limit that a body exceeds is the reason of its refusal. The fastest form is a list where a grid is not possible.
    pub fn limits(self) -> &'static [Limit] {
        match self {
            Self::Fastest | Self::List => &[],
            Self::Grid => OF_GRID,
            Self::FloatGrid => OF_FLOAT_GRID,
        }
    }

    /// Refuses a body with features that the form does not represent.
    ///
    /// # Errors
    /// [`FormNotUsable`](crate::PericlesError::FormNotUsable), with the reason.
    pub fn check(self, features: Features) -> Result<()> {
        Limit::check(self.limits(), self.name(), features)
    }
}
