//! Peridynamic solids with history and large strain.
//!
//! * [`correspondence`] – correspondence materials: a stress of a deformation gradient, with control of zero-energy modes.
//! * [`inelastic`] – viscoelastic and elastoplastic state-based solids.
//!
//! The crate uses only what the engine, [`pericles`], exports.

pub mod correspondence;
pub mod inelastic;
