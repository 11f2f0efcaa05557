//! Shortest paths in a graph whose nodes lie on a surface.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::GeodesicPairs;
use crate::space::surface::{HalfEdges, Surface};

/// A graph with lengths, in compressed rows. The first nodes are the vertices of the surface.
pub(super) struct Graph {
    vertices: usize,
    start: Vec<usize>,
    target: Vec<u32>,
    length: Vec<f64>,
}

impl Graph {
    /// From undirected links.
    pub(super) fn new(vertices: usize, nodes: usize, links: &[(u32, u32, f64)]) -> Self {
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

    /// The edges of the triangles.
    pub(super) fn of_edges(surface: &Surface, half_edges: &HalfEdges) -> Self {
        let links: Vec<(u32, u32, f64)> = edge_links(surface, half_edges).collect();
        Self::new(surface.len(), surface.len(), &links)
    }

    /// All pairs of vertices whose shortest path is below `delta`.
    pub(super) fn pairs(&self, delta: f64) -> GeodesicPairs {
        GeodesicPairs::search(
            self.vertices,
            || Front::new(self.start.len() - 1),
            |front, source, row| self.search(source, delta, front, row),
        )
    }

    /// Dijkstra's search from one vertex up to `delta`.
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

/// The edges of the triangles as links.
pub(super) fn edge_links<'a>(
    surface: &'a Surface,
    half_edges: &'a HalfEdges,
) -> impl Iterator<Item = (u32, u32, f64)> + 'a {
    half_edges.edges().map(|h| {
        let (a, b) = (half_edges.origin(h), half_edges.target(h));
        (a, b, surface.chord(a.min(b) as usize, a.max(b) as usize))
    })
}

/// What one thread keeps from source to source: only what a search has touched is reset after it.
struct Front {
    distance: Vec<f64>,
    touched: Vec<u32>,
    /// Distances as bits, which for positive numbers sort alike, and nodes; the lowest first.
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
