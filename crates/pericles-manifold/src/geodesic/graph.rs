//! Shortest paths in a graph whose nodes lie on a surface.

use pericles::vector::{minus, norm};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::GeodesicPairs;
use super::unfolding::panel;
use crate::surface::{HalfEdges, Surface};
use pericles::space::Point;

/// Weighted graph in compressed rows. The first nodes are the vertices of the surface.
pub(super) struct Graph {
    vertices: usize,
    start: Vec<usize>,
    target: Vec<u32>,
    length: Vec<f64>,
}

impl Graph {
    /// Builds the graph from undirected links.
    fn new(vertices: usize, nodes: usize, links: &[(u32, u32, f64)]) -> Self {
        let mut start = vec![0; nodes + 1];
        for &(a, b, _) in links {
            start[a as usize + 1] += 1;
            start[b as usize + 1] += 1;
        }
        for k in 1..start.len() {
            start[k] += start[k - 1];
        }
        let mut next = start.clone();
        let mut target = vec![0; 2 * links.len()];
        let mut length = vec![0.0; 2 * links.len()];
        for &(a, b, between) in links {
            for (from, to) in [(a, b), (b, a)] {
                let place = next[from as usize];
                next[from as usize] += 1;
                target[place] = to;
                length[place] = between;
            }
        }
        Self {
            vertices,
            start,
            target,
            length,
        }
    }

    /// Graph of the triangle edges.
    pub(super) fn of_edges(surface: &Surface, half_edges: &HalfEdges) -> Self {
        let links: Vec<(u32, u32, f64)> = edge_links(surface, half_edges).collect();
        Self::new(surface.len(), surface.len(), &links)
    }

    /// Graph of the triangle edges and the diagonals of triangle pairs: the straight line between the two
    /// corners opposite an edge, if it crosses that edge when both triangles are unfolded.
    pub(super) fn with_diagonals(surface: &Surface, half_edges: &HalfEdges) -> Self {
        let mut links: Vec<(u32, u32, f64)> = edge_links(surface, half_edges).collect();
        let lengths = surface.half_edge_lengths(half_edges);
        for h in half_edges.edges() {
            let twin = half_edges.twin(h);
            if twin == HalfEdges::NONE {
                continue;
            }
            let [above, below] = [h, twin].map(|h| panel(half_edges, &lengths, h));
            let [x, y] = above.apex;
            let [opposite_x, opposite_y] = [above.length - below.apex[0], -below.apex[1]];
            let crossing = x + (opposite_x - x) * y / (y - opposite_y);
            if crossing > 0.0 && crossing < above.length && above.apex_vertex != below.apex_vertex {
                let length = (x - opposite_x).hypot(y - opposite_y);
                links.push((above.apex_vertex, below.apex_vertex, length));
            }
        }
        Self::new(surface.len(), surface.len(), &links)
    }

