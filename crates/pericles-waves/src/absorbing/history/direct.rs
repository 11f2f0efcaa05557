//! History convolution by direct sums: quadratic in the number of steps.

use super::History;
use super::record::Record;
use crate::absorbing::GhostKernels;
use pericles::archive::SavedUnder;
use pericles::{Archive, Result};

/// Direct sums: 2 K² N²/2 operations for N steps. Reference for the fast forms.
pub struct DirectHistory {
    kernels: GhostKernels,
    past: Record,
    now: Vec<f64>,
}

impl DirectHistory {
    /// Creates a history for the number of steps of the kernels.
    pub fn new(kernels: GhostKernels) -> Self {
        Self {
            past: Record::new(kernels.inputs(), kernels.steps() + 1),
            now: vec![0.0; kernels.inputs()],
            kernels,
        }
    }
}

impl History for DirectHistory {
    fn name(&self) -> &'static str {
        "direct"
    }

    fn steps(&self) -> Option<u64> {
        Some(self.kernels.steps() as u64)
    }

    fn bytes(&self) -> usize {
        self.past.bytes() + self.kernels.bytes()
    }

    fn ghosts_into(&self, ghosts: &mut [f64]) {
        let Record { sites, steps } = &self.past;
        for (n, ghost) in ghosts.iter_mut().enumerate() {
            *ghost = self
                .kernels
                .terms(n)
                .map(|(input, kernel)| {
                    let past = sites[input][..*steps].iter();
                    let kernel = self.kernels.series()[kernel][1..=*steps].iter().rev();
                    past.zip(kernel).map(|(u, k)| u * k).sum::<f64>()
                })
                .sum();
        }
    }

    fn settle(&self, own: &[f64], ghosts: &mut [f64]) {
        self.kernels.settle(own, ghosts);
    }

    fn push(&mut self, own: &[f64], ghosts: &[f64]) {
        self.kernels.gather(own, ghosts, &mut self.now);
        self.past.push(&self.now);
    }

    fn reset(&mut self) {
        self.past.steps = 0;
    }
}

impl SavedUnder for DirectHistory {
    fn save_under(&self, name: &str, archive: &mut Archive) {
        let Self {
            past,
            kernels: _,
            now: _,
        } = self;
        past.save(name, archive);
    }

    fn restore_under(&mut self, name: &str, archive: &Archive) -> Result<()> {
        let (stored, steps) = self.past.stored(name, archive)?;
        for (site, stored) in self.past.sites.iter_mut().zip(stored.chunks(steps.max(1))) {
            site[..steps].copy_from_slice(stored);
        }
        self.past.steps = steps;
        Ok(())
    }
}
