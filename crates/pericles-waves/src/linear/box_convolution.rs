//! Convolution of fields on a lattice body with a tensor kernel, by transforms over the padded box.
//!
//! Three passes, each over fixed pieces in parallel: (1) planes: rows of points to wavenumbers along x, then along
//! y; (2) pencils: forward along z, product with the kernel, and backward; (3) planes: backward along y and x, into
//! the points. 2D boxes use their y as z and have no middle axis. Zeros are neither stored nor transformed along
//! the last axis, and as few as possible along the others.

use std::ops::Range;

use rayon::prelude::*;
use rustfft::num_complex::Complex;

use super::fourier::{AxisTransform, LineTransform, stride};
use super::tensor_kernel::Axis;
use super::tensor_spectra::{Product, TensorSpectra};
use super::wanted::{count_wanted, for_each_wanted};
use pericles::operator::PointSubset;
use pericles::operator::pool::Pool;
use pericles::space::Lattice;

/// Columns processed together when an array is read across its rows: two cache lines.
const TILE: usize = 8;

/// Work arrays of a whole application.
struct Workspace {
    /// [field][last][middle, padded][x mode]
    planes: Vec<Complex<f64>>,
    /// [middle, padded][x tile][last][field][x mode in tile]
    pencils: Vec<Complex<f64>>,
}

/// Arrays of one thread.
struct Scratch {
    row: Vec<f64>,
    /// One plane of wavenumbers.
    plane: Vec<Complex<f64>>,
    /// Lines along the middle or the last axis.
    lines: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

/// Convolution Σ_j K_ab(x_j − x_i) u_b(x_j) over the points of a lattice body.
pub(super) struct BoxConvolution<const D: usize> {
    lattice: Lattice,
    /// First point of each row of the lattice, and the number of points.
    row_start: Vec<u32>,
    /// Nodes along the middle and the last axis; the padded lengths are the lengths of the transforms.
    middle_nodes: usize,
    last_nodes: usize,
    along_x: LineTransform,
    middle: AxisTransform,
    last: AxisTransform,
    spectra: TensorSpectra<D>,
    workspace: Pool<Workspace>,
    scratch: Pool<Scratch>,
}

impl<const D: usize> BoxConvolution<D> {
    /// Creates the convolution with `value(offset)` on a lattice body; `axes` in the order of the lattice.
    pub fn new(lattice: &Lattice, axes: [Axis; 3], value: impl Fn([i64; 3], &mut [f64])) -> Self {
        // In 2D y is used as z.
        let [x, middle, last] = if D == 2 {
            [axes[0], axes[2], axes[1]]
        } else {
            axes
        };
        let spectra = TensorSpectra::new([x, middle, last], value);
        let rows = lattice.shape[1] * lattice.shape[2];
        let row_start = (0..=rows)
            .map(|row| {
                let first = row * lattice.shape[0];
                lattice
                    .node
                    .partition_point(|&node| (node as usize) < first) as u32
            })
            .collect();
        let along_x = LineTransform::new(x.padded);
        let along_middle = AxisTransform::new(middle.padded);
        let along_last = AxisTransform::new(last.padded);
        let modes = along_x.modes();
        let (planes, pencils) = (
            D * last.nodes * middle.padded * modes,
            D * last.nodes * middle.padded * modes.next_multiple_of(TILE),
        );
        let workspace = Pool::new(1, move || Workspace {
            planes: vec![Complex::default(); planes],
            pencils: vec![Complex::default(); pencils],
        });
        let scratch_len = along_x
            .scratch()
            .len()
            .max(along_middle.scratch_len())
            .max(along_last.scratch_len());
        let plane = middle.padded * modes;
        let lines = TILE * (D * stride(last.padded)).max(stride(middle.padded));
        let row = x.padded;
        let scratch = Pool::new(rayon::current_num_threads(), move || Scratch {
            row: vec![0.0; row],
            plane: vec![Complex::default(); plane],
            lines: vec![Complex::default(); lines],
            scratch: vec![Complex::default(); scratch_len],
        });
        Self {
            lattice: lattice.clone(),
            row_start,
            middle_nodes: middle.nodes,
            last_nodes: last.nodes,
            along_x,
            middle: along_middle,
            last: along_last,
            spectra,
            workspace,
            scratch,
        }
    }

    /// Memory, bytes: spectra, one workspace and the numbering.
    pub fn bytes(&self) -> usize {
        let modes = self.along_x.modes();
        let complex =
            D * self.last_nodes * self.middle.length * (modes + modes.next_multiple_of(TILE));
        complex * size_of::<Complex<f64>>()
            + self.spectra.bytes()
            + size_of_val(&self.row_start[..])
            + size_of_val(&self.lattice.node[..])
    }

