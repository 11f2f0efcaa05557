//! Online convolution: products of series whose coefficients become known one after the other.
//!
//! Time is divided into blocks of [`BLOCK`] steps. Within a block products are summed directly. When q blocks are
//! complete, the last S = BLOCK · 2^ν(q) coefficients (ν the exponent of two in q) are multiplied by the first 2S
//! coefficients of the other factor in one transform of length 2S, which gives their whole contribution to the next
//! S results (Fischer & Stockmeyer 1974; Hairer, Lubich & Schlichte 1985 for Volterra equations). N steps cost O(N
//! log² N).

use std::ops::Range;

use rayon::prelude::*;
use realfft::num_complex::Complex;

use crate::linear::LineTransform;

/// Steps per block: below this length direct sums are cheaper than transforms.
pub(super) const BLOCK: usize = 64;

/// Transforms shorter than this are computed by one thread.
const PARALLEL: usize = 4096;

/// Half spectrum of a real series.
pub(super) type Spectrum = Vec<Complex<f64>>;

/// Transforms for all block sizes of a run.
pub(super) struct Levels {
    transforms: Vec<LineTransform>,
}

/// Work arrays of one line.
pub(super) struct LineWork {
    line: Vec<f64>,
    pub(super) spectrum: Spectrum,
    scratch: Spectrum,
}

impl Levels {
    /// Creates the transforms for series of this length.
    pub(super) fn new(length: usize) -> Self {
        let mut transforms = Vec::new();
        let mut size = BLOCK;
        while size < length {
            transforms.push(LineTransform::new(2 * size));
            size *= 2;
        }
        Self { transforms }
    }

    /// Number of block sizes.
    pub(super) fn count(&self) -> usize {
        self.transforms.len()
    }

    /// Number of coefficients in a block.
    pub(super) fn size(&self, level: usize) -> usize {
        BLOCK << level
    }

    /// Returns the level of the block that ends after `known` coefficients, if one does.
    pub(super) fn due(&self, known: usize) -> Option<usize> {
        let level = (known / BLOCK).trailing_zeros() as usize;
        (known.is_multiple_of(BLOCK) && level < self.count()).then_some(level)
    }

    /// Allocates work arrays for lines of all levels.
    pub(super) fn work(&self, lines: usize) -> Vec<LineWork> {
        let Some(largest) = self.transforms.last() else {
            return Vec::new();
        };
        let scratch = |transform: &LineTransform| transform.scratch().len();
        let most = self.transforms.iter().map(scratch).max().unwrap_or(0);
        let make = || LineWork {
            line: vec![0.0; largest.len()],
            spectrum: vec![Complex::default(); largest.modes()],
            scratch: vec![Complex::default(); most],
        };
        (0..lines).map(|_| make()).collect()
    }

    /// Transforms a range of each series, padded by zeros; coefficients beyond the end of a series are zero.
    pub(super) fn transform(
        &self,
        level: usize,
        series: &[Vec<f64>],
        range: Range<usize>,
        work: &mut [LineWork],
    ) {
        let transform = &self.transforms[level];
        let one = |(series, work): (&Vec<f64>, &mut LineWork)| {
            let line = &mut work.line[..transform.len()];
            let range = range.start..range.end.min(series.len());
            let count = range.len();
            line[..count].copy_from_slice(&series[range]);
            line[count..].fill(0.0);
            let spectrum = &mut work.spectrum[..transform.modes()];
            transform.forward(line, spectrum, &mut work.scratch);
        };
        if transform.len() < PARALLEL {
            series.iter().zip(work).for_each(one);
        } else {
            series.par_iter().zip(work).for_each(one);
        }
    }

    /// Transforms the first coefficients of each series, twice a block long, scaled so that products need no
    /// further factor.
    pub(super) fn heads(&self, level: usize, series: &[Vec<f64>]) -> Vec<Spectrum> {
        let transform = &self.transforms[level];
        let mut work = self.work(series.len());
        self.transform(level, series, 0..transform.len(), &mut work);
        let norm = 1.0 / transform.len() as f64;
        work.into_iter()
            .map(|mut work| {
                work.spectrum.truncate(transform.modes());
                work.spectrum.iter_mut().for_each(|mode| *mode *= norm);
                work.spectrum
            })
            .collect()
    }

    /// Adds the contribution of a block to each result from coefficient `known` on; `fill` accumulates the spectrum
    /// of the product.
    pub(super) fn add_products(
        &self,
        level: usize,
        known: usize,
        results: &mut [Vec<f64>],
        work: &mut [LineWork],
        fill: &(impl Fn(usize, &mut [Complex<f64>]) + Sync),
    ) {
        let transform = &self.transforms[level];
        let size = self.size(level);
        let one = |(k, (result, work)): (usize, (&mut Vec<f64>, &mut LineWork))| {
            let spectrum = &mut work.spectrum[..transform.modes()];
            spectrum.fill(Complex::default());
            fill(k, spectrum);
            let line = &mut work.line[..transform.len()];
            transform.inverse(spectrum, line, &mut work.scratch);
            let end = (known + size).min(result.len());
            for (sum, share) in result[known.min(end)..end].iter_mut().zip(&line[size..]) {
                *sum += share;
            }
        };
        if transform.len() < PARALLEL {
            results.iter_mut().zip(work).enumerate().for_each(one);
        } else {
            results.par_iter_mut().zip(work).enumerate().for_each(one);
        }
    }
}

/// `sum` += a b.
pub(super) fn accumulate(sum: &mut [Complex<f64>], a: &[Complex<f64>], b: &[Complex<f64>]) {
    for ((sum, a), b) in sum.iter_mut().zip(a).zip(b) {
        *sum += a * b;
    }
}

/// `sum` += factor · series.
pub(super) fn add_scaled(sum: &mut [f64], factor: f64, series: &[f64]) {
    for (sum, x) in sum.iter_mut().zip(series) {
        *sum += factor * x;
    }
}
