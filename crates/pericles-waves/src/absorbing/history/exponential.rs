//! History convolution by sums of exponentials.

use realfft::num_complex::Complex;

use super::History;
use crate::absorbing::fit::ExponentialKernels;
use pericles::archive::SavedUnder;
use pericles::{Archive, Result, Values};

/// One state per exponential, S ← λ S + Σ_m b_m u_m, and ghosts Re Σ a_n S: 8 K p operations per step and O(K p)
/// memory for p exponentials and any number of steps.
pub struct ExponentialHistory {
    kernels: ExponentialKernels,
    states: Vec<Complex<f64>>,
}

impl ExponentialHistory {
    /// Creates an empty history.
    pub fn new(kernels: ExponentialKernels) -> Self {
        Self {
            states: vec![Complex::default(); kernels.terms.len()],
            kernels,
        }
    }
}

impl History for ExponentialHistory {
    fn name(&self) -> &'static str {
        "exponentials"
    }

    fn steps(&self) -> Option<u64> {
        None
    }

    fn bytes(&self) -> usize {
        size_of::<Complex<f64>>() * self.states.len() * (2 + 2 * self.kernels.reach)
    }

    fn ghosts_into(&self, ghosts: &mut [f64]) {
        ghosts.fill(0.0);
        for (state, term) in self.states.iter().zip(&self.kernels.terms) {
            for (ghost, a) in ghosts.iter_mut().zip(&term.give) {
                *ghost += a.re * state.re - a.im * state.im;
            }
        }
    }

    fn settle(&self, own: &[f64], ghosts: &mut [f64]) {
        let rows = self.kernels.present.chunks_exact(self.kernels.reach);
        for (ghost, row) in ghosts.iter_mut().zip(rows) {
            *ghost += row.iter().zip(own).map(|(f, u)| f * u).sum::<f64>();
        }
    }

    fn push(&mut self, own: &[f64], _ghosts: &[f64]) {
        for (state, term) in self.states.iter_mut().zip(&self.kernels.terms) {
            let taken: Complex<f64> = term.take.iter().zip(own).map(|(b, u)| b * u).sum();
            *state = *state * term.decay + taken;
        }
    }

    fn reset(&mut self) {
        self.states.fill(Complex::default());
    }
}

impl SavedUnder for ExponentialHistory {
    fn save_under(&self, name: &str, archive: &mut Archive) {
        let Self { states, kernels: _ } = self;
        let numbers = states.iter().flat_map(|state| [state.re, state.im]);
        archive.put(format!("{name}/states"), Values::F64(numbers.collect()));
    }

    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()> {
        let numbers = archive.exactly(&format!("{name}/states"), 2 * self.states.len())?;
        for (state, pair) in self.states.iter_mut().zip(numbers.chunks(2)) {
            *state = Complex::new(pair[0], pair[1]);
        }
        Ok(())
    }
}
