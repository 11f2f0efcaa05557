//! Methods for geodesic distances.

use std::fmt;
use std::str::FromStr;

use pericles::{PericlesError, Result};

/// Method for distances along a surface. As text: `exact`, `edge`, `edge-diagonals`, `steiner(3)`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum GeodesicMethod {
    /// Exact shortest paths on the triangles.
    #[default]
    Exact,
    /// Along the edges of the triangles.
    Edge,
    /// Along the edges and the diagonals of triangle pairs: straight lines between the two corners opposite an
    /// edge that cross it when both triangles are unfolded.
    EdgeDiagonals,
    /// Along straight lines through the triangles, between corners and this many evenly spaced points on each
    /// edge.
    Steiner(u32),
}

impl GeodesicMethod {
    /// Largest number of points on an edge; the number of links grows with its square.
    pub const MOST_POINTS: u32 = 32;

    /// Allowed texts.
    pub const NAMES: &str = "exact, edge, edge-diagonals, steiner(1) to steiner(32)";

    pub(super) fn checked(self) -> Result<Self> {
        match self {
            Self::Steiner(points) if !(1..=Self::MOST_POINTS).contains(&points) => {
                Err(PericlesError::OutOfRange {
                    quantity: "the number of points on an edge",
                    value: f64::from(points),
                    allowed: "1 to 32",
                })
            }
            _ => Ok(self),
        }
    }
}

impl fmt::Display for GeodesicMethod {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact => f.pad("exact"),
            Self::Edge => f.pad("edge"),
            Self::EdgeDiagonals => f.pad("edge-diagonals"),
            Self::Steiner(points) => f.pad(&format!("steiner({points})")),
        }
    }
}

/// Text that is not a method.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "\"{given}\" is not a method for geodesic distances; allowed: {}",
    GeodesicMethod::NAMES
)]
pub struct UnknownMethod {
    given: String,
}

impl FromStr for GeodesicMethod {
    type Err = UnknownMethod;

    fn from_str(text: &str) -> std::result::Result<Self, UnknownMethod> {
        let unknown = || UnknownMethod { given: text.into() };
        match text {
            "exact" => Ok(Self::Exact),
            "edge" => Ok(Self::Edge),
            "edge-diagonals" => Ok(Self::EdgeDiagonals),
            _ => text
                .strip_prefix("steiner(")
                .and_then(|rest| rest.strip_suffix(')')?.parse().ok())
                .and_then(|points| Self::Steiner(points).checked().ok())
                .ok_or_else(unknown),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_of_a_method_parses_to_the_same_method() {
        for method in [
            GeodesicMethod::Exact,
            GeodesicMethod::Edge,
            GeodesicMethod::EdgeDiagonals,
            GeodesicMethod::Steiner(32),
        ] {
            assert_eq!(method.to_string().parse(), Ok(method));
        }
        for wrong in [
            "",
            "Exact",
            "steiner",
            "steiner(0)",
            "steiner(33)",
            "steiner(-1)",
            "heat",
        ] {
            let error = wrong.parse::<GeodesicMethod>().unwrap_err();
            assert!(error.to_string().contains("edge-diagonals, steiner(1)"));
        }
    }
}
