//! Coefficients per bond class that reduce numerical dispersion.
//!
//! A lattice with stiffness c α_j for bonds of class j has ω²(k) = Σ_j α_j b_j(k), linear in α on every branch
//! whose polarisation is determined by symmetry. The coefficients are chosen such that R = ω² − V²|k|² is small on
//! the border of the irreducible zone while long waves are exact (Alebrahim, Packo, Zaccariotto & Galvanetto 2022,
//! in one and two dimensions; extended here to three).
//!
//! * [`ScalingModel`] – bond classes, contour, constraints of a stress state and horizon ratio, in units of the
//!   spacing and √(E/ρ).
//! * [`Tuning`] – [`Method`], [`Combination`], [`Weights`], lower bound; [`ScalingModel::tune`] returns a
//!   [`TunedTable`].
//! * [`TunedTable::influence`] – the result as an influence function of a material.
//! * [`influence_alebrahim`], [`polygon`], [`fit_cosines`] – functions of |ξ| that represent tables.
//!
//! At the zone corner the branches of a lattice meet and those of the continuum do not, so in two and three
//! dimensions the residual has a lower limit. Tables with negative entries may be unstable (see [`Assessment`]) and
//! must not be used with breaking bonds. Cost: 10 ms for N = 3 in 2D, less than a second in 3D, mostly for the scan
//! of the zone.
//!
//! ```
//! use pericles_dispersion::tuning::{ScalingModel, Tuning};
//! use pericles::family::VolumeCorrection;
//! use pericles::material::StressState;
//!
//! let model = ScalingModel::new(StressState::PlaneStrain, 3.0, VolumeCorrection::None)?;
//! let positive = model.tune(Tuning { lower_bound: Some(0.5), ..Default::default() })?;
//! assert!((positive.alpha[0] - 3.7636).abs() < 1e-4 && positive.alpha[5] == 0.5);
//! assert!(positive.assessment.stability.is_stable());
//! # Ok::<(), pericles::PericlesError>(())
//! ```

mod absolute;
mod bounded;
mod functionals;
mod functions;
mod least_squares;
mod method;
mod model;
mod samples;
mod solve;
mod table;

pub use functions::{fit_cosines, influence_alebrahim, polygon};
pub use method::{Combination, Method, Tuning, Weights};
pub use model::{
    Assessment, BondClass, DispersionError, ScalingModel, WaveSpeeds, bond_classes,
    continuum_speeds,
};
pub use table::TunedTable;
