//! Tests of the crate in one program: what is generic is compiled once for all of them.

mod absorbing;
mod linear;
mod released;
mod wave;
