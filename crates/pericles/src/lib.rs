//! Peridynamics: points, bonds, operators, integrators, observers.
//!
//! The equation of motion ρ u_tt(x) = ∫ f(ξ, η) dx′ + b, with ξ = x′ − x, η = u′ − u over the points within a horizon δ, becomes on points with volumes
//! ρ u_tt,i = Σ_j f_ij κ_ij V_j + b_i (Silling 2000; Silling & Askari 2005). This crate holds the physics and the numerics; it reads and writes
//! no files. The program and its decks are the crates `pericles-cli`, `pericles-deck` and `pericles-io`.
//!
//! Vectors on points are component-major: component c of point i is entry `c * n + i`. Units are SI.
//!
//! ```
//! use std::sync::Arc;
//! use pericles::family::{BondList, VolumeCorrection};
//! use pericles::material::*;
//! use pericles::operator::{BondForce, DamageMeasure};
//! use pericles::space::{Grid, Shape};
//! use pericles::time::{State, VelocityVerlet, highest_frequency};
//! use pericles::{Control, PointScalar, Simulation, System};
//!
//! // A steel bar of 200 cells, its left half moving at 1 m/s towards the right half.
//! let bar = Grid {
//!     shape: Shape::Box { origin: [0.0; 3], size: vec![0.2] },
//!     spacing: 1e-3,
//!     section: 1e-4,
//!     holes: vec![],
//! };
//! let cloud = Arc::new(bar.points()?);
//! let steel = BondMaterial {
//!     law: PairLaw::BondStretch,
//!     density: 7850.0,
//!     modulus: Modulus { value: ElasticModulus::Young(210e9), calibration: Calibration::Continuum },
//!     horizon: 3e-3,
//!     influence: Default::default(),
//!     volume_correction: VolumeCorrection::Extended,
//!     fracture: Fracture::Unbreakable,
//! };
//! let constants = steel.constants(&cloud, StressState::Uniaxial)?;
//! let bonds = BondList::new(&cloud, steel.horizon, steel.volume_correction)?;
//! let force = BondForce::<BondStretch, 1>::new(
//!     cloud.clone(), bonds, &steel, &constants, &[], DamageMeasure::default(),
//! )?;
//! let system = System::new(cloud.clone(), Box::new(force), PointScalar::Uniform(steel.density))?;
//! let mut start = State::at_rest(cloud.len());
//! start.v[..100].fill(1.0);
//! let dt = highest_frequency(&system, &start.u)?.stable_step(2.0, 0.95);
//! let mut run = Simulation::new(system, Box::new(VelocityVerlet), start, dt, 500)?;
//! run.run(|_| Control::Continue)?;
//! let energies = run.snapshot().energies();
//! assert!(energies.balance().abs() < 1e-6 * energies.initial);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod accounts;
pub mod archive;
pub mod bench;
mod body;
pub mod boundary;
mod breaking;
pub mod cache;
mod compatibility;
pub mod domain;
mod error;
pub mod family;
mod guard;
mod interrupt;
pub mod kernel;
pub mod lanes;
pub mod material;
pub mod noise;
pub mod observe;
pub mod operator;
pub mod parallel;
pub mod prelude;
pub mod round_trip;
mod scalar;
mod simulation;
pub mod solve;
pub mod space;
mod step_end;
mod step_kind;
mod stop;
pub mod sum;
mod system;
pub mod time;
pub mod units;

pub use accounts::Ledger;
pub use archive::{Archive, Saved, Values};
pub use body::Body;
pub use compatibility::{Need, Requirement, require};
pub use error::{PericlesError, Result, positive};
pub use guard::Cause;
pub use interrupt::Interrupt;
pub use scalar::PointScalar;
pub use simulation::{
    Control, Outcome, Simulation, SimulationBuilder, SimulationError, check_compatibility,
};
pub use step_end::{BreakingBond, Path, StepEnd};
pub use step_kind::{StepKind, schemes_of};
pub use stop::{Found, StopCondition, StopReason, StopWhen};
pub use system::System;
