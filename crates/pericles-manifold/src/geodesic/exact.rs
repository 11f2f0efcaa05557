//! Exact shortest paths on a polyhedron by window propagation.
//!
//! All shortest paths that cross the same sequence of triangles form a fan of straight rays when these
//! triangles are unfolded into a plane. A *window* is the part of an edge that such a fan crosses, with the
//! image of the fan's centre in the plane of the next triangle and the distance σ of that centre from the
//! source (non-zero if paths have bent at a saddle vertex before). A window that enters a triangle gives a
//! distance to its third corner and leaves through one or both of the other edges. Windows are processed in
//! order of their distance from the source, so windows that start beyond the horizon are never created.
//!
//! Three rules limit the number of windows; none of them drops one that carries a shortest path:
//! * of the windows that enter a triangle through the same edge and see its third corner, the nearest one
//!   passes on both sides, any other only on the side on which it enters (Chen & Han 1990: one angle, one
//!   split);
//! * a window whose rays are all longer than a path through one of the nearby corners is dropped (Xin & Wang
//!   2009, theorem 3.2);
//! * paths bend only at vertices with a total angle of at least 2π, leaving an angle of at least π on either
//!   side (Mitchell, Mount, Papadimitriou 1987).
//!
//! Time per source: O(n² log n) in the worst case for n triangles within the horizon; on smooth surfaces a few
//! windows per edge.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::PI;

use super::GeodesicPairs;
use super::unfolding::{Exit, Panel, Unfolding};
use crate::surface::{HalfEdges, Surface};

/// Windows narrower than this fraction of their edge are dropped as round-off.
const NARROWEST: f64 = 1e-13;

/// Rays closer to each other than this fraction of the edge are treated as equal.
const SAME_RAY: f64 = 1e-9;

/// Factor by which a path must be shorter to count as shorter, beyond round-off.
const SHORTER: f64 = 1.0 - 1e-12;

/// Tolerance of the angles at which paths leave a saddle, rad: adds windows, does not change distances.
const SLACK: f64 = 1e-7;

/// Bit that marks vertex events in the queue of windows.
const VERTEX: u32 = 1 << 31;

/// Part of an edge crossed by straight rays from one image of their centre, in the frame of the panel they
/// enter.
#[derive(Debug, Clone, Copy)]
struct Window {
    half_edge: u32,
    low: f64,
    high: f64,
    image: [f64; 2],
    sigma: f64,
}

/// Best path so far to a corner through the opposite edge.
#[derive(Debug, Clone, Copy)]
struct Sight {
    distance: f64,
    /// Where the ray to the corner crosses the edge.
    entry: f64,
}

const UNSEEN: Sight = Sight {
    distance: f64::INFINITY,
    entry: 0.0,
};

/// Direction in which a shortest path reaches a vertex, looking back: an angle from a half-edge that starts
/// there.
#[derive(Debug, Clone, Copy)]
struct Arrival {
    half_edge: u32,
    angle: f64,
}

/// Finds all pairs of vertices whose distance is below `delta`.
pub(super) fn pairs(surface: &Surface, half_edges: HalfEdges, delta: f64) -> GeodesicPairs {
    let unfolding = Unfolding::new(surface, half_edges);
    GeodesicPairs::search(
        surface.len(),
        || Search::new(&unfolding, delta),
        |search, source, row| search.run(source, row),
    )
}

/// Returns the distance of two vertices, which is at most `most`.
pub(super) fn distance(
    surface: &Surface,
    half_edges: HalfEdges,
    [a, b]: [u32; 2],
    most: f64,
) -> f64 {
    let unfolding = Unfolding::new(surface, half_edges);
    let mut search = Search::new(&unfolding, most);
    let mut found = most;
    for (source, target) in [(a, b), (b, a)] {
        let mut row = Vec::new();
        search.run(source, &mut row);
        let reached = row.iter().find(|(vertex, _)| *vertex == target);
        found = reached.map_or(found, |(_, distance)| found.min(*distance));
    }
    found
}

/// Working memory of one thread; only entries touched by a search are reset after it.
struct Search<'a> {
    unfolding: &'a Unfolding,
    delta: f64,
    distance: Vec<f64>,
    arrival: Vec<Arrival>,
    reached: Vec<u32>,
    /// Per corner, numbered by the half-edge that starts there.
    sight: Vec<Sight>,
    seen: Vec<u32>,
    windows: Vec<Window>,
    free: Vec<u32>,
    /// Min-heap of distances and events. Distances are stored as bits, which for positive numbers have the same order.
    queue: BinaryHeap<Reverse<(u64, u32)>>,
}

