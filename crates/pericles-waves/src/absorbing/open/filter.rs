//! The filter of short waves in the layers.

use rayon::prelude::*;

use super::plate::{Step, Zone};

/// D = (1, −4, 6, −4, 1)/16 at the shifts 0, ±1 and ±2: the symbol is sin⁴(k/2).
const WEIGHTS: [f64; 3] = [6.0 / 16.0, -4.0 / 16.0, 1.0 / 16.0];

/// v ← v − Dᵀ β D v along each axis in turn: a contraction for 0 ≤ β ≤ 1.
pub(super) struct Filter {
    axes: [AxisFilter; 2],
    /// β of each node.
    share: Vec<f64>,
    /// β D v, then zero for nodes outside the zone.
    differences: Vec<f64>,
    /// Number of passes of a step.
    passes: usize,
}

struct AxisFilter {
    /// Numbers of the nodes at −2, −1, 1 and 2 steps; the number of nodes of the zone where v is zero.
    neighbours: Vec<[u32; 4]>,
}

impl Filter {
    /// Makes the filter of a zone; `share` is β of a node in each of the `passes` of a step. At free ends v continues as its mirror image, which keeps D symmetric
    /// with eigenvalues from 0 to 1.
    pub(super) fn new(zone: &Zone, passes: usize, share: impl Fn([usize; 2]) -> f64) -> Self {
        let outside = zone.len() as u32;
        let neighbour = |axis: usize, node: [usize; 2], shift: isize| {
            let line = &zone.lines[axis];
            let index = match line.step(node[axis], shift) {
                Step::Node(index) => index,
                Step::Beyond => return outside,
                Step::Nothing => line.mirrored(node[axis], shift),
            };
            let mut other = node;
            other[axis] = index;
            zone.number(other).map_or(outside, |number| number as u32)
        };
        let axis = |axis: usize| AxisFilter {
            neighbours: zone
                .nodes()
                .map(|node| [-2, -1, 1, 2].map(|shift| neighbour(axis, node, shift)))
                .collect(),
        };
        Self {
            axes: [axis(0), axis(1)],
            share: zone.nodes().map(share).collect(),
            differences: vec![0.0; zone.len() + 1],
            passes,
        }
    }

    /// Filters one component; the entry after the last node is zero.
    pub(super) fn apply(&mut self, v: &mut [f64]) {
        let nodes = self.differences.len() - 1;
        for _ in 0..self.passes {
            for AxisFilter { neighbours } in &self.axes {
                let field = &*v;
                let out = self.differences[..nodes].par_chunks_mut(CHUNK);
                let chunks = out
                    .zip(neighbours.par_chunks(CHUNK))
                    .zip(self.share.par_chunks(CHUNK));
                chunks
                    .enumerate()
                    .for_each(|(chunk, ((out, neighbours), share))| {
                        let centre = &field[chunk * CHUNK..];
                        for (k, out) in out.iter_mut().enumerate() {
                            *out = share[k] * difference(field, &neighbours[k], centre[k]);
                        }
                    });
                let differences = &self.differences;
                let chunks = v[..nodes]
                    .par_chunks_mut(CHUNK)
                    .zip(neighbours.par_chunks(CHUNK));
                chunks.enumerate().for_each(|(chunk, (out, neighbours))| {
                    let centre = &differences[chunk * CHUNK..];
                    for (k, out) in out.iter_mut().enumerate() {
                        *out -= difference(differences, &neighbours[k], centre[k]);
                    }
                });
            }
        }
    }
}

/// Nodes of a task.
const CHUNK: usize = 4096;

/// Returns D of a field at a node with a value and the numbers of its neighbours.
#[inline(always)]
fn difference(field: &[f64], neighbours: &[u32; 4], centre: f64) -> f64 {
    let [a, b, c, d] = *neighbours;
    let near = field[b as usize] + field[c as usize];
    let far = field[a as usize] + field[d as usize];
    WEIGHTS[0] * centre + WEIGHTS[1] * near + WEIGHTS[2] * far
}
