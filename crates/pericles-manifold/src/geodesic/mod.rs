//! Geodesic distances of all pairs of vertices within a horizon.
//!
//! | method | paths | error |
//! |---|---|---|
//! | [`GeodesicMethod::Exact`] | shortest paths on the polyhedron, by windows | round-off; with respect to the smooth surface O(h²) |
//! | [`GeodesicMethod::Edge`] | shortest paths along the edges (Dijkstra) | does not vanish with refinement: up to 15.5 % on equilateral triangles |
//! | [`GeodesicMethod::EdgeDiagonals`] | edges and diagonals of pairs of triangles | does not vanish: up to 5 % |
//! | [`GeodesicMethod::Steiner`] | straight lines between k points on each edge | does not vanish: 3 %, 1.5 %, 0.6 % for k = 2, 3, 5 |
//!
//! (Largest errors on icospheres of the unit sphere within 0.5, measured by the study `manifolds/geodesics`.)
//! Coclite, Coclite, Maddalena and Politi (2022) use distances along edges; with these the peridynamic operator
//! does not converge to that of the smooth surface.
//!
//! Sources are independent: each is searched by one thread, up to the horizon only, so the cost is proportional
//! to the number of pairs found. Distances are symmetric to the last bit and do not depend on the number of
//! threads. [`geodesic_pairs_cached`] stores them between runs. [`Ball`] selects the bonds: pairs within a
//! geodesic or a Euclidean ball.
//!
//! Exact distances are the default, because distances along edges do not converge under refinement. The rules that
//! discard windows keep those that are uncertain within rounding; tests compare with rays traced without these rules.
//!
//! ```
//! use pericles_manifold::geodesic::{GeodesicMethod, geodesic_pairs};
//! use pericles_manifold::surface::Surface;
//! let sphere = Surface::icosphere(3, 1.0)?;
//! let pairs = geodesic_pairs(&sphere, 0.5, GeodesicMethod::Exact)?;
//! assert_eq!(pairs.len(), 23580);
//! let along_edges = geodesic_pairs(&sphere, 0.5, GeodesicMethod::Edge)?;
//! assert_eq!(along_edges.len(), 22740);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod ball;
mod errors;
mod exact;
mod graph;
mod method;
mod pairs;
mod stored;
mod unfolding;

pub use ball::Ball;
pub use errors::GeodesicErrors;
pub use method::{GeodesicMethod, UnknownMethod};
pub use pairs::GeodesicPairs;
pub use stored::geodesic_pairs_cached;

use graph::Graph;

use crate::surface::{HalfEdges, Surface};
use pericles::{PericlesError, Result, positive};

/// Returns the pairs of vertices whose distance is below `delta` (m), with their distances. d_ij is the smaller
/// of the distances found from i and from j.
///
/// # Errors
/// `delta` is not positive; the surface is not an oriented manifold; a vertex has no neighbour; the number of
/// points on an edge is zero or above [`GeodesicMethod::MOST_POINTS`].
pub fn geodesic_pairs(
    surface: &Surface,
    delta: f64,
    method: GeodesicMethod,
) -> Result<GeodesicPairs> {
    positive("the horizon", delta)?;
    let half_edges = HalfEdges::new(surface)?;
    let pairs = match method.checked()? {
        GeodesicMethod::Exact => exact::pairs(surface, half_edges, delta),
        GeodesicMethod::Edge => Graph::of_edges(surface, &half_edges).pairs(delta),
        GeodesicMethod::EdgeDiagonals => Graph::with_diagonals(surface, &half_edges).pairs(delta),
        GeodesicMethod::Steiner(points) => {
            Graph::with_points(surface, &half_edges, points).pairs(delta)
        }
    };
    if (0..surface.len()).any(|vertex| pairs.row(vertex).0.is_empty()) {
        return Err(PericlesError::HorizonTooSmall {
            horizon: delta,
            spacing: surface.median_edge(),
        });
    }
    Ok(pairs)
}

/// Returns the length of the shortest path between two vertices, m, without a limit on its length; `None` if no
/// path connects them. The smaller of the lengths found from both ends.
///
/// # Errors
/// The surface is not an oriented manifold; the number of points on an edge is zero or above
/// [`GeodesicMethod::MOST_POINTS`].
///
/// # Panics
/// If the surface does not have these vertices.
pub fn geodesic_distance(
    surface: &Surface,
    [a, b]: [usize; 2],
    method: GeodesicMethod,
) -> Result<Option<f64>> {
    assert!(a.max(b) < surface.len(), "a vertex beyond the last");
    let half_edges = HalfEdges::new(surface)?;
    let ends = [a as u32, b as u32];
    Ok(match method.checked()? {
        GeodesicMethod::Exact => {
            // The shortest path along edges is an upper bound.
            let along_edges = Graph::of_edges(surface, &half_edges).distance(ends);
            along_edges.map(|most| exact::distance(surface, half_edges, ends, most))
        }
        GeodesicMethod::Edge => Graph::of_edges(surface, &half_edges).distance(ends),
        GeodesicMethod::EdgeDiagonals => Graph::with_diagonals(surface, &half_edges).distance(ends),
        GeodesicMethod::Steiner(points) => {
            Graph::with_points(surface, &half_edges, points).distance(ends)
        }
    })
}
