//! The forms in which bonds are kept, and what they do not represent.

use super::limits::{Feature, Features, Limit};
use crate::error::Result;

/// How bonds are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BondForm {
    /// The grid where the points fill a lattice well enough, else the list.
    #[default]
    Fastest,
    /// One stencil for all nodes of a lattice ([`GridForce`](super::GridForce)).
    Grid,
    /// The same with forces and breaking computed in floats ([`GridForce::in_floats`](super::GridForce::in_floats)).
    FloatGrid,
    /// A list of every point's bonds ([`BondForce`](super::BondForce)).
    List,
}

const NO_LATTICE: &str = "its points lie on no regular grid; use \"list\"";

const OF_GRID: &[Limit] = &[
    Limit::STATE_BASED,
    Limit::SEVERAL_SPACINGS,
    Limit::listed_law(Feature::GreenStrainBar),
    Limit::listed_law(Feature::GreenStrain),
    Limit::listed_law(Feature::OtherCubic),
    Limit::new(Feature::NoLattice, NO_LATTICE),
    Limit::new(Feature::GaussNodes, NO_LATTICE),
];

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
            Self::Grid | Self::FloatGrid => OF_GRID,
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
