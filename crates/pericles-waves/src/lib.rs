//! Linear peridynamic waves: the nonlocal wave equation and its exact absorbing ends.
//!
//! * [`linear`] – linear operators by convolution (lines, lattice bodies of any shape, bars with Gauss nodes) and by plane waves on periodic boxes.
//! * [`assemble`] – the force operator of a body, in any form: bonds one by one, convolution, plane waves.
//! * [`function`] – cos, sinc and other functions of a linear operator, applied to vectors.
//! * [`Trigonometric`] – the integrator that takes the linear part exactly.
//! * [`exact`] – solutions in one dimension, to measure errors against.
//! * [`absorbing`] – exact ends of infinite bars and of plates that are periodic across.
//!
//! The crate uses only what the engine, [`pericles`], exports.

pub mod absorbing;
mod assemble;
pub mod exact;
mod form;
pub mod function;
pub mod linear;
mod trigonometric;

pub use assemble::{AssembledForce, assemble, features};
pub use form::ForceForm;
pub use trigonometric::{FunctionMethod, LoadRule, Trigonometric, TrigonometricOptions};
