//! Linear peridynamic waves: the nonlocal wave equation and exact absorbing boundaries.
//!
//! * [`linear`] – linear operators by convolution (lines, lattice bodies of any shape, bars with Gauss nodes) and
//!   by plane waves on periodic boxes.
//! * [`assemble`] – the force operator of a body in any form: bonds one by one, convolution, plane waves.
//! * [`function`] – cos, sinc and other functions of a linear operator, applied to vectors.
//! * [`Trigonometric`] – the integrator that solves the linear part exactly.
//! * [`exact`] – exact solutions in one dimension, used to measure errors.
//! * [`absorbing`] – exact absorbing boundaries of bars and of plates that are periodic across, and open boundaries of
//!   plates on square lattices.
//!
//! The crate uses only the public interface of the engine, [`pericles`].

pub mod absorbing;
mod assemble;
pub mod exact;
mod form;
pub mod fourier;
pub mod function;
pub mod linear;
mod trigonometric;

pub use assemble::{AssembledForce, assemble, features};
pub use form::ForceForm;
pub use trigonometric::{FunctionMethod, LoadRule, Trigonometric, TrigonometricOptions};
