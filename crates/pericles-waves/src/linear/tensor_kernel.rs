//! Tensor kernel of a linear bond-based body on a lattice, and its Fourier transform.
//!
//! K_ab(ξ) = k(|ξ|) ξ_a ξ_b / |ξ|³ is even under reflection of every axis, except that K_ab with a ≠ b is odd under
//! reflection of axis a and of axis b. Offsets and wavenumbers of one octant therefore suffice, and all transforms
//! are real.

use realfft::num_complex::Complex;

use super::cost::smooth_length;
use super::fourier::LineTransform;
use pericles::space::Lattice;

/// Offsets along an axis, wrapped periodically with the length of the transform.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Axis {
    /// Lattice nodes.
    pub nodes: usize,
    /// Length of the transform: the number of nodes if periodic, otherwise large enough that nothing wraps.
    pub padded: usize,
    /// Largest true offset between two nodes, and largest wrapped one.
    pub raw: usize,
    pub reach: usize,
    pub periodic: bool,
}

impl Axis {
    /// Number of wavenumbers 0 … π.
    pub fn modes(&self) -> usize {
        self.padded / 2 + 1
    }

    /// Wrapped offsets o ≥ 0 with the true offsets that map to them, except those of the mirrored side.
    fn images(&self) -> Vec<(usize, i64)> {
        let raw = self.raw as i64;
        let from = if self.periodic { -raw } else { 0 };
        (from..=raw)
            .map(|o| {
                let wrapped = if self.periodic {
                    o.rem_euclid(self.padded as i64)
                } else {
                    o
                };
                (wrapped as usize, o)
            })
            .filter(|&(wrapped, _)| wrapped <= self.reach)
            .collect()
    }
}

/// Axes of a lattice with the lengths of their transforms.
pub(super) fn axes<const D: usize>(
    lattice: &Lattice,
    raw: [usize; 3],
    periodic: [bool; D],
) -> [Axis; 3] {
    std::array::from_fn(|c| {
        let (nodes, raw) = (lattice.shape[c], raw[c]);
        if c < D && periodic[c] {
            Axis {
                nodes,
                padded: nodes,
                raw,
                reach: raw.min(nodes / 2),
                periodic: true,
            }
        } else {
            let reach = raw.min(nodes - 1);
            Axis {
                nodes,
                padded: smooth_length(nodes + reach),
                raw: reach,
                reach,
                periodic: false,
            }
        }
    })
}

/// Pairs of components in the order (0,0), (1,1) … and then (0,1), (0,2), (1,2).
pub(super) fn pairs(dimension: usize) -> Vec<(usize, usize)> {
    let mut pairs: Vec<_> = (0..dimension).map(|a| (a, a)).collect();
    for a in 0..dimension {
        for b in a + 1..dimension {
            pairs.push((a, b));
        }
    }
    pairs
}

/// Values of the kernel on the offsets of one octant.
pub(super) struct TensorKernel {
    axes: [Axis; 3],
    /// One table per pair: x fastest, then y, then z.
    tables: Vec<Vec<f64>>,
}

impl TensorKernel {
    /// Creates the kernel; `value(offset)` returns K_ab at a true offset, for the pairs in order.
    pub fn new(axes: [Axis; 3], pairs: usize, value: impl Fn([i64; 3], &mut [f64])) -> Self {
        let shape = axes.map(|axis| axis.reach + 1);
        let mut tables = vec![vec![0.0; shape.iter().product()]; pairs];
        let images = axes.map(|axis| axis.images());
        let mut values = vec![0.0; pairs];
        for &(z, oz) in &images[2] {
            for &(y, oy) in &images[1] {
                for &(x, ox) in &images[0] {
                    values.fill(0.0);
                    value([ox, oy, oz], &mut values);
                    let at = x + shape[0] * (y + shape[1] * z);
                    for (table, value) in tables.iter_mut().zip(&values) {
                        table[at] += value;
                    }
                }
            }
        }
        Self { axes, tables }
    }

    /// Computes Σ K_p(o) exp(−i θ·o) on the wavenumbers of one octant, times `scale`, at index z + Z (x + X y) for
    /// X × Y × Z of them: z is fastest, because products run along z. `odd` returns true for the axes under whose
    /// reflection K_p changes its sign: none or two.
    pub fn spectrum(&self, p: usize, odd: impl Fn(usize) -> bool, scale: f64) -> Vec<f64> {
        let mut values = self.tables[p].clone();
        // i·i from two odd axes.
        let scale = if (0..3).any(&odd) { -scale } else { scale };
        let mut shape = self.axes.map(|axis| axis.reach + 1);
        for axis in 0..3 {
            // Transforms the fastest axis, then makes it the slowest: after three rounds the order is x, y, z
            // again.
            let plan = LineTransform::new(self.axes[axis].padded);
            let (lines, modes) = (values.len() / shape[0], plan.modes());
            let mut next = vec![0.0; lines * modes];
            let mut work = OctantLine::new(&plan);
            for (l, line) in values.chunks(shape[0]).enumerate() {
                work.transform(&plan, line, odd(axis));
                for (k, mode) in work.spectrum.iter().enumerate() {
                    next[l + lines * k] = if odd(axis) { mode.im } else { mode.re };
                }
            }
            values = next;
            shape = [shape[1], shape[2], modes];
        }
        let [mx, my, mz] = self.axes.map(|axis| axis.modes());
        let mut out = vec![0.0; values.len()];
        for z in 0..mz {
            for y in 0..my {
                for x in 0..mx {
                    out[z + mz * (x + mx * y)] = scale * values[x + mx * (y + my * z)];
                }
            }
        }
        out
    }
}

/// Work arrays for the transform of an even or odd function given on one side.
struct OctantLine {
    line: Vec<f64>,
    spectrum: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl OctantLine {
    fn new(plan: &LineTransform) -> Self {
        Self {
            line: vec![0.0; plan.len()],
            spectrum: vec![Complex::default(); plan.modes()],
            scratch: plan.scratch(),
        }
    }

    fn transform(&mut self, plan: &LineTransform, side: &[f64], odd: bool) {
        let length = plan.len();
        self.line.fill(0.0);
        for (o, value) in side.iter().enumerate() {
            self.line[(length - o) % length] = if odd { -value } else { *value };
        }
        // Copied last, so that offset 0 and the one at half the length, which are their own mirror images, keep
        // their value (zero if odd).
        self.line[..side.len()].copy_from_slice(side);
        plan.forward(&mut self.line, &mut self.spectrum, &mut self.scratch);
    }
}