    /// Returns Σ_j K_p(x_j − x_i) for every point.
    pub fn kernel_sums(&self, p: usize) -> Vec<f64> {
        let mut sums = vec![0.0; self.lattice.node.len()];
        self.apply(
            Product::Pair(p),
            &PointSubset::All,
            &|_, _, line| line.fill(1.0),
            [&mut sums[..]],
            &|_, _, values, out| out.copy_from_slice(values),
        );
        sums
    }

    /// Computes the products of fields at the requested points.
    ///
    /// `input(field, points, line)` fills a line with the values of a field at some points;
    /// `finish(field, points, values, out)` receives the products at some points and modifies the part of `out`
    /// that belongs to them.
    pub fn apply<const F: usize>(
        &self,
        product: Product,
        on: &PointSubset<'_>,
        input: &(impl Fn(usize, Range<usize>, &mut [f64]) + Sync),
        out: [&mut [f64]; F],
        finish: &(impl Fn(usize, Range<usize>, &[f64], &mut [f64]) + Sync),
    ) {
        let mut workspace = self.workspace.take();
        let Workspace { planes, pencils } = &mut *workspace;
        let plane = self.middle.length * self.along_x.modes();
        let planes = &mut planes[..F * self.last_nodes * plane];
        planes.par_chunks_mut(plane).enumerate().for_each_init(
            || self.scratch.take(),
            |scratch, (k, plane)| {
                let (field, last) = (k / self.last_nodes, k % self.last_nodes);
                self.plane_forth(
                    last,
                    &|points, line| input(field, points, line),
                    plane,
                    scratch,
                );
            },
        );
        let planes = &planes[..];
        let tiles = self.along_x.modes().div_ceil(TILE);
        let pencil = self.last_nodes * F * TILE;
        let pencils = &mut pencils[..self.middle.length * tiles * pencil];
        pencils.par_chunks_mut(pencil).enumerate().for_each_init(
            || self.scratch.take(),
            |scratch, (k, pencil)| {
                self.pencil::<F>(product, k / tiles, k % tiles, planes, pencil, scratch);
            },
        );
        self.planes_back::<F>(0..self.last_nodes, 0, pencils, on, out, finish);
    }

    /// Points of a row of the lattice.
    fn row(&self, middle: usize, last: usize) -> Range<usize> {
        let row = middle + self.middle_nodes * last;
        self.row_start[row] as usize..self.row_start[row + 1] as usize
    }

    /// First point of a plane.
    fn plane_start(&self, last: usize) -> usize {
        self.row_start[self.middle_nodes * last] as usize
    }

    /// First node of a row.
    fn row_node(&self, middle: usize, last: usize) -> usize {
        (middle + self.middle_nodes * last) * self.lattice.shape[0]
    }

    fn plane_forth(
        &self,
        last: usize,
        input: &impl Fn(Range<usize>, &mut [f64]),
        plane: &mut [Complex<f64>],
        work: &mut Scratch,
    ) {
        let modes = self.along_x.modes();
        for middle in 0..self.middle_nodes {
            let points = self.row(middle, last);
            let spectrum = &mut plane[middle * modes..(middle + 1) * modes];
            if points.is_empty() {
                spectrum.fill(Complex::default());
                continue;
            }
            let count = points.len();
            work.row[count..].fill(0.0);
            input(points.clone(), &mut work.row[..count]);
            if count < self.lattice.shape[0] {
                // Moved to their places, which are never below their number; hence from the end.
                let start = self.row_node(middle, last);
                for (k, &node) in self.lattice.node[points].iter().enumerate().rev() {
                    let value = std::mem::take(&mut work.row[k]);
                    work.row[node as usize - start] = value;
                }
            }
            self.along_x
                .forward(&mut work.row, spectrum, &mut work.scratch);
        }
        plane[self.middle_nodes * modes..].fill(Complex::default());
        self.along_middle(plane, false, work);
    }

    /// Transforms all columns of a plane along the middle axis.
    fn along_middle(&self, plane: &mut [Complex<f64>], back: bool, work: &mut Scratch) {
        let (modes, length) = (self.along_x.modes(), self.middle.length);
        let stride = stride(length);
        if length == 1 {
            return;
        }
        for first in (0..modes).step_by(TILE) {
            let width = TILE.min(modes - first);
            let lines = &mut work.lines[..width * stride];
            for m in 0..length {
                let row = &plane[m * modes + first..][..width];
                for (t, value) in row.iter().enumerate() {
                    lines[t * stride + m] = *value;
                }
            }
            self.middle.apply(lines, back, &mut work.scratch);
            for m in 0..length {
                let row = &mut plane[m * modes + first..][..width];
                for (t, value) in row.iter_mut().enumerate() {
                    *value = lines[t * stride + m];
                }
            }
        }
    }

