//! Fourier transforms of lines, and convolution by them.

use realfft::num_complex::Complex;

use crate::fourier::{ComplexPlan, RealInverse, RealPlan, RealPlanner, complex_plans};

/// Forward and inverse transforms of a real line of fixed length.
#[derive(Clone)]
pub(crate) struct LineTransform {
    forward: RealPlan,
    inverse: RealInverse,
}

impl LineTransform {
    pub fn new(length: usize) -> Self {
        let mut planner = RealPlanner::default();
        Self {
            forward: planner.forward(length),
            inverse: planner.inverse(length),
        }
    }

    pub fn len(&self) -> usize {
        self.forward.len()
    }

    /// Number of entries of a spectrum.
    pub fn modes(&self) -> usize {
        self.len() / 2 + 1
    }

    /// Allocates the work array of both directions.
    pub fn scratch(&self) -> Vec<Complex<f64>> {
        let len = self
            .forward
            .get_scratch_len()
            .max(self.inverse.get_scratch_len());
        vec![Complex::default(); len]
    }

    /// Computes the spectrum of `line`, which is overwritten.
    pub fn forward(
        &self,
        line: &mut [f64],
        spectrum: &mut [Complex<f64>],
        scratch: &mut [Complex<f64>],
    ) {
        let done = self.forward.process_with_scratch(line, spectrum, scratch);
        debug_assert!(done.is_ok(), "buffers have the plan's lengths");
    }

    /// Computes the line of a spectrum, which is overwritten; not divided by the length.
    pub fn inverse(
        &self,
        spectrum: &mut [Complex<f64>],
        line: &mut [f64],
        scratch: &mut [Complex<f64>],
    ) {
        // The spectrum of a real line is real here; the plan would reject an imaginary part due to round-off.
        spectrum[0].im = 0.0;
        if self.len().is_multiple_of(2) {
            spectrum[self.modes() - 1].im = 0.0;
        }
        let done = self.inverse.process_with_scratch(spectrum, line, scratch);
        debug_assert!(done.is_ok(), "buffers have the plan's lengths");
    }
}

/// Circular correlation of lines with fixed coefficients: y_p = Σ_r t_r w_{p+r}, indices modulo the length.
pub(super) struct CircularKernel {
    transform: LineTransform,
    spectrum: Vec<Complex<f64>>,
}

/// Work arrays of a [`CircularKernel`].
pub(super) struct LineScratch {
    spectrum: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

impl LineScratch {
    pub fn new(transform: &LineTransform) -> Self {
        Self {
            spectrum: vec![Complex::default(); transform.modes()],
            scratch: transform.scratch(),
        }
    }
}

impl CircularKernel {
    /// Creates the kernel from coefficients t_{−r} = `below[r − 1]`, t_r = `above[r − 1]`; none extends more than
    /// half the length.
    pub fn new(length: usize, below: &[f64], above: &[f64]) -> Self {
        let transform = LineTransform::new(length);
        let mut line = vec![0.0; length];
        let norm = 1.0 / length as f64;
        for r in 1..=above.len() {
            // A correlation: coefficients above the diagonal shift backwards.
            line[(length - r) % length] += norm * above[r - 1];
            line[r % length] += norm * below[r - 1];
        }
        let mut spectrum = vec![Complex::default(); transform.modes()];
        transform.forward(&mut line, &mut spectrum, &mut transform.scratch());
        if above == below {
            for mode in &mut spectrum {
                mode.im = 0.0;
            }
        }
        Self {
            transform,
            spectrum,
        }
    }

    pub fn transform(&self) -> &LineTransform {
        &self.transform
    }

    pub fn bytes(&self) -> usize {
        size_of_val(&self.spectrum[..])
    }

    /// Replaces a line by its correlation.
    pub fn apply(&self, line: &mut [f64], work: &mut LineScratch) {
        self.transform
            .forward(line, &mut work.spectrum, &mut work.scratch);
        for (mode, factor) in work.spectrum.iter_mut().zip(&self.spectrum) {
            *mode *= factor;
        }
        self.transform
            .inverse(&mut work.spectrum, line, &mut work.scratch);
    }
}

/// Distance between the starts of consecutive lines of a length: not a power of two, which would map all lines to
/// the same few sets of the L1 cache.
pub(super) fn stride(length: usize) -> usize {
    length + 4
}

/// Complex transform of an axis; none if the axis has one node.
pub(super) struct AxisTransform {
    pub length: usize,
    plans: Option<[ComplexPlan; 2]>,
}

impl AxisTransform {
    pub fn new(length: usize) -> Self {
        let plans = (length > 1).then(|| complex_plans(length));
        Self { length, plans }
    }

    pub fn scratch_len(&self) -> usize {
        self.plans.as_ref().map_or(0, |plans| {
            plans
                .iter()
                .map(|plan| plan.get_inplace_scratch_len())
                .max()
                .unwrap_or(0)
        })
    }

    /// Transforms lines that start a [`stride`] apart; `back` selects the inverse, not divided by the length.
    pub fn apply(&self, lines: &mut [Complex<f64>], back: bool, scratch: &mut [Complex<f64>]) {
        if let Some(plans) = &self.plans {
            for line in lines.chunks_mut(stride(self.length)) {
                plans[usize::from(back)].process_with_scratch(&mut line[..self.length], scratch);
            }
        }
    }

    /// Transforms one line of the length of the axis.
    pub fn apply_to_one(
        &self,
        line: &mut [Complex<f64>],
        back: bool,
        scratch: &mut [Complex<f64>],
    ) {
        if let Some(plans) = &self.plans {
            plans[usize::from(back)].process_with_scratch(line, scratch);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circular_kernel_equals_the_direct_sum() {
        for (length, reach) in [(8usize, 4usize), (15, 7), (12, 1), (1, 0), (2, 1)] {
            let number = |k: usize| ((k * k) as f64 * 0.7 + 0.1).sin();
            let above: Vec<f64> = (0..reach).map(|r| number(r + 5)).collect();
            let below: Vec<f64> = (0..reach).map(|r| number(r + 31)).collect();
            let kernel = CircularKernel::new(length, &below, &above);
            let u: Vec<f64> = (0..length).map(number).collect();
            let mut y = u.clone();
            kernel.apply(&mut y, &mut LineScratch::new(kernel.transform()));
            for p in 0..length {
                let sum: f64 = (1..=reach)
                    .map(|r| {
                        above[r - 1] * u[(p + r) % length]
                            + below[r - 1] * u[(p + length - r) % length]
                    })
                    .sum();
                assert!((y[p] - sum).abs() < 1e-14 * length as f64, "{length} {p}");
            }
        }
    }
}
