//! Thermal expansion of bond-based and state-based bodies.

#[allow(dead_code)] // other tests use the rest
#[path = "../../../pericles/tests/state_based/bodies.rs"]
mod bodies;
mod forces;
mod grid;
mod runs;
mod setup;
