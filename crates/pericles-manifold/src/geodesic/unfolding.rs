//! Triangles unfolded into a plane, each next to the edge through which it is entered.

use crate::surface::{HalfEdges, Surface};

/// Triangle in the plane, seen from one of its half-edges: the half-edge runs from the origin along x, the
/// third corner (the apex) lies at y > 0.
///
/// A path that enters the triangle through the half-edge leaves it through the left edge, between origin and
/// apex, or the right edge, between apex and target.
#[derive(Debug, Clone, Copy)]
pub(super) struct Panel {
    /// Length of the half-edge.
    pub(super) length: f64,
    /// The apex.
    pub(super) apex: [f64; 2],
    /// The edge on the left.
    pub(super) left: Exit,
    /// The edge on the right.
    pub(super) right: Exit,
    /// Vertex at which the half-edge starts.
    pub(super) origin: u32,
    /// Vertex at which it ends.
    pub(super) target: u32,
    /// The vertex at the apex.
    pub(super) apex_vertex: u32,
}

/// Edge through which a panel is left, with the frame of the panel beyond: its half-edge lies along x, the
/// panel left behind at y < 0.
#[derive(Debug, Clone, Copy)]
pub(super) struct Exit {
    /// The half-edge of the panel beyond, or [`HalfEdges::NONE`].
    pub(super) beyond: u32,
    /// Length of the edge.
    pub(super) length: f64,
    /// Start of the half-edge beyond.
    start: [f64; 2],
    /// Its direction.
    along: [f64; 2],
}

impl Exit {
    fn new(beyond: u32, length: f64, start: [f64; 2], end: [f64; 2]) -> Self {
        Self {
            beyond,
            length,
            start,
            along: [0, 1].map(|c| (end[c] - start[c]) / length),
        }
    }

    /// Transforms a point of this panel into the frame of the one beyond.
    pub(super) fn place(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = [point[0] - self.start[0], point[1] - self.start[1]];
        let [tx, ty] = self.along;
        [x * tx + y * ty, y * tx - x * ty]
    }
}

/// All panels of a surface, one per half-edge, and the angles that the search needs.
pub(super) struct Unfolding {
    pub(super) half_edges: HalfEdges,
    pub(super) panels: Vec<Panel>,
    /// Angle between a half-edge and the previous one, at its origin.
    pub(super) angles: Vec<f64>,
    /// Total angle at each vertex that shortest paths can pass (saddles and flat vertices).
    pub(super) passable: Vec<Option<f64>>,
}

/// Tolerance below 2π within which the total angle of a vertex counts as flat: round-off of the angles.
const FLAT: f64 = 1e-9;

impl Unfolding {
    pub(super) fn new(surface: &Surface, half_edges: HalfEdges) -> Self {
        let lengths = surface.half_edge_lengths(&half_edges);
        let panels = (0..half_edges.len() as u32)
            .map(|h| panel(&half_edges, &lengths, h))
            .collect();
        let angles: Vec<f64> = surface
            .triangles()
            .iter()
            .flat_map(|&triangle| surface.corner_angles(triangle))
            .collect();
        let passable = (0..surface.len())
            .map(|vertex| {
                if half_edges.on_boundary(vertex) {
                    return Some(f64::INFINITY);
                }
                let around = half_edges.around(vertex).iter();
                let total: f64 = around.map(|&h| angles[h as usize]).sum();
                (total > 2.0 * std::f64::consts::PI - FLAT).then_some(total)
            })
            .collect();
        Self {
            half_edges,
            panels,
            angles,
            passable,
        }
    }
}

/// Builds the panel of a half-edge.
pub(super) fn panel(half_edges: &HalfEdges, lengths: &[f64], h: u32) -> Panel {
    let (next, previous) = (HalfEdges::next(h), HalfEdges::previous(h));
    let [base, right, left] = [h, next, previous].map(|h| lengths[h as usize]);
    let x = 0.5 * (base + (left - right) * (left + right) / base);
    let apex = [x, ((left - x) * (left + x)).max(0.0).sqrt()];
    Panel {
        length: base,
        apex,
        left: Exit::new(half_edges.twin(previous), left, [0.0; 2], apex),
        right: Exit::new(half_edges.twin(next), right, apex, [base, 0.0]),
        origin: half_edges.origin(h),
        target: half_edges.target(h),
        apex_vertex: half_edges.origin(previous),
    }
}