impl<'a> Search<'a> {
    fn new(unfolding: &'a Unfolding, delta: f64) -> Self {
        let vertices = unfolding.passable.len();
        let nowhere = Arrival {
            half_edge: HalfEdges::NONE,
            angle: 0.0,
        };
        Self {
            unfolding,
            delta,
            distance: vec![f64::INFINITY; vertices],
            arrival: vec![nowhere; vertices],
            reached: Vec::new(),
            sight: vec![UNSEEN; unfolding.panels.len()],
            seen: Vec::new(),
            windows: Vec::new(),
            free: Vec::new(),
            queue: BinaryHeap::new(),
        }
    }

    fn run(&mut self, source: u32, row: &mut Vec<(u32, f64)>) {
        self.distance[source as usize] = 0.0;
        self.reached.push(source);
        self.leave(source, 0.0, None);
        while let Some(Reverse((bits, event))) = self.queue.pop() {
            if event & VERTEX == 0 {
                let window = self.windows[event as usize];
                self.free.push(event);
                self.propagate(&window);
                continue;
            }
            let (vertex, distance) = (event & !VERTEX, f64::from_bits(bits));
            if distance == self.distance[vertex as usize] {
                let total = self.unfolding.passable[vertex as usize];
                self.leave(vertex, distance, total);
            }
        }
        for &vertex in &self.reached {
            let distance = std::mem::replace(&mut self.distance[vertex as usize], f64::INFINITY);
            if distance < self.delta && vertex != source {
                row.push((vertex, distance));
            }
        }
        self.reached.clear();
        for corner in self.seen.drain(..) {
            self.sight[corner as usize] = UNSEEN;
        }
    }

    /// Records a path of this length to a vertex.
    fn reach(&mut self, vertex: u32, distance: f64, arrival: impl FnOnce() -> Arrival) {
        let known = &mut self.distance[vertex as usize];
        if distance >= *known || distance >= self.delta {
            return;
        }
        if *known == f64::INFINITY {
            self.reached.push(vertex);
        }
        *known = distance;
        if self.unfolding.passable[vertex as usize].is_some() {
            self.arrival[vertex as usize] = arrival();
            self.queue
                .push(Reverse((distance.to_bits(), vertex | VERTEX)));
        }
    }

    /// Propagates paths from a vertex: from the source in all directions, from a vertex with this total angle
    /// in those that leave π on either side.
    fn leave(&mut self, vertex: u32, sigma: f64, total: Option<f64>) {
        let unfolding = self.unfolding;
        let around = unfolding.half_edges.around(vertex as usize);
        let Some(total) = total.filter(|total| total.is_finite()) else {
            for &half_edge in around {
                self.leave_through(
                    half_edge,
                    sigma,
                    [0.0, unfolding.angles[half_edge as usize]],
                );
            }
            return;
        };
        let arrival = self.arrival[vertex as usize];
        let mut corner = arrival.half_edge;
        // Directions to a corner, measured from the direction of arrival.
        let mut begin = -arrival.angle;
        let straight = [PI - SLACK, total - PI + SLACK];
        for _ in 0..around.len() {
            let angle = unfolding.angles[corner as usize];
            let fan = straight.map(|direction| (direction - begin).clamp(0.0, angle));
            self.leave_through(corner, sigma, fan);
            begin += angle;
            corner = unfolding.half_edges.twin(HalfEdges::previous(corner));
        }
    }

    /// Propagates paths from a vertex between two directions into the triangle of a half-edge that starts
    /// there, and along its two edges. Angles are measured from the half-edge.
    fn leave_through(&mut self, half_edge: u32, sigma: f64, fan: [f64; 2]) {
        let unfolding = self.unfolding;
        let panel = &unfolding.panels[half_edge as usize];
        let [next, previous] = [HalfEdges::next(half_edge), HalfEdges::previous(half_edge)];
        self.reach(panel.target, sigma + panel.length, || Arrival {
            half_edge: next,
            angle: unfolding.angles[next as usize],
        });
        self.reach(panel.apex_vertex, sigma + panel.left.length, || Arrival {
            half_edge: previous,
            angle: 0.0,
        });
        let [from, to] = fan;
        if from < to {
            let toward = |angle: f64| [angle.cos(), angle.sin()];
            let high = (from > 0.0).then(|| toward(from));
            let low = (to < unfolding.angles[half_edge as usize]).then(|| toward(to));
            self.pass([0.0; 2], sigma, &panel.right, [low, high]);
        }
    }

