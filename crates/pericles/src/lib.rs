//! Peridynamics: points, bonds, operators, integrators, observers.

mod archive;
pub mod bench;
pub mod boundary;
mod error;
pub mod family;
pub mod kernel;
pub mod material;
pub mod observe;
pub mod operator;
pub mod parallel;
mod simulation;
pub mod space;
mod system;
pub mod time;

pub use archive::{Archive, Saved, Values};
pub use error::{PericlesError, Result};
pub use simulation::{Control, Outcome, Simulation, SimulationError};
pub use system::{Ledger, PointScalar, System};
