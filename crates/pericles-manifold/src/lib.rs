//! Nonlinear peridynamics on closed surfaces (2-manifolds).
//!
//! * [`surface`] – closed triangulated surfaces: shapes, checks, areas, order along a curve.
//! * [`geodesic`] – distances along surfaces up to a horizon.
//! * [`PowerMaterial`] – the pair law and its constants.
//! * [`force`] – the force operator: power-law bonds over geodesic or Euclidean balls.
//! * [`SurfaceMeasure`], [`EnergyInequality`] – quantities measured on such bodies.
//!
//! The crate uses only the public interface of the engine, [`pericles`].
//!
//! A surface is a separate kind of body with its own material. An assembled system treats it like any other body, and
//! so do schemes and observers.

mod energy_inequality;
pub mod force;
pub mod geodesic;
mod measure;
mod power;
pub mod surface;

pub use energy_inequality::EnergyInequality;
pub use measure::{EnergyBound, EnergyZone, SurfaceMeasure, SurfaceReading};
pub use power::{PowerMaterial, SurfaceBond};
