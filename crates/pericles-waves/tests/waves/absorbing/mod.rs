//! Absorbing boundaries and damping layers.

mod bar;
mod damping;
mod ends;
mod exterior;
mod implicit;
mod kernels;
mod open;
mod strip;
