//! All tests of the crate in one program, so that generic code is compiled once.

mod absorbing;
mod linear;
mod released;
mod wave;
