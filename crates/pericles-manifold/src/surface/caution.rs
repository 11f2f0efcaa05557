//! What should be known about a horizon on a surface.

use std::fmt;

use super::Surface;

/// Something about the horizon on a surface that a user should know.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum SurfaceCaution {
    /// The horizon is short.
    ShortHorizon {
        /// Horizon over median edge.
        ratio: f64,
    },
    /// The horizon is long.
    LongHorizon {
        /// Horizon over median edge.
        ratio: f64,
    },
    /// There are few bonds.
    FewNeighbours {
        /// Neighbours of a vertex, on average.
        mean: f64,
    },
}

impl fmt::Display for SurfaceCaution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ShortHorizon { ratio } => write!(
                f,
                "the horizon is {ratio:.2} median edges; below 2 the directions of bonds are those of the mesh"
            ),
            Self::LongHorizon { ratio } => write!(
                f,
                "the horizon is {ratio:.1} median edges; above 15 time and memory grow with its square and little is gained"
            ),
            Self::FewNeighbours { mean } => write!(
                f,
                "vertices have {mean:.1} neighbours on average; with fewer than 12 the sums are coarse"
            ),
        }
    }
}

impl Surface {
    /// What should be known about a horizon (m) that gives vertices this many neighbours on average.
    pub fn cautions(&self, horizon: f64, mean_neighbours: f64) -> Vec<SurfaceCaution> {
        let ratio = horizon / self.median_edge();
        let mut cautions = Vec::new();
        if ratio < 2.0 {
            cautions.push(SurfaceCaution::ShortHorizon { ratio });
        }
        if ratio > 15.0 {
            cautions.push(SurfaceCaution::LongHorizon { ratio });
        }
        if mean_neighbours < 12.0 {
            cautions.push(SurfaceCaution::FewNeighbours {
                mean: mean_neighbours,
            });
        }
        cautions
    }
}
