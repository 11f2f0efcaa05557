//! Peridynamic solids at large strain.
//!
//! * [`correspondence`] – correspondence materials: stress from a nonlocal deformation gradient, with control
//!   of zero-energy modes.
//!
//! The crate uses only public items of the engine, [`pericles`].

pub mod correspondence;
