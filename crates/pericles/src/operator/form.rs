//! Names of the forms in which bonds are kept.

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
}
