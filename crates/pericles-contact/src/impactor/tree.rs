//! A tree of boxes for the triangle nearest to a point.

use crate::vector::V3;

/// Triangles per leaf.
const LEAF: usize = 4;

/// A tree of bounding boxes over triangles.
#[derive(Debug, Clone, Default)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    /// Triangles in the order of the leaves.
    order: Vec<u32>,
}

#[derive(Debug, Clone)]
struct Node {
    low: V3,
    high: V3,
    first: u32,
    count: u32,
    /// The first of two children; zero for leaves.
    children: u32,
}

impl Tree {
    /// Makes the tree.
    pub(super) fn new(vertices: &[V3], triangles: &[[u32; 3]]) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            order: (0..triangles.len() as u32).collect(),
        };
        let corners = |k: u32| triangles[k as usize].map(|v| vertices[v as usize]);
        tree.nodes.push(Node {
            low: [0.0; 3],
            high: [0.0; 3],
            first: 0,
            count: triangles.len() as u32,
            children: 0,
        });
        let mut at = 0;
        while at < tree.nodes.len() {
            let (first, count) = (tree.nodes[at].first as usize, tree.nodes[at].count as usize);
            let own = &mut tree.order[first..first + count];
            let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
            for &k in own.iter() {
                for p in corners(k) {
                    for c in 0..3 {
                        low[c] = low[c].min(p[c]);
                        high[c] = high[c].max(p[c]);
                    }
                }
            }
            (tree.nodes[at].low, tree.nodes[at].high) = (low, high);
            if count > LEAF {
                let longest = (1..3).fold(0, |best, c| {
                    if high[c] - low[c] > high[best] - low[best] {
                        c
                    } else {
                        best
                    }
                });
                let place = |k: u32| corners(k).iter().map(|p| p[longest]).sum::<f64>();
                own.sort_by(|&a, &b| place(a).total_cmp(&place(b)).then(a.cmp(&b)));
                let half = count / 2;
                tree.nodes[at].children = tree.nodes.len() as u32;
                for (first, count) in [(first, half), (first + half, count - half)] {
                    tree.nodes.push(Node {
                        low,
                        high,
                        first: first as u32,
                        count: count as u32,
                        children: 0,
                    });
                }
            }
            at += 1;
        }
        tree
    }

    /// Returns the triangle with the smallest squared distance `square` from q, the lowest number of several.
    pub(super) fn nearest(&self, q: V3, square: &impl Fn(usize) -> f64) -> usize {
        let mut best = (f64::INFINITY, usize::MAX);
        let mut waiting = vec![(0usize, self.nodes[0].square(q))];
        while let Some((at, least)) = waiting.pop() {
            if least > best.0 {
                continue;
            }
            let node = &self.nodes[at];
            if node.children == 0 {
                let first = node.first as usize;
                for &k in &self.order[first..first + node.count as usize] {
                    let found = (square(k as usize), k as usize);
                    if found.0 < best.0 || (found.0 == best.0 && found.1 < best.1) {
                        best = found;
                    }
                }
                continue;
            }
            let children = [0, 1].map(|k| node.children as usize + k);
            let [a, b] = children.map(|child| (child, self.nodes[child].square(q)));
            // The nearer child is taken first.
            let (near, far) = if a.1 <= b.1 { (a, b) } else { (b, a) };
            waiting.push(far);
            waiting.push(near);
        }
        best.1
    }
}

impl Node {
    /// Squared distance of a point from the box, m².
    fn square(&self, q: V3) -> f64 {
        let out = |c: usize| (self.low[c] - q[c]).max(q[c] - self.high[c]).max(0.0);
        // Rounded down, so that equal distances of several triangles are compared.
        (out(0).powi(2) + out(1).powi(2) + out(2).powi(2)) * (1.0 - 1e-12)
    }
}
