//! Distances along a surface, of all pairs of vertices nearer than a horizon.
//!
//! | method | what | error |
//! |---|---|---|
//! | [`GeodesicMethod::Exact`] | shortest paths on the polyhedron, by windows | rounding; as a distance on the smooth surface O(h²) |
//! | [`GeodesicMethod::Edge`] | shortest paths along the edges (Dijkstra) | does not vanish with refinement: up to 15.5 % on equilateral triangles |
//! | [`GeodesicMethod::EdgeDiagonals`] | edges, and straight lines across pairs of triangles | does not vanish: up to 5 % |
//! | [`GeodesicMethod::Steiner`] | straight lines between k points on each edge | does not vanish: 3 %, 1.5 %, 0.6 % for k = 2, 3, 5 |
//!
//! (Largest errors on icospheres of the unit sphere within 0.5, where the study `manifolds/geodesics` measures them.) Coclite, Coclite, Maddalena and
//! Politi (2022) take distances along edges; with these the peridynamic operator does not converge to that of the smooth surface.
//!
//! All sources are independent: each is searched by one thread, up to the horizon only, so that the cost is that of the pairs found. Distances are
//! symmetric to the last bit, and do not depend on the number of threads. [`geodesic_pairs_cached`] keeps them from run to run.
//! [`Ball`] says which pairs are bonds: those near along the surface, or those near in space.
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

/// The pairs of vertices whose distance is below `delta` (m), with their distances.
///
/// d_ij is the lower of what the searches from i and from j find.
///
/// # Errors
/// `delta` is not positive; the surface is no oriented manifold; a vertex has no neighbour; more points on an edge than
/// [`GeodesicMethod::MOST_POINTS`], or none.
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

/// The length of the shortest path between two vertices, m, however long; none if no path joins them. The lower of what the searches from both ends find.
///
/// # Errors
/// The surface is no oriented manifold; more points on an edge than [`GeodesicMethod::MOST_POINTS`], or none.
///
/// # Panics
/// Vertices that the surface does not have.
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
            // No path is longer than that along edges.
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
