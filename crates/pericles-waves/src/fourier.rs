//! Plans of discrete Fourier transforms.
//!
//! The code of the transform libraries is generic. Callers in all crates create their plans here, so that it is compiled once.

use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};

pub use rustfft::num_complex::Complex64;

/// Plan of a complex transform.
pub type ComplexPlan = Arc<dyn Fft<f64>>;
/// Plan of the transform of a real line.
pub type RealPlan = Arc<dyn RealToComplex<f64>>;
/// Plan of the inverse transform to a real line.
pub type RealInverse = Arc<dyn ComplexToReal<f64>>;

/// Returns the plans of the forward and the inverse complex transform; neither divides by the length.
pub fn complex_plans(length: usize) -> [ComplexPlan; 2] {
    let mut planner = FftPlanner::new();
    [
        planner.plan_fft_forward(length),
        planner.plan_fft_inverse(length),
    ]
}

/// Creates plans for real lines; plans for equal lengths are shared.
pub struct RealPlanner(RealFftPlanner<f64>);

impl Default for RealPlanner {
    fn default() -> Self {
        Self(RealFftPlanner::new())
    }
}

impl RealPlanner {
    /// Returns the plan of the forward transform.
    pub fn forward(&mut self, length: usize) -> RealPlan {
        self.0.plan_fft_forward(length)
    }

    /// Returns the plan of the inverse transform; it does not divide by the length.
    pub fn inverse(&mut self, length: usize) -> RealInverse {
        self.0.plan_fft_inverse(length)
    }
}