    fn propagate(&mut self, window: &Window) {
        let unfolding = self.unfolding;
        let panel = &unfolding.panels[window.half_edge as usize];
        let ([x, y], [image_x, image_y]) = (panel.apex, window.image);
        let entry = image_x + (x - image_x) * (-image_y / (y - image_y));
        let bend = entry.clamp(window.low, window.high);
        let sees_apex = bend == entry;
        let distance = window.sigma
            + if sees_apex {
                length(x - image_x, y - image_y)
            } else {
                length(bend - image_x, image_y) + length(x - bend, y)
            };
        let corner = HalfEdges::previous(window.half_edge);
        self.reach(panel.apex_vertex, distance, || Arrival {
            half_edge: corner,
            angle: angle_between([-x, -y], [bend - x, -y]),
        });
        let [mut left, mut right] = [entry > window.low, entry < window.high];
        if sees_apex {
            let best = &mut self.sight[corner as usize];
            if distance < best.distance {
                if best.distance == f64::INFINITY {
                    self.seen.push(corner);
                }
                *best = Sight { distance, entry };
            } else {
                // Around flat vertices the rays of several windows meet at the apex; which comes first, or on
                // which side, is round-off.
                let same = SAME_RAY * panel.length;
                left &= entry < best.entry + same;
                right &= entry > best.entry - same;
            }
        }
        let at = |place: f64| Some([place, 0.0]);
        let from_origin = window.low == 0.0;
        let to_target = window.high == panel.length;
        if left {
            let low = if from_origin { None } else { at(window.low) };
            let high = if sees_apex { None } else { at(bend) };
            self.pass(window.image, window.sigma, &panel.left, [low, high]);
        }
        if right {
            let low = if sees_apex { None } else { at(bend) };
            let high = if to_target { None } else { at(window.high) };
            self.pass(window.image, window.sigma, &panel.right, [low, high]);
        }
    }

    /// Propagates the rays from an image through an exit: those between the rays through two given places. A
    /// missing place stands for the end of the exit, which is then met exactly.
    fn pass(&mut self, image: [f64; 2], sigma: f64, exit: &Exit, between: [Option<[f64; 2]>; 2]) {
        if exit.beyond == HalfEdges::NONE {
            return;
        }
        let image = exit.place(image);
        let cross = |place: [f64; 2]| {
            let [x, y] = exit.place(place);
            image[0] + (x - image[0]) * (-image[1] / (y - image[1]))
        };
        let [low, high] = between.map(|place| place.map(cross));
        let low = low.map_or(0.0, |x| x.max(0.0));
        let high = high.map_or(exit.length, |x| x.min(exit.length));
        if high - low > NARROWEST * exit.length {
            self.push(Window {
                half_edge: exit.beyond,
                low,
                high,
                image,
                sigma,
            });
        }
    }

    /// Returns true if a path through a corner of the edge or of the triangle beyond is shorter than all rays
    /// of a window.
    fn is_cut_short(&self, window: &Window, panel: &Panel) -> bool {
        let [x, y] = window.image;
        let to_low = window.sigma + length(window.low - x, y);
        let to_high = window.sigma + length(window.high - x, y);
        self.distance[panel.origin as usize] + window.high < to_high * SHORTER
            || self.distance[panel.target as usize] + panel.length - window.low < to_low * SHORTER
    }

    fn push(&mut self, window: Window) {
        let [x, y] = window.image;
        let nearest = x.clamp(window.low, window.high);
        let distance = window.sigma + length(nearest - x, y);
        if distance >= self.delta {
            return;
        }
        let panel = &self.unfolding.panels[window.half_edge as usize];
        if self.is_cut_short(&window, panel) {
            return;
        }
        let place = match self.free.pop() {
            Some(place) => {
                self.windows[place as usize] = window;
                place
            }
            None => {
                self.windows.push(window);
                self.windows.len() as u32 - 1
            }
        };
        self.queue.push(Reverse((distance.to_bits(), place)));
    }
}

/// Plain square root; `hypot` guards against overflow at several times the cost.
fn length(x: f64, y: f64) -> f64 {
    (x * x + y * y).sqrt()
}

fn angle_between(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}
