//! Real Fourier transforms of fields on a full box.

use rayon::prelude::*;
use rustfft::num_complex::Complex;

use super::super::fourier::{AxisTransform, LineTransform, stride};
use pericles::operator::pool::Pool;

/// Transforms of real fields with x fastest. Modes of x: 0 … n/2. In the spectrum the last axis of more than one
/// node is fastest, then x, then the middle axis (for a bar x alone).
pub(super) struct BoxTransform {
    along_x: LineTransform,
    middle: AxisTransform,
    last: AxisTransform,
    work: Pool<Work>,
    planes: Pool<Vec<Complex<f64>>>,
}

struct Work {
    row: Vec<f64>,
    lines: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl BoxTransform {
    /// Creates the transforms for boxes of D axes with the given numbers of nodes.
    pub fn new(dimension: usize, shape: [usize; 3]) -> Self {
        let (middle, last) = match dimension {
            1 => (1, 1),
            2 => (1, shape[1]),
            _ => (shape[1], shape[2]),
        };
        let along_x = LineTransform::new(shape[0]);
        let (middle, last) = (AxisTransform::new(middle), AxisTransform::new(last));
        let scratch = middle
            .scratch_len()
            .max(last.scratch_len())
            .max(along_x.scratch().len());
        let line = stride(middle.length);
        let (row, modes) = (shape[0], along_x.modes());
        let planes = modes * middle.length * last.length;
        Self {
            work: Pool::new(rayon::current_num_threads(), move || Work {
                row: vec![0.0; row],
                lines: vec![Complex::default(); line],
                scratch: vec![Complex::default(); scratch],
            }),
            planes: Pool::new(1, move || vec![Complex::default(); planes]),
            along_x,
            middle,
            last,
        }
    }

    /// Nodes of x, middle and last axis.
    pub fn nodes(&self) -> [usize; 3] {
        [self.along_x.len(), self.middle.length, self.last.length]
    }

    /// Modes of a spectrum: x, middle and last axis.
    pub fn modes(&self) -> [usize; 3] {
        [self.along_x.modes(), self.middle.length, self.last.length]
    }

    /// Number of entries of a spectrum.
    pub fn len(&self) -> usize {
        self.modes().iter().product()
    }

    /// Computes the spectrum of `value(i) − shift`.
    pub fn forward(&self, value: &(impl Fn(usize) -> f64 + Sync), spectrum: &mut [Complex<f64>]) {
        let [nodes, middle, last] = self.nodes();
        let modes = self.along_x.modes();
        let mut planes = self.planes.take();
        planes
            .par_chunks_mut(modes * middle)
            .enumerate()
            .for_each_init(
                || self.work.take(),
                |work, (l, plane)| {
                    let Work { row, scratch, .. } = &mut **work;
                    for (m, line) in plane.chunks_mut(modes).enumerate() {
                        let first = (l * middle + m) * nodes;
                        for (k, row) in row.iter_mut().enumerate() {
                            *row = value(first + k);
                        }
                        self.along_x.forward(row, line, scratch);
                    }
                    self.along_middle(plane, false, work);
                },
            );
        let plane = modes * middle;
        spectrum.par_chunks_mut(last).enumerate().for_each_init(
            || self.work.take(),
            |work, (p, pencil)| {
                for (l, value) in pencil.iter_mut().enumerate() {
                    *value = planes[l * plane + p];
                }
                self.last.apply_to_one(pencil, false, &mut work.scratch);
            },
        );
    }

    /// Calls `set(i, value)` for the field of a spectrum, which is overwritten; `out` has one entry per node.
    pub fn inverse(
        &self,
        spectrum: &mut [Complex<f64>],
        out: &mut [f64],
        set: &(impl Fn(usize, f64, &mut f64) + Sync),
    ) {
        let [nodes, middle, last] = self.nodes();
        let modes = self.along_x.modes();
        spectrum.par_chunks_mut(last).for_each_init(
            || self.work.take(),
            |work, pencil| self.last.apply_to_one(pencil, true, &mut work.scratch),
        );
        let mut planes = self.planes.take();
        let factor = 1.0 / (nodes * middle * last) as f64;
        planes
            .par_chunks_mut(modes * middle)
            .zip(out.par_chunks_mut(nodes * middle))
            .enumerate()
            .for_each_init(
                || self.work.take(),
                |work, (l, (plane, out))| {
                    for (p, value) in plane.iter_mut().enumerate() {
                        *value = spectrum[p * last + l];
                    }
                    self.along_middle(plane, true, work);
                    let Work { row, scratch, .. } = &mut **work;
                    for (m, line) in plane.chunks_mut(modes).enumerate() {
                        self.along_x.inverse(line, row, scratch);
                        let first = (l * middle + m) * nodes;
                        let out = &mut out[m * nodes..(m + 1) * nodes];
                        for (k, (out, row)) in out.iter_mut().zip(&*row).enumerate() {
                            set(first + k, factor * row, out);
                        }
                    }
                },
            );
    }

    /// Transforms a plane along the middle axis.
    fn along_middle(&self, plane: &mut [Complex<f64>], back: bool, work: &mut Work) {
        let middle = self.middle.length;
        if middle == 1 {
            return;
        }
        let modes = self.along_x.modes();
        for x in 0..modes {
            for m in 0..middle {
                work.lines[m] = plane[m * modes + x];
            }
            self.middle.apply(&mut work.lines, back, &mut work.scratch);
            for m in 0..middle {
                plane[m * modes + x] = work.lines[m];
            }
        }
    }
}
