//! Peridynamic solids at large strain.
//!
//! * [`correspondence`] – correspondence materials: a stress of a deformation gradient, with control of zero-energy modes.
//!
//! The crate uses only what the engine, [`pericles`], exports.

pub mod correspondence;
