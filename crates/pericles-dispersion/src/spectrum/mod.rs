//! Frequencies measured in the time domain.
//!
//! A periodic box of lattice points starts from random displacements and is integrated by velocity Verlet; the
//! space-time transform of its motion has its power on the dispersion curves. The measurement is independent of the
//! analysis except for the polarisations on which the motion is projected; without the projection every wave vector
//! would show all branches. The peaks lie on the time-discrete curve (2/dt) asin(ω dt/2).
//!
//! ```
//! use pericles_dispersion::spectrum::{SpectrumRun, measure};
//! use pericles_dispersion::{BondLattice, Contour};
//!
//! let chain = BondLattice::new(&[1.0], 2.0, |_, _, _| 0.5)?;
//! let run = SpectrumRun { nodes: 32, steps: 512, dt: 0.1, seed: 7 };
//! let spectrum = measure(&chain, &Contour::irreducible(&chain), run)?;
//! assert!(spectrum.worst_deviation().0 < 0.25);
//! # Ok::<(), pericles::SimulationError>(())
//! ```

mod fourier;
mod measure;
mod periodic;

pub use fourier::CubeTransform;
pub use measure::{BranchSpectrum, MeasuredSpectrum, SpectrumRun, WaveSpectrum, measure};
/// Complex number type of [`CubeTransform`].
pub use pericles_waves::fourier::Complex64;
pub use periodic::PeriodicForce;