    /// Forward along the last axis, product, and backward, for the x modes of a tile at one middle mode.
    fn pencil<const F: usize>(
        &self,
        product: Product,
        middle: usize,
        tile: usize,
        planes: &[Complex<f64>],
        out: &mut [Complex<f64>],
        work: &mut Scratch,
    ) {
        let (modes, length) = (self.along_x.modes(), self.last.length);
        let stride = stride(length);
        let plane = self.middle.length * modes;
        let first = tile * TILE;
        let width = TILE.min(modes - first);
        // [field][x mode][last].
        let lines = &mut work.lines[..F * width * stride];
        for f in 0..F {
            for t in 0..width {
                lines[(f * width + t) * stride + self.last_nodes..][..length - self.last_nodes]
                    .fill(Complex::default());
            }
            for l in 0..self.last_nodes {
                let row =
                    &planes[(f * self.last_nodes + l) * plane + middle * modes + first..][..width];
                for (t, value) in row.iter().enumerate() {
                    lines[(f * width + t) * stride + l] = *value;
                }
            }
        }
        self.last.apply(lines, false, &mut work.scratch);
        for t in 0..width {
            let mut rest = &mut lines[..];
            let mut fields: [&mut [Complex<f64>]; F] = std::array::from_fn(|_| {
                let (field, others) = std::mem::take(&mut rest).split_at_mut(width * stride);
                rest = others;
                &mut field[t * stride..][..length]
            });
            self.spectra
                .multiply::<F>(product, middle, first + t, &mut fields);
        }
        self.last.apply(lines, true, &mut work.scratch);
        for l in 0..self.last_nodes {
            for f in 0..F {
                let row = &mut out[(l * F + f) * TILE..][..width];
                for (t, value) in row.iter_mut().enumerate() {
                    *value = lines[(f * width + t) * stride + l];
                }
            }
        }
    }

    /// Third pass on a range of planes, halved until one is left; `out` begins at point `first`.
    fn planes_back<const F: usize>(
        &self,
        range: Range<usize>,
        first: usize,
        pencils: &[Complex<f64>],
        on: &PointSubset<'_>,
        out: [&mut [f64]; F],
        finish: &(impl Fn(usize, Range<usize>, &[f64], &mut [f64]) + Sync),
    ) {
        if range.len() == 1 {
            self.plane_back::<F>(range.start, first, pencils, on, out, finish);
            return;
        }
        let middle = range.start + range.len() / 2;
        let split = self.plane_start(middle);
        let mut high: [&mut [f64]; F] = std::array::from_fn(|_| Default::default());
        let mut field = 0;
        let low = out.map(|slice| {
            let (low, rest) = slice.split_at_mut(split - first);
            high[field] = rest;
            field += 1;
            low
        });
        pericles::parallel::join(
            || self.planes_back::<F>(range.start..middle, first, pencils, on, low, finish),
            || self.planes_back::<F>(middle..range.end, split, pencils, on, high, finish),
        );
    }

    fn plane_back<const F: usize>(
        &self,
        last: usize,
        first: usize,
        pencils: &[Complex<f64>],
        on: &PointSubset<'_>,
        out: [&mut [f64]; F],
        finish: &impl Fn(usize, Range<usize>, &[f64], &mut [f64]),
    ) {
        let points = self.plane_start(last)..self.plane_start(last + 1);
        if count_wanted(on, points) == 0 {
            return;
        }
        let mut work = self.scratch.take();
        let mut plane = std::mem::take(&mut work.plane);
        let modes = self.along_x.modes();
        let tiles = modes.div_ceil(TILE);
        let pencil = self.last_nodes * F * TILE;
        for (field, out) in out.into_iter().enumerate() {
            for m in 0..self.middle.length {
                for tile in 0..tiles {
                    let from = (m * tiles + tile) * pencil + (last * F + field) * TILE;
                    let width = TILE.min(modes - tile * TILE);
                    plane[m * modes + tile * TILE..][..width]
                        .copy_from_slice(&pencils[from..from + width]);
                }
            }
            self.along_middle(&mut plane, true, &mut work);
            for m in 0..self.middle_nodes {
                let points = self.row(m, last);
                if count_wanted(on, points.clone()) == 0 {
                    continue;
                }
                let Scratch { row, scratch, .. } = &mut *work;
                self.along_x
                    .inverse(&mut plane[m * modes..(m + 1) * modes], row, scratch);
                if points.len() < self.lattice.shape[0] {
                    let start = self.row_node(m, last);
                    for (k, &node) in self.lattice.node[points.clone()].iter().enumerate() {
                        row[k] = row[node as usize - start];
                    }
                }
                for_each_wanted(on, points.clone(), |some| {
                    let values = &row[some.start - points.start..some.end - points.start];
                    let out = &mut out[some.start - first..some.end - first];
                    finish(field, some, values, out);
                });
            }
        }
        work.plane = plane;
    }
}
