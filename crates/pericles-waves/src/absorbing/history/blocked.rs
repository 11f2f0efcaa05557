//! Exact history convolution by blocks of Fourier transforms.

use realfft::num_complex::Complex;

use super::History;
use super::record::Record;
use crate::absorbing::GhostKernels;
use crate::absorbing::blocks::{BLOCK, Levels, LineWork, Spectrum, accumulate, add_scaled};
use pericles::archive::SavedUnder;
use pericles::{Archive, Result};

/// Online convolution in O(K N log² N + K² N log N) for N steps, equal to direct sums to round-off.
///
/// Memory: (inputs + K) N numbers for history and results, and 4 N per kernel for the spectra.
pub struct BlockedHistory {
    kernels: GhostKernels,
    /// First lags of each kernel, for direct sums.
    near: Vec<Vec<f64>>,
    levels: Levels,
    /// Spectra of the first lags of each kernel, by level.
    heads: Vec<Vec<Spectrum>>,
    past: Record,
    /// Ghosts of all steps, as far as they follow from the history so far.
    results: Vec<Vec<f64>>,
    blocks: Vec<LineWork>,
    products: Vec<LineWork>,
    now: Vec<f64>,
}

impl BlockedHistory {
    /// Creates a history for the number of steps of the kernels.
    pub fn new(kernels: GhostKernels) -> Self {
        let length = kernels.steps() + 1;
        let levels = Levels::new(length);
        let near = |series: &Vec<f64>| series[..length.min(BLOCK)].to_vec();
        Self {
            near: kernels.series().iter().map(near).collect(),
            heads: (0..levels.count())
                .map(|level| levels.heads(level, kernels.series()))
                .collect(),
            past: Record::new(kernels.inputs(), length),
            results: vec![vec![0.0; length]; kernels.reach()],
            blocks: levels.work(kernels.inputs()),
            products: levels.work(kernels.reach()),
            now: vec![0.0; kernels.inputs()],
            levels,
            kernels,
        }
    }

    /// Appends the displacements of the recorded sites from `now`.
    fn push_now(&mut self) {
        let step = self.past.steps;
        self.past.push(&self.now);
        let end = (step - step % BLOCK + BLOCK).min(self.kernels.steps() + 1);
        for (n, result) in self.results.iter_mut().enumerate() {
            for (input, kernel) in self.kernels.terms(n) {
                // The coefficient at lag 0 is zero: a step does not act on itself.
                add_scaled(&mut result[step..end], self.now[input], &self.near[kernel]);
            }
        }
        let known = self.past.steps;
        let Some(level) = self.levels.due(known) else {
            return;
        };
        let from = known - self.levels.size(level);
        self.levels
            .transform(level, &self.past.sites, from..known, &mut self.blocks);
        let (kernels, blocks, heads) = (&self.kernels, &self.blocks, &self.heads[level]);
        let fill = |n: usize, product: &mut [Complex<f64>]| {
            for (input, kernel) in kernels.terms(n) {
                accumulate(product, &blocks[input].spectrum, &heads[kernel]);
            }
        };
        self.levels
            .add_products(level, known, &mut self.results, &mut self.products, &fill);
    }
}

impl History for BlockedHistory {
    fn name(&self) -> &'static str {
        "blocked"
    }

    fn steps(&self) -> Option<u64> {
        Some(self.kernels.steps() as u64)
    }

    fn bytes(&self) -> usize {
        let results: usize = self
            .results
            .iter()
            .map(|result| size_of_val(&result[..]))
            .sum();
        let modes: usize = self.heads.iter().flatten().map(Vec::len).sum();
        self.past.bytes() + self.kernels.bytes() + results + size_of::<Complex<f64>>() * modes
    }

    fn ghosts_into(&self, ghosts: &mut [f64]) {
        for (ghost, result) in ghosts.iter_mut().zip(&self.results) {
            *ghost = result[self.past.steps];
        }
    }

    fn settle(&self, own: &[f64], ghosts: &mut [f64]) {
        self.kernels.settle(own, ghosts);
    }

    fn push(&mut self, own: &[f64], ghosts: &[f64]) {
        self.kernels.gather(own, ghosts, &mut self.now);
        self.push_now();
    }

    fn reset(&mut self) {
        self.past.steps = 0;
        self.results.iter_mut().for_each(|result| result.fill(0.0));
    }
}

impl SavedUnder for BlockedHistory {
    fn save_under(&self, name: &str, archive: &mut Archive) {
        let Self {
            past,
            // Recomputed from the history.
            results: _,
            kernels: _,
            near: _,
            levels: _,
            heads: _,
            blocks: _,
            products: _,
            now: _,
        } = self;
        past.save(name, archive);
    }

    /// Repeats the convolution of the stored history: the same operations in the same order.
    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()> {
        let (stored, steps) = self.past.stored(name, archive)?;
        self.reset();
        for step in 0..steps {
            for (site, now) in self.now.iter_mut().enumerate() {
                *now = stored[site * steps + step];
            }
            self.push_now();
        }
        Ok(())
    }
}
