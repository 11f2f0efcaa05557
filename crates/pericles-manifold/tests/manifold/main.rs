//! All tests of the crate in one program, so that generic code is compiled once.

mod manifolds;
mod surface;
