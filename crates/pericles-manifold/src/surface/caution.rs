//! Warnings about the horizon on a surface.

use std::fmt;

use super::Surface;

/// Warning about the horizon on a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum SurfaceCaution {
    /// The horizon is small.
    ShortHorizon {
        /// Horizon divided by the median edge length.
        ratio: f64,
    },
    /// The horizon is large.
    LongHorizon {
        /// Horizon divided by the median edge length.
        ratio: f64,
    },
    /// The vertices have few neighbours.
    FewNeighbours {
        /// Mean number of neighbours per vertex.
        mean: f64,
    },
}

impl fmt::Display for SurfaceCaution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ShortHorizon { ratio } => write!(
                f,
                "the horizon is {ratio:.2} median edge lengths; with fewer than 2 the bond directions follow the \
                mesh. Increase `horizon` or refine the surface"
            ),
            Self::LongHorizon { ratio } => write!(
                f,
                "the horizon is {ratio:.1} median edge lengths; above 15 time and memory grow with its square at \
                little gain in accuracy. Reduce `horizon` or coarsen the surface"
            ),
            Self::FewNeighbours { mean } => write!(
                f,
                "vertices have {mean:.1} neighbours on average; with fewer than 12 the quadrature is inaccurate. \
                Increase `horizon` or refine the surface"
            ),
        }
    }
}

impl Surface {
    /// Returns the warnings for a horizon (m) that gives vertices this mean number of neighbours.
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
