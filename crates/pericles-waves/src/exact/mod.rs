//! Exact solutions in one dimension, used to measure errors.
//!
//! | | medium | initial displacement, at rest |
//! |---|---|---|
//! | [`LineSolution`] | the infinite line with the Gaussian micromodulus C(ξ) = 4E/(l³√π) exp(−(ξ/l)²) | u = U exp(−(x/L)²) |
//! | [`TravellingPulse`] | the local string, c² = E/ρ: the limit l → 0 (d'Alembert) | the same |
//! | [`StretchedBar`] | the local bar, fixed at x = 0 and free at x = length | u = ε x |
//! | [`BarMode`] | the same bar | its fundamental mode, u = U sin(πx/(2 length)) |
//!
//! Lengths in m, moduli in Pa, densities in kg/m³; displacements in the unit of the amplitude.
//!
//! ```
//! use pericles_waves::exact::{ExactSolution, LineSolution};
//! let line = LineSolution { young: 1.0, density: 1.0, length: 1.0, width: 1.0, amplitude: 1.0, centre: 0.0 };
//! let mut u = [0.0; 2];
//! line.displacement_into(0.0, &[0.0, 1.0], &mut u);
//! assert!((u[0] - 1.0).abs() < 1e-14 && (u[1] - (-1.0f64).exp()).abs() < 1e-14);
//! ```

mod bar;
mod line;

pub use bar::{BarMode, StretchedBar};
pub use line::{LineSolution, TravellingPulse};

/// Displacement known for all times.
pub trait ExactSolution: Send + Sync {
    /// Writes the displacements at time t of the positions `x` to `out`.
    fn displacement_into(&self, t: f64, x: &[f64], out: &mut [f64]);
}

/// Error of a computed displacement.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SolutionError {
    /// Largest error over all points.
    pub largest: f64,
    /// Root mean square error divided by the root mean square of the exact solution; undivided where that is zero.
    pub relative: f64,
}

impl SolutionError {
    /// Compares a computed with an exact field.
    pub fn between(computed: &[f64], exact: &[f64]) -> Self {
        let square = |values: &mut dyn Iterator<Item = f64>| values.map(|x| x * x).sum::<f64>();
        let differences = || computed.iter().zip(exact).map(|(a, b)| a - b);
        // A NaN difference must not be ignored.
        let largest = differences().fold(0.0f64, |largest, d| {
            if d.is_nan() {
                f64::NAN
            } else {
                largest.max(d.abs())
            }
        });
        let (error, size) = (
            square(&mut differences()),
            square(&mut exact.iter().copied()),
        );
        let relative = if size > 0.0 { error / size } else { error };
        Self {
            largest,
            relative: relative.sqrt(),
        }
    }
}
