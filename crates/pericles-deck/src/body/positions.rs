//! Positions of points: on a lattice or random, one or two in each cell.

use pericles_deck_derive::{DeckKeys, DeckWords};
use serde::{Deserialize, Serialize};

use crate::range::{Range, between};

/// Positions of the points. `lattice`: at the cell centres. `jittered`: displaced at random from the cell centres by at most
/// `jitter` spacings along each axis; each point keeps its cell volume. `blue-noise`: random with a minimum distance of
/// about 0.9 spacings in 3D (0.84 in 2D); each point has the volume of its Voronoi cell. Random positions avoid cracks that
/// follow the lattice; they use a neighbour list.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[deck(tag = "positions", what = "kind of positions")]
pub enum Positions {
    /// Lattice nodes.
    #[default]
    Lattice,
    /// Lattice nodes with random displacements.
    Jittered {
        /// positions = "jittered": largest displacement along each axis, in spacings.
        #[deck(range = JITTERS, default = 0.25)]
        jitter: f64,
        /// Random seed of the positions. Equal seeds give equal positions on every machine and for every number of threads.
        #[deck(default = 1)]
        seed: u64,
    },
    /// Blue noise (maximal Poisson-disc sampling): random with a minimum distance.
    BlueNoise {
        /// Random seed of the positions. Equal seeds give equal positions on every machine and for every number of threads.
        #[deck(default = 1)]
        seed: u64,
    },
}

impl Positions {
    /// Returns whether the positions are random.
    pub fn are_random(&self) -> bool {
        *self != Self::Lattice
    }
}

const JITTERS: Range = between(0.0, 0.5).described("a number of spacings above 0 and below 0.5");

/// Quadrature points of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "snake_case")]
#[deck(what = "quadrature")]
pub enum Quadrature {
    /// One point at the centre.
    #[default]
    Midpoint,
    /// The two Gauss nodes of a cell of a bar.
    Gauss,
}
