//! Accelerations of the nodes of a layer from the continued shifts.

use std::ops::Range;

use super::layer::{LANES, Layer};
use super::weights::LatticeWeights;

/// A row of nodes, for which the lanes of the field follow each other within a block.
struct Run {
    /// First node of the row, counted from the first node of the targets.
    target: usize,
    length: usize,
    block: usize,
    place: usize,
}

/// The accelerations of the nodes at one depth of a layer.
pub(super) struct LayerForce {
    /// Nodes along the layer whose accelerations are computed.
    pub(super) targets: Range<usize>,
    /// Tangential shift, and the runs of the field at this shift.
    shifts: Vec<(isize, Vec<Run>)>,
    /// Shift outwards, and the weights, for each tangential shift.
    weights: Vec<Vec<(isize, [[f64; 2]; 2])>>,
    /// Blocks of one component.
    blocks: usize,
}

impl LayerForce {
    /// Prepares the forces of a layer normal to an axis at its lower end (0) or upper end (1). `lane(target, shift)` is the
    /// lane of the node at a tangential shift; `None` if there is no node.
    pub(super) fn new(
        layer: &Layer,
        (axis, end): (usize, usize),
        weights: &LatticeWeights,
        targets: Range<usize>,
        lane: impl Fn(usize, isize) -> Option<usize>,
    ) -> Self {
        let reach = weights.reach() as isize;
        let outwards = if end == 0 { -1 } else { 1 };
        let along = |tangential: isize| {
            let of = |shift: isize| {
                let mut xi = [tangential; 2];
                xi[axis] = outwards * shift;
                (shift, weights.at(xi))
            };
            let all = (-reach..=reach).map(of);
            all.filter(|(_, w)| w.iter().flatten().any(|w| *w != 0.0))
                .collect()
        };
        let (blocks, _) = layer.block(1, 0);
        Self {
            shifts: (-reach..=reach)
                .map(|shift| {
                    (
                        shift,
                        runs(layer, targets.clone(), |target| lane(target, shift)),
                    )
                })
                .collect(),
            weights: (-reach..=reach).map(along).collect(),
            targets,
            blocks,
        }
    }

    /// Returns the accelerations at depth n, m/s², by component and target.
    pub(super) fn at(&self, layer: &Layer, n: isize) -> Vec<f64> {
        let count = self.targets.len();
        let mut out = vec![0.0; 2 * count];
        let mut own = vec![0.0; 2 * count];
        for (shift, runs) in &self.shifts {
            if *shift == 0 {
                for run in runs {
                    for c in 0..2 {
                        let lanes = layer.lanes(run.block + c * self.blocks, n, 0);
                        let from = c * count + run.target;
                        own[from..from + run.length]
                            .copy_from_slice(&lanes[run.place..run.place + run.length]);
                    }
                }
            }
        }
        let (own_x, own_y) = own.split_at(count);
        let (out_x, out_y) = out.split_at_mut(count);
        for ((_, runs), weights) in self.shifts.iter().zip(&self.weights) {
            for run in runs {
                let targets = run.target..run.target + run.length;
                let places = run.place..run.place + run.length;
                let own = [&own_x[targets.clone()], &own_y[targets.clone()]];
                let mut out = [&mut out_x[targets.clone()], &mut out_y[targets]];
                for (shift, weight) in weights {
                    let lanes = [0, 1].map(|c| {
                        &layer.lanes(run.block + c * self.blocks, n, *shift)[places.clone()]
                    });
                    add(weight, lanes, own, &mut out);
                }
            }
        }
        out
    }
}

/// Adds W (U − u) of one bond of each node of a run.
fn add(weight: &[[f64; 2]; 2], far: [&[f64]; 2], own: [&[f64]; 2], out: &mut [&mut [f64]; 2]) {
    let [[xx, xy], [yx, yy]] = *weight;
    let [out_x, out_y] = out;
    let nodes = out_x.iter_mut().zip(out_y.iter_mut());
    let far = far[0].iter().zip(far[1]);
    let own = own[0].iter().zip(own[1]);
    for (((out_x, out_y), (far_x, far_y)), (own_x, own_y)) in nodes.zip(far).zip(own) {
        let (x, y) = (far_x - own_x, far_y - own_y);
        *out_x += xx * x + xy * y;
        *out_y += yx * x + yy * y;
    }
}

/// Divides targets into runs of successive lanes of one block.
fn runs(layer: &Layer, targets: Range<usize>, lane: impl Fn(usize) -> Option<usize>) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    let mut next = None;
    for target in targets.clone() {
        let Some(lane) = lane(target) else {
            next = None;
            continue;
        };
        match runs
            .last_mut()
            .filter(|_| next == Some(lane) && lane % LANES != 0)
        {
            Some(run) => run.length += 1,
            None => {
                let (block, place) = layer.block(0, lane);
                runs.push(Run {
                    target: target - targets.start,
                    length: 1,
                    block,
                    place,
                });
            }
        }
        next = Some(lane + 1);
    }
    runs
}
