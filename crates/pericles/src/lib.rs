//! Peridynamics: points, bonds, operators, integrators, observers.

pub mod boundary;
mod error;
pub mod family;
pub mod kernel;
pub mod material;
pub mod space;

pub use error::{PericlesError, Result};