    /// Graph of straight lines through the triangles, between corners and `points` evenly spaced points on each
    /// edge (Lanthier, Maheshwari, Sack 1997).
    pub(super) fn with_points(surface: &Surface, half_edges: &HalfEdges, points: u32) -> Self {
        let mut places = surface.positions().to_vec();
        // The first point on the edge of each half-edge.
        let mut first = vec![0; half_edges.len()];
        let mut links = Vec::new();
        let between = |places: &[Point], a: u32, b: u32| {
            (a, b, norm(minus(places[a as usize], places[b as usize])))
        };
        for h in half_edges.edges() {
            let (a, b) = (half_edges.origin(h), half_edges.target(h));
            let begin = places.len() as u32;
            first[h as usize] = begin;
            if half_edges.twin(h) != HalfEdges::NONE {
                first[half_edges.twin(h) as usize] = begin;
            }
            for k in 1..=points {
                let part = f64::from(k) / f64::from(points + 1);
                let [p, q] = [a, b].map(|v| surface.positions()[v as usize]);
                places.push(std::array::from_fn(|c| p[c] + part * (q[c] - p[c])));
            }
            let nodes = |k: u32| match k {
                0 => a,
                k if k > points => b,
                k => begin + k - 1,
            };
            links.extend((0..=points).map(|k| between(&places, nodes(k), nodes(k + 1))));
        }
        for triangle in 0..half_edges.len() as u32 / 3 {
            let sides = [0, 1, 2].map(|k| 3 * triangle + k);
            for (side, next) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (sides[a], sides[b])) {
                let on = |h: u32| first[h as usize]..first[h as usize] + points;
                for a in on(side) {
                    links.extend(on(next).map(|b| between(&places, a, b)));
                    let opposite = half_edges.origin(HalfEdges::previous(side));
                    links.push(between(&places, a, opposite));
                }
            }
        }
        Self::new(surface.len(), places.len(), &links)
    }

    /// Finds all pairs of vertices whose shortest path is below `delta`.
    pub(super) fn pairs(&self, delta: f64) -> GeodesicPairs {
        GeodesicPairs::search(
            self.vertices,
            || Front::new(self.start.len() - 1),
            |front, source, row| self.search(source, delta, front, row),
        )
    }

    /// Returns the length of the shortest path between two vertices, searched from both ends; `None` if there
    /// is no path.
    pub(super) fn distance(&self, [a, b]: [u32; 2]) -> Option<f64> {
        if a == b {
            return Some(0.0);
        }
        let mut front = Front::new(self.start.len() - 1);
        let mut shortest: Option<f64> = None;
        for (source, target) in [(a, b), (b, a)] {
            let mut row = Vec::new();
            self.search(source, f64::INFINITY, &mut front, &mut row);
            let found = row.into_iter().find(|(vertex, _)| *vertex == target);
            if let Some((_, distance)) = found {
                shortest = Some(shortest.map_or(distance, |other| other.min(distance)));
            }
        }
        shortest
    }

    /// Runs Dijkstra's algorithm from one vertex up to `delta`.
    fn search(&self, source: u32, delta: f64, front: &mut Front, row: &mut Vec<(u32, f64)>) {
        front.reach(source, 0.0);
        while let Some(Reverse((bits, node))) = front.heap.pop() {
            let distance = f64::from_bits(bits);
            if distance > front.distance[node as usize] {
                continue;
            }
            if node != source && (node as usize) < self.vertices {
                row.push((node, distance));
            }
            for link in self.start[node as usize]..self.start[node as usize + 1] {
                let beyond = distance + self.length[link];
                if beyond < delta && beyond < front.distance[self.target[link] as usize] {
                    front.reach(self.target[link], beyond);
                }
            }
        }
        front.clear();
    }
}

/// Triangle edges as links.
fn edge_links<'a>(
    surface: &'a Surface,
    half_edges: &'a HalfEdges,
) -> impl Iterator<Item = (u32, u32, f64)> + 'a {
    half_edges.edges().map(|h| {
        let (a, b) = (half_edges.origin(h), half_edges.target(h));
        (a, b, surface.chord(a.min(b) as usize, a.max(b) as usize))
    })
}

/// Working memory of one thread; only entries touched by a search are reset after it.
struct Front {
    distance: Vec<f64>,
    touched: Vec<u32>,
    /// Min-heap of distances and nodes. Distances are stored as bits, which for positive numbers have the same order.
    heap: BinaryHeap<Reverse<(u64, u32)>>,
}

impl Front {
    fn new(nodes: usize) -> Self {
        Self {
            distance: vec![f64::INFINITY; nodes],
            touched: Vec::new(),
            heap: BinaryHeap::new(),
        }
    }

    fn reach(&mut self, node: u32, distance: f64) {
        if self.distance[node as usize] == f64::INFINITY {
            self.touched.push(node);
        }
        self.distance[node as usize] = distance;
        self.heap.push(Reverse((distance.to_bits(), node)));
    }

    fn clear(&mut self) {
        for &node in &self.touched {
            self.distance[node as usize] = f64::INFINITY;
        }
        self.touched.clear();
    }
}
