//! Wave dispersion on lattices: dispersion curves, stability, tuned coefficients, measured spectra.
//!
//! In the interior of a grid, plane waves u = e exp(i(k·x − ωt)) solve the linearised equation of motion exactly if
//! ω² and e are an eigenpair of
//!
//! M(k) = Σ_ξ (c α κ V/ρ) (1 − cos k·ξ)/|ξ|³ ξ⊗ξ,
//!
//! summed over the bonds of one point. All results follow from M (Alebrahim, Packo, Zaccariotto & Galvanetto 2022,
//! in one and two dimensions; extended here to three):
//!
//! * [`BondLattice`] – the bonds; M(k), its eigenpairs, the long-wave limit, for any spacings, influence function,
//!   volume correction and horizon.
//! * [`Contour`], [`trace`] – branches along the border of the irreducible zone or along any ray, followed by
//!   symmetry or similarity of polarisation, with phase and group velocities; [`verlet_frequency`] gives the
//!   time-discrete curve.
//! * [`stability`] – smallest ω²/|k|² and highest frequency over the whole zone, from which the stable time step
//!   follows.
//! * [`long_wave_speeds`], [`polar_speeds`] – anisotropy.
//! * [`KernelWaves`] – dispersion of an influence function in the continuum, without a grid.
//! * [`PhaseErrors`] – the shortest waves whose speed is within a tolerance of that of long waves, or of the
//!   continuum; separates the dispersion of the kernel from that added by the grid.
//! * [`time_content`], [`space_content`] – the energy fraction of a load or an initial field in waves shorter than
//!   that.
//! * [`tuning`] – coefficients per bond class that reduce dispersion.
//! * [`spectrum`] – frequencies measured in a time-domain run.
//!
//! SI units; wave vectors in rad/m, missing components are zero. An evaluation of M costs one sine per pair ±ξ of
//! bonds.
//!
//! ```
//! use pericles_dispersion::{BondLattice, Contour, stability, trace};
//!
//! // A bar with nearest-neighbour bonds, D = √(E/ρ) = 1: ω = 2 sin(k/2).
//! let chain = BondLattice::new(&[1.0], 1.0, |_, _, _| 1.0)?;
//! let curve = trace(&chain, &Contour::irreducible(&chain), 10);
//! let middle = &curve[5];
//! assert!((middle.branches[0].omega() - 2.0 * (0.5 * middle.k[0]).sin()).abs() < 1e-14);
//! assert!((stability(&chain).dt_max() - 1.0).abs() < 1e-9);
//! # Ok::<(), pericles::PericlesError>(())
//! ```

mod bisection;
mod branches;
mod content;
mod continuum;
mod contour;
mod error;
mod lattice;
mod modes;
mod phase;
pub mod spectrum;
pub mod tuning;
mod vector;
mod zone;

pub use branches::{BranchPoint, ContourPoint, PolarSpeeds, long_wave_speeds, polar_speeds, trace};
pub use content::{space_content, time_content};
pub use continuum::KernelWaves;
pub use contour::{Contour, Segment};
pub use error::DispersionError;
pub use lattice::{BondLattice, LatticeBond};
pub use modes::{Mode, verlet_frequency};
pub use phase::{PhaseErrors, Resolved};
pub use vector::{SquareMatrix, Vector};
pub use zone::{Stability, stability};
